#include <kolize/voxel_mass_properties.h>

#include "voxel/line_sums.h"

#include <mutex>
#include <span>
#include <type_traits>

namespace kolize {

namespace {

constexpr std::size_t odd_lines_kept = 8;

Aabb bounds_of(const TriangleSoup& surface) {
    Aabb bounds;
    for (const Triangle& triangle : surface.triangles)
        for (const std::uint32_t v : triangle) bounds.include(surface.vertices[v]);
    return bounds;
}

// Sums, and what was found on the way.
template <class Real>
struct Tally {
    LineSums<Real> sums;
    double covered_twice = 0, inside_out = 0;  // m of line
    std::uint64_t odd_lines = 0;
    std::vector<OddLine> odd;

    void add(const Tally& other) {
        sums.add(other.sums);
        covered_twice += other.covered_twice;
        inside_out += other.inside_out;
        odd_lines += other.odd_lines;
        for (const OddLine& line : other.odd)
            if (odd.size() < odd_lines_kept) odd.push_back(line);
    }
};

// Takes lines of one axis into a tally.
template <class Real>
class LineCounter {
public:
    LineCounter(const VoxelOptions& options, const VoxelGrid& grid, const GridLines& lines, const Vec3& reference)
        : options_(options),
          lines_(lines),
          reference_(reference),
          origin_(grid.origin[lines.axis]),
          h_(grid.spacing[lines.axis]),
          own_y_(grid.spacing[lines.column_axis] * grid.spacing[lines.column_axis] / 12),
          own_z_(grid.spacing[lines.row_axis] * grid.spacing[lines.row_axis] / 12) {}

    void count_band(const LineCrossings& band, std::size_t first_row, Tally<Real>& tally) const {
        std::size_t line = 0, begin = 0;
        for (std::size_t row = first_row; line < band.end.size(); ++row)
            for (std::size_t column = 0; column < lines_.columns.size(); ++column, ++line) {
                const std::size_t end = band.end[line];
                if (end > begin) count_line({&band.crossings[begin], end - begin}, row, column, tally);
                begin = end;
            }
    }

private:
    void count_line(std::span<const Crossing> crossings, std::size_t row, std::size_t column,
                    Tally<Real>& tally) const {
        int winding = 0;
        for (const Crossing& crossing : crossings) winding += crossing.sign;
        if (winding != 0) return note_odd_line(crossings, row, column, tally);
        const LinePlace place{lines_.columns[column] - reference_[lines_.column_axis],
                              lines_.rows[row] - reference_[lines_.row_axis]};
        for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
            winding += crossings[i].sign;
            const double length = crossings[i + 1].depth - crossings[i].depth;
            if (winding > 1) tally.covered_twice += length;
            if (winding < 0) tally.inside_out += length;
            if (winding != 0) add_part(place, crossings[i].depth, crossings[i + 1].depth, winding, tally.sums);
        }
    }

    void note_odd_line(std::span<const Crossing> crossings, std::size_t row, std::size_t column,
                       Tally<Real>& tally) const {
        ++tally.odd_lines;
        if (tally.odd.size() == odd_lines_kept) return;
        OddLine& odd = tally.odd.emplace_back();
        odd.axis = lines_.axis;
        odd.crossings = crossings.size();
        odd.point[lines_.axis] = crossings.front().depth;
        odd.point[lines_.column_axis] = lines_.columns[column];
        odd.point[lines_.row_axis] = lines_.rows[row];
    }

    void add_part(const LinePlace& place, double begin, double end, int winding, LineSums<Real>& sums) const {
        const double from = reference_[lines_.axis];
        switch (options_.count) {
        case VoxelCount::analytic: {
            Run run = length_run(begin - from, end - from);
            run = {winding * run.amount, winding * run.first, winding * run.second};
            return sums.add(place, run, own_y_, own_z_);
        }
        case VoxelCount::midpoint: {  // the cells whose centres lie in [begin, end)
            const double first = std::ceil((begin - origin_) / h_ - 0.5), last = std::ceil((end - origin_) / h_ - 0.5);
            return add_cells(place, first, last - first, winding, sums);
        }
        case VoxelCount::thesis: {
            const double first = cell_of(begin), last = cell_of(end);
            return add_cells(place, first, last - first + 1, winding, sums);
        }
        }
    }

    // A crossing on the side of two cells, up to rounding of the step, is in the lower one.
    double cell_of(double depth) const { return std::ceil((depth - origin_) / h_ - 1e-6) - 1; }

