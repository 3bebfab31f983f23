// A binary tree of axis-aligned boxes over the triangles of a mesh, in the mesh's own frame, built once.
#pragma once

#include <kolize/export.h>
#include <kolize/math.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kolize {

struct HierarchyNode {
    Vec3 center = Vec3::Zero();
    Vec3 half = Vec3::Zero();
    std::uint32_t first = 0;  // leaf: first entry of `order`; inner: index of the left child, the right one follows it
    std::uint32_t count = 0;  // leaf: number of triangles; inner: 0

    bool is_leaf() const { return count != 0; }
};

struct Hierarchy {
    std::vector<HierarchyNode> nodes;  // nodes[0] is the root; empty for an empty mesh
    std::vector<std::uint32_t> order;  // triangle ids, those of a leaf side by side
};

// Top-down, split at the median centroid of the longest axis, at most four triangles a leaf.
KOLIZE_API Hierarchy build_hierarchy(std::span<const Vec3> vertices,
                                     std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace kolize
