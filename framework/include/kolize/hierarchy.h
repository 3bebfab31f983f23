// A binary tree of axis-aligned boxes over the triangles of a mesh, in the mesh's own frame, built once.
//
// Boxes are kept in float to be read fast, and rounded outward: a box holds its triangles whatever their size and
// offset are. Where the mesh lies beyond the range of float a half extent is infinite; far from the origin of its
// frame, or below the range of float, boxes grow by the spacing of floats there. Neither makes a query wrong, only
// slower.
#pragma once

#include <kolize/export.h>
#include <kolize/math.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kolize {

using Vec3f = Eigen::Vector3f;

struct HierarchyNode {
    Vec3f center = Vec3f::Zero();  // m, finite
    Vec3f half = Vec3f::Zero();    // m, may be infinite
    std::uint32_t first = 0;  // leaf: first entry of `order`; inner: index of the left child, the right one follows it
    std::uint32_t count = 0;  // leaf: number of triangles; inner: 0

    bool is_leaf() const { return count != 0; }
};

// Four triangles for arithmetic on all at once, rounded to float: coordinate x of corner k of the i-th is at [k][x][i].
struct TriangleBlock {
    static constexpr std::uint32_t size = 4;
    float corners[3][3][size];  // m
};

struct Hierarchy {
    std::vector<HierarchyNode> nodes;   // nodes[0] is the root; empty for an empty mesh
    std::vector<std::uint32_t> order;   // triangle ids, those of a leaf side by side
    std::vector<TriangleBlock> blocks;  // the triangles in that order, the last one repeated to fill the last block;
                                        // a leaf has block first / 4, all to itself
};

// Top-down, split near the median centroid of the longest axis, at most four triangles a leaf.
KOLIZE_API Hierarchy build_hierarchy(std::span<const Vec3> vertices,
                                     std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace kolize
