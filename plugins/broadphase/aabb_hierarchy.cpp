// Broadphase by a hierarchy of axis-aligned boxes: each node's box holds those of its children.
//
// The tree is built from the top: a node's boxes are parted by where their centres lie along the longest axis of the
// centres, at their median. While boxes move, the boxes of the nodes above them are fitted again; a box whose centre
// has gone over to the other side of a plane is filed there. When the surface of all nodes has grown by `rebuild_at`,
// or as many boxes have changed places as there are, the tree is built anew. How boxes are filed, kept and looked for
// is in box_tree.h.
#include "box_tree.h"

namespace {

using kolize::Aabb;
using kolize::Vec3;

struct AabbSpace {
    static constexpr std::uint32_t children = 2;

    struct Cell {
        int axis = 0;
        double at = 0;
    };

    Cell whole(const Aabb&) const { return {}; }
    bool holds(const Cell&, const Aabb&) const { return true; }

    template <class NextBox>
    bool divide(Cell& cell, std::uint32_t all, NextBox&& next_box) const {
        Vec3 centers[most_samples];
        std::uint32_t count = 0;
        const std::uint32_t stride = std::max(1u, all / most_samples);
        Aabb around;
        for (std::uint32_t i = 0; i < all && count < most_samples; ++i) {
            const Aabb box = next_box();
            if (i % stride != 0) continue;
            centers[count] = center_of(box);
            around.include(centers[count++]);
        }
        (0.5 * around.max - 0.5 * around.min).maxCoeff(&cell.axis);
        const auto less = [&](const Vec3& a, const Vec3& b) { return a[cell.axis] < b[cell.axis]; };
        std::nth_element(centers, centers + count / 2, centers + count, less);
        cell.at = centers[count / 2][cell.axis];
        return cell.at > around.min[cell.axis];
    }

    int child_of(const Cell& cell, const Aabb& box) const { return center_of(box)[cell.axis] >= cell.at; }
    Cell child(const Cell&, int) const { return {}; }

private:
    static constexpr std::uint32_t most_samples = 64;
    static Vec3 center_of(const Aabb& box) { return 0.5 * box.min + 0.5 * box.max; }
};

class AabbHierarchy final : public kolize::TreeBroadphase<AabbSpace> {
public:
    static void parameters(kolize::Parameters<AabbHierarchy>& p) {
        add_tree_parameters(p);
        p.add("rebuild_at", &AabbHierarchy::rebuild_at_)
            .range(1, 1e9)
            .doc("How many times as large the surface of all nodes may grow before the tree is built anew.");
    }

    // The boxes of all nodes.
    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        std::vector<kolize::Pair> ignored;
        find_pairs(input, ignored);
        for (const auto* tree : {&static_tree(), &moving_tree()})
            for (const auto& node : tree->nodes())
                if (const Aabb box = node.below.box(); box.finite()) outline.boxes.push_back({box, node.level});
    }
};

}  // namespace

KOLIZE_PLUGIN(
    AabbHierarchy, .name = "aabb_hierarchy",
    .summary = "a tree of boxes within boxes, fitted again while they move, and built anew when that is worn",
    .source =
        "Ericson, Real-Time Collision Detection (2005), 6.1-6.6; Catto, Dynamic bounding volume hierarchies "
        "(GDC 2019); surface area as the measure of a tree: Goldsmith and Salmon 1987",
    .cost =
        "O(N) to fit and O(N + pairs) to search where all move, O(log N) for each box where few do; O(N log N) "
        "when built. About 250 bytes a box.",
    .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
    .choose =
        "Boxes of very different sizes of which few move; what most physics engines use. Where all move, grid "
        "(similar sizes) and sweep_and_prune (any sizes) are faster.",
    .capabilities = {.exact = true, .outline = "cells"})
