#include <kolize/error.h>
#include <kolize/voxel_mass_properties.h>

#include <sstream>

namespace kolize {

namespace {

constexpr double most_cells = 1 << 20;
constexpr std::size_t lines_per_band = 8192;  // their crossings stay in the second-level cache

std::string text(double number) {
    std::ostringstream out;
    out << number;
    return out.str();
}

double spacing_of(const VoxelOptions& options, const Vec3& sides) {
    if (!std::isfinite(options.step) || options.step == 0)
        throw Error("the step must be a length (> 0) or minus a number of divisions, not " + text(options.step));
    if (options.step > 0) return options.step;
    if (options.step != std::floor(options.step))
        throw Error("a negative step is a number of divisions and must be whole, not " + text(-options.step));
    return sides.maxCoeff() / -options.step;
}

}  // namespace

VoxelGrid make_voxel_grid(const Aabb& bounds, const VoxelOptions& options) {
    if (options.axes < 1 || options.axes > 3)
        throw Error("rays go along 1, 2 or 3 axes, not " + std::to_string(options.axes));
    if (!(std::abs(options.grid_shift) < 0.5))
        throw Error("the grid shift is a part of the spacing between -0.5 and 0.5, not " + text(options.grid_shift));
    const Vec3 sides = bounds.max - bounds.min;
    const double spacing = spacing_of(options, sides);
    VoxelGrid grid;
    for (int i = 0; i < 3; ++i) {
        // A side that the step divides but for rounding gets no sliver of a cell.
        const double cells = std::max(1.0, std::ceil(sides[i] / spacing * (1 - 1e-9)));
        if (!(cells <= most_cells))
            throw Error("a step of " + text(spacing) + " cuts a side of " + text(sides[i]) + " into " + text(cells) +
                        " cells; at most " + std::to_string(static_cast<int>(most_cells)) + " are possible");
        grid.cells[i] = static_cast<int>(cells);
        grid.spacing[i] = options.count == VoxelCount::thesis ? spacing : sides[i] / cells;
        grid.origin[i] = bounds.center()[i] - 0.5 * cells * grid.spacing[i];
    }
    return grid;
}

GridLines::GridLines(const VoxelGrid& grid, double grid_shift, int along)
    : axis(along),
      column_axis((along + 1) % 3),
      row_axis((along + 2) % 3),
      column_spacing(grid.spacing[column_axis]),
      row_spacing(grid.spacing[row_axis]) {
    const auto centers = [&](int across, std::vector<double>& coordinates) {
        for (int i = 0; i < grid.cells[across]; ++i)
            coordinates.push_back(grid.origin[across] + (i + 0.5 + grid_shift) * grid.spacing[across]);
    };
    centers(column_axis, columns);
    centers(row_axis, rows);
    rows_per_band = std::max<std::size_t>(1, lines_per_band / columns.size());
}

}  // namespace kolize
