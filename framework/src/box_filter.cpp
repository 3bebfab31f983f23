#include "box_filter.h"

#include <cstddef>

namespace kolize {

namespace {

// Every coordinate, distance and extent that the filter meets is below the reach, and comes from at most 30 roundings
// of such; 50 leaves room for a rotation that is orthogonal to float only. Out of float's range nothing is rejected.
Lanes slack_for(const MeshPair& pair) {
    constexpr double unit = 0x1p-24, smallest = 1e-37, too_large = 1e30;
    const double reach = pair.a.radius + pair.b.radius + pair.b_to_a.translation.norm();
    const bool usable = reach < too_large;
    return all_lanes(usable ? static_cast<float>(50 * unit * reach + smallest)
                            : std::numeric_limits<float>::infinity());
}

// The boxes of two nodes, each in two lanes: 0 0 1 1.
struct BoxesInHalves {
    Lanes center[3], half[3];
    explicit BoxesInHalves(const HierarchyNode* const (&node)[2]) {
        const Lanes p = load_lanes(&node[0]->center), q = load_lanes(&node[1]->center);
        const Lanes r = load_lanes(&node[0]->half), s = load_lanes(&node[1]->half);
        center[0] = __builtin_shufflevector(p, q, 0, 0, 4, 4);
        center[1] = __builtin_shufflevector(p, q, 1, 1, 5, 5);
        center[2] = __builtin_shufflevector(p, q, 2, 2, 6, 6);
        half[0] = __builtin_shufflevector(r, s, 0, 0, 4, 4);
        half[1] = __builtin_shufflevector(r, s, 1, 1, 5, 5);
        half[2] = __builtin_shufflevector(r, s, 2, 2, 6, 6);
    }
};

// Likewise: 0 1 0 1.
struct BoxesInTurn {
    Lanes center[3], half[3];
    explicit BoxesInTurn(const HierarchyNode* const (&node)[2]) {
        const Lanes p = load_lanes(&node[0]->center), q = load_lanes(&node[1]->center);
        const Lanes r = load_lanes(&node[0]->half), s = load_lanes(&node[1]->half);
        center[0] = __builtin_shufflevector(p, q, 0, 4, 0, 4);
        center[1] = __builtin_shufflevector(p, q, 1, 5, 1, 5);
        center[2] = __builtin_shufflevector(p, q, 2, 6, 2, 6);
        half[0] = __builtin_shufflevector(r, s, 0, 4, 0, 4);
        half[1] = __builtin_shufflevector(r, s, 1, 5, 1, 5);
        half[2] = __builtin_shufflevector(r, s, 2, 6, 2, 6);
    }
};
static_assert(sizeof(HierarchyNode) == 32 && offsetof(HierarchyNode, half) == 12,
              "four floats from either can be read");

struct LaneBox {
    Lanes low[3], high[3];
    void include(int axis, Lanes x, bool first) {
        low[axis] = first ? x : min(low[axis], x);
        high[axis] = first ? x : max(high[axis], x);
    }
};

}  // namespace

BoxFilter::BoxFilter(const MeshPair& pair) : slack_(slack_for(pair)) {
    for (int row = 0; row < 3; ++row) {
        translation_[row] = all_lanes(static_cast<float>(pair.b_to_a.translation[row]));
        for (int column = 0; column < 3; ++column) {
            rotation_[row][column] = all_lanes(static_cast<float>(pair.b_to_a.rotation(row, column)));
            reach_[row][column] = abs(rotation_[row][column]);
        }
    }
}

unsigned BoxFilter::nodes_near(const HierarchyNode* const (&nodes_a)[2],
                               const HierarchyNode* const (&nodes_b)[2]) const {
    const BoxesInHalves a(nodes_a);
    const BoxesInTurn b(nodes_b);
    Lanes between[3], gap = -slack_;
    for (int k = 0; k < 3; ++k) {
        const auto &turn = rotation_[k], &reach = reach_[k];
        between[k] =
            turn[0] * b.center[0] + turn[1] * b.center[1] + turn[2] * b.center[2] + translation_[k] - a.center[k];
        gap = max(gap,
                  abs(between[k]) - a.half[k] - (reach[0] * b.half[0] + reach[1] * b.half[1] + reach[2] * b.half[2]));
    }
    for (int k = 0; k < 3; ++k) {
        const Lanes along = rotation_[0][k] * between[0] + rotation_[1][k] * between[1] + rotation_[2][k] * between[2];
        gap = max(gap, abs(along) - b.half[k] -
                           (reach_[0][k] * a.half[0] + reach_[1][k] * a.half[1] + reach_[2][k] * a.half[2]));
    }
    return not_positive(gap - slack_);
}

unsigned BoxFilter::triangles_near(const TriangleBlock& a, const TriangleBlock& b) const {
    LaneBox box_a, box_b;
    for (int corner = 0; corner < 3; ++corner) {
        const auto &of_a = a.corners[corner], &of_b = b.corners[corner];
        const Lanes x = load_lanes(of_b[0]), y = load_lanes(of_b[1]), z = load_lanes(of_b[2]);
        for (int axis = 0; axis < 3; ++axis) {
            const auto& turn = rotation_[axis];
            box_a.include(axis, load_lanes(of_a[axis]), corner == 0);
            box_b.include(axis, turn[0] * x + turn[1] * y + turn[2] * z + translation_[axis], corner == 0);
        }
    }
    unsigned mask = 0;
    for (int i = 0; i < 4; ++i) {
        Lanes gap = -slack_;
        for (int axis = 0; axis < 3; ++axis)
            gap = max(max(gap, box_b.low[axis] - box_a.high[axis][i]), box_a.low[axis][i] - box_b.high[axis]);
        mask |= not_positive(gap - slack_) << 4 * i;
    }
    return mask;
}

}  // namespace kolize
