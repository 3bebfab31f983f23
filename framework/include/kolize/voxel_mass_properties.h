// Mass properties by rays along the lines of a grid: the voxel method, as a baseline for the exact integrals, as a
// check of them that shares no formula, and for surfaces that do not bound a volume.
#pragma once

#include <kolize/host.h>
#include <kolize/mass_properties.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace kolize {

// How the part of a line between two crossings counts.
enum class VoxelCount {
    analytic,  // integrals along the line; across it a column as wide as the spacing
    midpoint,  // cells whose centres lie between the crossings, as points at their centres
    thesis     // all cells from that of one crossing to that of the other, both included, as points: a cell too many;
               // the tensor is taken about the centre that analytic counting gives
};

// What the sums run in.
enum class VoxelSum {
    double_precision,
    single_precision  // one running float a component, cell by cell: stands still once a term is below half an ulp
};

struct VoxelOptions {
    double step = -100;  // > 0: spacing (m); < 0: divisions of the longest side of the bounding box
    int axes = 3;        // lines along x; x and y; x, y and z
    double grid_shift =
        0;  // moves all lines by this part of the spacing, within (-0.5, 0.5); 0: the middle of the cells
    VoxelCount count = VoxelCount::analytic;
    VoxelSum sum = VoxelSum::double_precision;
};

// Cells that cover the bounding box. Along each axis the box is cut into equal parts not longer than the step; the
// thesis count takes the step as it stands, with the box in the middle of the cells.
struct VoxelGrid {
    Vec3 origin = Vec3::Zero();   // lower corner of the first cell, m
    Vec3 spacing = Vec3::Zero();  // m
    Eigen::Vector3i cells = Eigen::Vector3i::Zero();
};

// Throws Error for options that make no grid, or one of more than 2^20 cells along an axis.
KOLIZE_API VoxelGrid make_voxel_grid(const Aabb& bounds, const VoxelOptions& options);

// Parallel lines through the cells, in rows; rows are cast in bands of a few thousand lines.
struct KOLIZE_API GridLines {
    GridLines(const VoxelGrid& grid, double grid_shift, int axis);

    int axis;                     // along the lines
    int column_axis, row_axis;    // the next two in cyclic order: across the lines of a row, and across the rows
    std::vector<double> columns;  // coordinate along column_axis of each line of a row, m
    std::vector<double> rows;     // coordinate along row_axis of each row, m
    double column_spacing, row_spacing;
    std::size_t rows_per_band;

    std::size_t count() const { return columns.size() * rows.size(); }
    std::size_t bands() const { return (rows.size() + rows_per_band - 1) / rows_per_band; }
    std::size_t first_row(std::size_t band) const { return band * rows_per_band; }
    std::size_t last_row(std::size_t band) const { return std::min(rows.size(), (band + 1) * rows_per_band); }
};

// A place where a line goes through the surface.
struct Crossing {
    double depth;  // coordinate along the line, m
    int sign;      // +1 where the line enters the solid, -1 where it leaves it
};

// The crossings of one band of lines, line by line, sorted by depth.
struct LineCrossings {
    std::vector<std::uint32_t> end;   // per line: its crossings end here, and begin where those of the line before end
    std::vector<Crossing> crossings;  // behind the last line's end they mean nothing
};

// A crossing, and the line of the band that it is on.
struct LineHit {
    double depth;
    std::uint32_t line;
    int sign;
};

// Hits in any order as the crossings of so many lines; where two are at the same depth, the solid is left first.
KOLIZE_API void sort_hits(std::span<const LineHit> hits, std::size_t lines, LineCrossings& out);

// Casts lines at one surface, band by band, in buffers of its own: one for each thread.
class LineScan {
public:
    virtual ~LineScan() = default;
    // Valid until the next call.
    virtual const LineCrossings& cast(std::size_t band) = 0;
};

// What scans of the same surface along the same lines share. Surface, lines and caster outlive its scans.
class LineCaster {
public:
    virtual ~LineCaster() = default;
    virtual std::unique_ptr<LineScan> start() const = 0;  // may be called from several threads
};

using MakeLineCaster = std::function<std::unique_ptr<LineCaster>(const TriangleSoup&, const GridLines&)>;

// Our own: triangles are scan-converted across the lines. Which lines an edge has on its left is decided by the edge
// alone, from the same numbers for both of its triangles; so a line through an edge or a vertex is never counted twice
// or missed, and where the surface bounds a volume the signs along every line sum to zero.
KOLIZE_API std::unique_ptr<LineCaster> make_line_rasteriser(const TriangleSoup& surface, const GridLines& lines);

// A line whose crossings do not pair up: it is left out, as nothing can be said about what is inside along it.
struct OddLine {
    int axis = 0;
    Vec3 point = Vec3::Zero();  // its first crossing
    std::size_t crossings = 0;
};

// Lines along one axis.
struct VoxelPass {
    int axis = 0;
    MassProperties mass;
    std::uint64_t lines = 0;
    std::uint64_t odd_lines = 0;
    double covered_twice = 0;  // volume that the surface winds around more than once (m^3)
    double inside_out = 0;     // volume that it winds around the wrong way (m^3)
};

struct VoxelMassProperties {
    MassProperties mass;  // mean of the passes, each with the share of its lines that pair up as weight
    VoxelGrid grid;
    std::vector<VoxelPass> passes;
    std::vector<OddLine> odd_lines;  // the first few, by pass and line
};

// The same bits for any number of threads. `advance(bands, of)` is called whenever some bands are done, from any
// thread; it may throw to give up. Throws Error as make_voxel_grid does.
KOLIZE_API VoxelMassProperties voxel_mass_properties(const TriangleSoup& surface, const VoxelOptions& options,
                                                     const MakeLineCaster& make_caster, Host& host,
                                                     const std::function<void(std::size_t, std::size_t)>& advance = {});

}  // namespace kolize
