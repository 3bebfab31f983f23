#include <kolize/voxel_mass_properties.h>

#include "voxel/line_counter.h"

#include <mutex>

namespace kolize {

namespace {

Aabb bounds_of(const TriangleSoup& surface) {
    Aabb bounds;
    for (const Triangle& triangle : surface.triangles)
        for (const std::uint32_t v : triangle) bounds.include(surface.vertices[v]);
    return bounds;
}

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