    void add_cells(const LinePlace& place, double first, double count, int winding, LineSums<Real>& sums) const {
        const double x = origin_ + (first + 0.5) * h_ - reference_[lines_.axis];
        if constexpr (std::is_same_v<Real, float>) {
            for (int i = 0; i < std::abs(winding); ++i)
                sums.add_cells_singly(place, x, count, h_, winding < 0 ? -1.0f : 1.0f);
        } else {
            const Run run = cell_run(x, count, h_);
            sums.add(place, {winding * run.amount, winding * run.first, winding * run.second}, 0, 0);
        }
    }

    const VoxelOptions& options_;
    const GridLines& lines_;
    Vec3 reference_;
    double origin_, h_;
    double own_y_, own_z_;
};

// Along, columns, rows: the axes of the sums, back to x, y, z.
Vec3 unturned(const Vec3& v, const GridLines& lines) {
    Vec3 result;
    result[lines.axis] = v[0];
    result[lines.column_axis] = v[1];
    result[lines.row_axis] = v[2];
    return result;
}

// The tensor is moved to the centre of mass unless the reference point stands for it.
template <class Real>
MassProperties mass_of(const LineSums<Real>& sums, const GridLines& lines, const Vec3& reference, bool about_reference,
                       double volume_per_amount) {
    MassProperties mass;
    if (sums.amount == 0) return mass;
    const auto mean = [&](const auto& sum) { return unturned(sum.template cast<double>() / sums.amount, lines); };
    const Vec3 center = mean(sums.first), product = mean(sums.product);
    mass.volume = sums.amount * volume_per_amount;
    mass.center_of_mass = reference + center;
    mass.inertia_over_mass = mean(sums.inertia).asDiagonal();
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        mass.inertia_over_mass(j, k) = mass.inertia_over_mass(k, j) = -product[i];
    }
    if (!about_reference)
        mass.inertia_over_mass -= center.squaredNorm() * Mat3::Identity() - center * center.transpose();
    return mass;
}

MassProperties mean_of(const std::vector<VoxelPass>& passes) {
    MassProperties mean;
    double total = 0;
    const auto weight = [](const VoxelPass& pass) {
        return 1 - static_cast<double>(pass.odd_lines) / static_cast<double>(pass.lines);
    };
    for (const VoxelPass& pass : passes) total += weight(pass);
    if (total == 0) return mean;
    for (const VoxelPass& pass : passes) {
        const double part = weight(pass) / total;
        mean.volume += part * pass.mass.volume;
        mean.center_of_mass += part * pass.mass.center_of_mass;
        mean.inertia_over_mass += part * pass.mass.inertia_over_mass;
    }
    return mean;
}

// Scans that are not at work: as many as ever were at the same time.
class IdleScans {
public:
    std::unique_ptr<LineScan> take(const LineCaster& caster) {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) return caster.start();
        std::unique_ptr<LineScan> scan = std::move(idle_.back());
        idle_.pop_back();
        return scan;
    }
    void give_back(std::unique_ptr<LineScan> scan) {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(scan));
    }

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<LineScan>> idle_;
};

// One axis: its lines, and who casts them.
struct Axis {
    Axis(const VoxelGrid& grid, double grid_shift, int axis) : lines(grid, grid_shift, axis) {}

    GridLines lines;
    std::unique_ptr<LineCaster> caster;
    IdleScans scans;
};

// Bands that one thread takes in turn. A running float goes through all bands of an axis.
struct Chunk {
    Axis* axis;
    std::size_t first_band, last_band;
};

std::vector<Chunk> chunks_of(const std::vector<std::unique_ptr<Axis>>& axes, VoxelSum sum) {
    std::vector<Chunk> chunks;
    for (const auto& axis : axes) {
        const std::size_t bands = axis->lines.bands(), step = sum == VoxelSum::single_precision ? bands : 1;
        for (std::size_t band = 0; band < bands; band += step) chunks.push_back({axis.get(), band, band + step});
    }
    return chunks;
}

class VoxelRun {
public:
    VoxelRun(const TriangleSoup& surface, const VoxelOptions& options, const MakeLineCaster& make_caster, Host& host,
             const std::function<void(std::size_t, std::size_t)>& advance)
        : surface_(surface), options_(options), make_caster_(make_caster), host_(host), advance_(advance) {}

