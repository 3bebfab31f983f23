// Space divided into cubes, or into squares across some of the axes, each again and again into halves along every one
// of them: what octree and quadtree have in common.
#pragma once

#include "box_tree.h"

#include <array>
#include <limits>

namespace kolize {

template <int dimensions>
struct CubicSpace {
    static constexpr std::uint32_t children = 1u << dimensions;

    struct Cell {
        Vec3 center = Vec3::Zero();
        double half = 0;  // of its side, m
    };

    std::array<int, dimensions> axes;
    double looseness = 1;  // a box may stand out of the cell that its centre is in by this factor of its size

    // Twice as large as need be, so that what flies off seldom has to make a new one.
    Cell whole(const Aabb& bounds) const {
        if (!bounds.finite()) return {};
        const Vec3 half = 0.5 * bounds.max - 0.5 * bounds.min;
        return {0.5 * bounds.min + 0.5 * bounds.max, std::min(half.maxCoeff(), most / 2) * 2};
    }

    bool holds(const Cell& cell, const Aabb& box) const {
        const Vec3 center = center_of(box);
        for (const int axis : axes)
            if (!(std::abs(0.5 * center[axis] - 0.5 * cell.center[axis]) <= 0.5 * cell.half)) return false;
        return true;
    }

    template <class NextBox>
    bool divide(Cell& cell, std::uint32_t, NextBox&&) const {
        return cell.half > std::numeric_limits<double>::min();
    }

    int child_of(const Cell& cell, const Aabb& box) const {
        const Vec3 center = center_of(box);
        int number = 0;
        for (int i = 0; i < dimensions; ++i) number |= (center[axes[i]] >= cell.center[axes[i]]) << i;
        const Cell part = child(cell, number);
        for (const int axis : axes) {
            const double reach = looseness * part.half;
            if (!(part.center[axis] - box.min[axis] <= reach && box.max[axis] - part.center[axis] <= reach)) return -1;
        }
        return number;
    }

    Cell child(const Cell& cell, int number) const {
        Cell part{cell.center, 0.5 * cell.half};
        for (int i = 0; i < dimensions; ++i) part.center[axes[i]] += number >> i & 1 ? part.half : -part.half;
        return part;
    }

    // The cells of a tree that have something in them, as high as all boxes where they have no height of their own.
    static void outline(const BoxTree<CubicSpace>& tree, Outline& outline, std::span<const int> flat_axes) {
        const Aabb all = tree.nodes()[0].below.box();
        for (const auto& node : tree.nodes()) {
            if (!node.below.box().finite()) continue;
            Aabb box{node.cell.center - Vec3::Constant(node.cell.half),
                     node.cell.center + Vec3::Constant(node.cell.half)};
            for (const int axis : flat_axes) {
                box.min[axis] = all.min[axis];
                box.max[axis] = all.max[axis];
            }
            if (box.finite()) outline.boxes.push_back({box, node.level});
        }
    }

private:
    static constexpr double most = std::numeric_limits<double>::max();
    static Vec3 center_of(const Aabb& box) { return 0.5 * box.min + 0.5 * box.max; }
};

}  // namespace kolize
