#include "triangle_sides.h"

#include <algorithm>

namespace kolize {

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
            sides.push_back({std::min(from, to), std::max(from, to), t, k, from < to});
        }
    std::sort(sides.begin(), sides.end());
    return sides;
}

// The two shorter sides are multiplied: their product is what the rounding error of the cross product scales with, so
// that needles keep an accurate normal.
Vec3 unit_normal(const TriangleSoup& soup, const Triangle& triangle) {
    const Vec3 &p = soup.vertices[triangle[0]], &q = soup.vertices[triangle[1]], &r = soup.vertices[triangle[2]];
    const Vec3 sides[3] = {q - p, r - q, p - r};
    const double length[3] = {sides[0].norm(), sides[1].norm(), sides[2].norm()};
    const auto longest = std::max_element(length, length + 3) - length;
    const auto first = (longest + 1) % 3, second = (longest + 2) % 3;
    const Vec3 area = sides[first].cross(sides[second]);
    const double norm = area.norm();
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    if (norm <= rounding * length[first] * length[second]) return Vec3::Zero();
    return area / norm;
}

}  // namespace kolize