    VoxelMassProperties run() {
        const Aabb bounds = bounds_of(surface_);
        result_.grid = make_voxel_grid(bounds, options_);
        for (int axis = 0; axis < options_.axes; ++axis)
            axes_.push_back(std::make_unique<Axis>(result_.grid, options_.grid_shift, axis));
        for (const auto& axis : axes_) bands_ += axis->lines.bands();
        if (!((bounds.max - bounds.min).minCoeff() > 0)) return flat_result();
        choose_reference(bounds);
        host_.parallel_for(axes_.size(), 1, [&](std::size_t, std::size_t begin, std::size_t) {
            axes_[begin]->caster = make_caster_(surface_, axes_[begin]->lines);
        });
        if (options_.sum == VoxelSum::single_precision)
            count<float>();
        else
            count<double>();
        result_.mass = mean_of(result_.passes);
        return std::move(result_);
    }

private:
    VoxelMassProperties flat_result() {
        for (const auto& axis : axes_) result_.passes.push_back({axis->lines.axis, {}, axis->lines.count(), 0, 0, 0});
        return std::move(result_);
    }

    // The thesis went over all voxels twice: for the centre of mass, then for the tensor about it.
    void choose_reference(const Aabb& bounds) {
        two_passes_ = options_.count == VoxelCount::thesis || options_.sum == VoxelSum::single_precision;
        reference_ = bounds.center();
        if (!two_passes_) return;
        VoxelOptions unbiased = options_;
        unbiased.count = VoxelCount::analytic;
        unbiased.sum = VoxelSum::double_precision;
        const MassProperties mass = voxel_mass_properties(surface_, unbiased, make_caster_, host_).mass;
        if (mass.volume != 0) reference_ = mass.center_of_mass;
    }

    template <class Real>
    void count() {
        const std::vector<Chunk> chunks = chunks_of(axes_, options_.sum);
        std::vector<Tally<Real>> tallies(chunks.size());
        host_.parallel_for(chunks.size(), 1, [&](std::size_t, std::size_t begin, std::size_t) {
            count_chunk(chunks[begin], tallies[begin]);
        });
        for (const auto& axis : axes_) {
            Tally<Real> total;
            for (std::size_t i = 0; i < chunks.size(); ++i)
                if (chunks[i].axis == axis.get()) total.add(tallies[i]);
            finish_pass(axis->lines, total);
        }
    }

    template <class Real>
    void count_chunk(const Chunk& chunk, Tally<Real>& tally) const {
        Axis& axis = *chunk.axis;
        const LineCounter<Real> counter(options_, result_.grid, axis.lines, reference_);
        std::unique_ptr<LineScan> scan = axis.scans.take(*axis.caster);
        for (std::size_t band = chunk.first_band; band < chunk.last_band; ++band) {
            counter.count_band(scan->cast(band), axis.lines.first_row(band), tally);
            if (advance_) advance_(1, bands_);
        }
        axis.scans.give_back(std::move(scan));
    }

    template <class Real>
    void finish_pass(const GridLines& lines, const Tally<Real>& tally) {
        const Vec3& h = result_.grid.spacing;
        const double column = h[lines.column_axis] * h[lines.row_axis];
        const double per_amount = options_.count == VoxelCount::analytic ? column : column * h[lines.axis];
        VoxelPass& pass = result_.passes.emplace_back();
        pass.axis = lines.axis;
        pass.mass = mass_of(tally.sums, lines, reference_, two_passes_, per_amount);
        pass.lines = lines.count();
        pass.odd_lines = tally.odd_lines;
        pass.covered_twice = tally.covered_twice * column;
        pass.inside_out = tally.inside_out * column;
        for (const OddLine& line : tally.odd)
            if (result_.odd_lines.size() < odd_lines_kept) result_.odd_lines.push_back(line);
    }

    const TriangleSoup& surface_;
    const VoxelOptions& options_;
    const MakeLineCaster& make_caster_;
    Host& host_;
    const std::function<void(std::size_t, std::size_t)>& advance_;
    std::size_t bands_ = 0;
    bool two_passes_ = false;
    Vec3 reference_ = Vec3::Zero();
    std::vector<std::unique_ptr<Axis>> axes_;
    VoxelMassProperties result_;
};

}  // namespace

VoxelMassProperties voxel_mass_properties(const TriangleSoup& surface, const VoxelOptions& options,
                                          const MakeLineCaster& make_caster, Host& host,
                                          const std::function<void(std::size_t, std::size_t)>& advance) {
    return VoxelRun(surface, options, make_caster, host, advance).run();
}

}  // namespace kolize
