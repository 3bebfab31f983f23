// Takes the crossings of grid lines into sums, in one of the ways of counting.
#pragma once

#include "voxel/line_sums.h"

#include <kolize/voxel_mass_properties.h>

#include <span>
#include <type_traits>

namespace kolize {

inline constexpr std::size_t odd_lines_kept = 8;

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

}  // namespace kolize
