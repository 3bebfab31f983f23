// Broadphase by a k-d tree: each node is divided by a plane across one axis, through the middle of its boxes.
//
// The plane goes through the median of the boxes' centres, across the axis along which it leaves the most boxes on one
// side or the other; those that straddle it stay at the node. Planes stay where they are while boxes move, until so
// many have changed places that the tree is made anew. How boxes are filed, kept and looked for is in box_tree.h.
#include "box_tree.h"

#include <limits>

namespace {

using kolize::Aabb;

struct KdSpace {
    static constexpr std::uint32_t children = 2;

    struct Cell {
        int axis = 0;
        double at = 0;
    };

    Cell whole(const Aabb&) const { return {}; }
    bool holds(const Cell&, const Aabb&) const { return true; }

    // Of the centres of a few boxes; a plane that leaves most of them across it is of no use.
    template <class NextBox>
    bool divide(Cell& cell, std::uint32_t all, NextBox&& next_box) const {
        Aabb boxes[most_samples];
        int count = 0;
        for (std::uint32_t i = 0; i < all; ++i) {
            const Aabb box = next_box();
            if (all <= most_samples || i % (all / most_samples) == 0) boxes[count++] = box;
            if (count == most_samples) break;
        }
        int best = count / 2;
        bool found = false;
        for (int axis = 0; axis < 3; ++axis) {
            const Cell plane{axis, median(boxes, count, axis)};
            int across = 0, below = 0;
            for (int i = 0; i < count; ++i) {
                const int child = child_of(plane, boxes[i]);
                across += child < 0;
                below += child == 0;
            }
            if (across >= best || below == 0 || below + across == count) continue;
            best = across;
            cell = plane;
            found = true;
        }
        return found;
    }

    int child_of(const Cell& cell, const Aabb& box) const {
        return box.max[cell.axis] < cell.at ? 0 : box.min[cell.axis] > cell.at ? 1 : -1;
    }
    Cell child(const Cell&, int) const { return {}; }

private:
    static constexpr int most_samples = 64;

    static double median(const Aabb* boxes, int count, int axis) {
        double centers[most_samples];
        for (int i = 0; i < count; ++i) centers[i] = 0.5 * boxes[i].min[axis] + 0.5 * boxes[i].max[axis];
        std::nth_element(centers, centers + count / 2, centers + count);
        return centers[count / 2];
    }
};

class KdTree final : public kolize::TreeBroadphase<KdSpace> {
public:
    static void parameters(kolize::Parameters<KdTree>& p) { add_tree_parameters(p); }

    // Each plane as far as the boxes below its node.
    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        std::vector<kolize::Pair> ignored;
        find_pairs(input, ignored);
        for (const auto* tree : {&static_tree(), &moving_tree()})
            for (const auto& node : tree->nodes()) {
                Aabb plane = node.below.box();
                if (node.first_child == tree->none || !plane.finite()) continue;
                plane.min[node.cell.axis] = plane.max[node.cell.axis] = node.cell.at;
                outline.boxes.push_back({plane, node.level});
            }
    }
};

}  // namespace

KOLIZE_PLUGIN(KdTree, .name = "kd_tree", .summary = "planes through the middle of the boxes, across one axis each",
              .source =
                  "Bentley, Multidimensional binary search trees used for associative searching (1975); Ericson, "
                  "Real-Time Collision Detection (2005), 7.3.7",
              .cost =
                  "A box that has moved is filed and looked for in O(log N) where planes cut few boxes; those that "
                  "have not cost a comparison. About 250 bytes a box.",
              .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
              .choose =
                  "Worlds of which most stands still and whose boxes are spread very unevenly: planes go where boxes "
                  "are. Large boxes among small ones stay high up in the tree and cost more than in aabb_hierarchy.",
              .capabilities = {.exact = true, .outline = "planes"})
