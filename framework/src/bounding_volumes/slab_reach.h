// How far a k-DOP reaches in any direction, from how far it reaches in its own.
#pragma once

#include <kolize/math.h>

#include <array>
#include <span>

namespace kolize {

// The axes, the middles of the edges of a cube and its corners, one of each opposite pair.
inline constexpr std::array<std::array<int, 3>, 13> slab_directions{{{1, 0, 0},
                                                                     {0, 1, 0},
                                                                     {0, 0, 1},
                                                                     {1, 1, 0},
                                                                     {1, -1, 0},
                                                                     {1, 0, 1},
                                                                     {1, 0, -1},
                                                                     {0, 1, 1},
                                                                     {0, 1, -1},
                                                                     {1, 1, 1},
                                                                     {1, 1, -1},
                                                                     {1, -1, 1},
                                                                     {1, -1, -1}}};

inline Vec3 slab_direction(int i) {
    return {double(slab_directions[i][0]), double(slab_directions[i][1]), double(slab_directions[i][2])};
}

// reach[2 i] is the largest d . p of direction d = slab_directions[i], reach[2 i + 1] the largest -d . p.
using SlabReach = std::array<double, 26>;

// A direction as a sum of three of the k-DOP's own, none with a negative weight: the k-DOP reaches at most so far as
// the same sum of its reaches. Of all such bounds it is the one by the three directions around it.
struct SlabSum {
    std::array<int, 3> entry{};  // into SlabReach; entry ^ 1 is the opposite direction
    std::array<double, 3> weight{};

    double of(const SlabReach& reach) const {
        return weight[0] * reach[entry[0]] + weight[1] * reach[entry[1]] + weight[2] * reach[entry[2]];
    }
    double of_opposite(const SlabReach& reach) const {
        return weight[0] * reach[entry[0] ^ 1] + weight[1] * reach[entry[1] ^ 1] + weight[2] * reach[entry[2] ^ 1];
    }
};

// slabs: 9 (18-DOP) or 13 (26-DOP).
SlabSum slab_sum(const Vec3& direction, int slabs);

// Of turned points and everything within `margin` of their hull.
SlabReach slab_reach(std::span<const Vec3> points, double margin, const Mat3& rotation, int slabs);

}  // namespace kolize
