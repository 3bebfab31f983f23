#include "bounding_volumes/slab_reach.h"

#include <algorithm>

namespace kolize {

namespace {

// Entries of SlabReach for the directions with these signs (+1 or -1) along the given axes, in ascending order.
int axis_entry(int axis, int sign) { return 2 * axis + (sign < 0); }

int edge_entry(int i, int j, const std::array<int, 3>& signs) {
    if (i > j) std::swap(i, j);
    const int first = i == 1 ? 7 : j == 1 ? 3 : 5;
    return 2 * (first + (signs[i] != signs[j])) + (signs[i] < 0);
}

int corner_entry(const std::array<int, 3>& signs) {
    return 2 * (9 + 2 * (signs[1] != signs[0]) + (signs[2] != signs[0])) + (signs[0] < 0);
}

}  // namespace

SlabSum slab_sum(const Vec3& direction, int slabs) {
    const Vec3 size = direction.cwiseAbs();
    std::array<int, 3> axes{0, 1, 2}, signs{};
    for (int k = 0; k < 3; ++k) signs[k] = direction[k] < 0 ? -1 : 1;
    if (size[axes[0]] < size[axes[1]]) std::swap(axes[0], axes[1]);
    if (size[axes[1]] < size[axes[2]]) std::swap(axes[1], axes[2]);
    if (size[axes[0]] < size[axes[1]]) std::swap(axes[0], axes[1]);
    const auto [i, j, k] = axes;
    const double x = size[i], y = size[j], z = size[k];  // descending
    const int along = axis_entry(i, signs[i]), edge = edge_entry(i, j, signs), other_edge = edge_entry(i, k, signs);
    if (slabs == 13) return {{corner_entry(signs), edge, along}, {z, y - z, x - y}};
    if (x >= y + z) return {{edge, other_edge, along}, {y, z, std::max(x - y - z, 0.0)}};
    return {{edge, other_edge, edge_entry(j, k, signs)}, {0.5 * (x + y - z), 0.5 * (x + z - y), 0.5 * (y + z - x)}};
}

SlabReach slab_reach(std::span<const Vec3> points, double margin, const Mat3& rotation, int slabs) {
    std::array<double, 13> low, high;  // by slab_directions; all of them, because so the loop below is a few vectors
    low.fill(infinity);
    high.fill(-infinity);
    for (const Vec3& point : points) {
        const Vec3 p = rotation * point;
        const double x = p.x(), y = p.y(), z = p.z(), sum = x + y, difference = x - y;
        const std::array<double, 13> along{x,     y,     z,       sum,     difference,     x + z,         x - z,
                                           y + z, y - z, sum + z, sum - z, difference + z, difference - z};
        for (int i = 0; i < 13; ++i) {
            low[i] = std::min(low[i], along[i]);
            high[i] = std::max(high[i], along[i]);
        }
    }
    SlabReach reach{};
    for (int i = 0; i < slabs; ++i) {
        const double outward = margin * slab_direction(i).norm();
        reach[2 * i] = high[i] + outward;
        reach[2 * i + 1] = outward - low[i];
    }
    return reach;
}

}  // namespace kolize
