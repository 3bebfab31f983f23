// Lines and points against a surface in integer arithmetic, which is exact. Coordinates are in eighths, and small.
#pragma once

#include <kolize/voxel_mass_properties.h>

#include <optional>

namespace kolize::test {

using Integers = Eigen::Matrix<std::int64_t, 3, 1>;

inline Integers in_eighths(const Vec3& p) { return (8 * p).cast<std::int64_t>(); }

inline int sign_of(std::int64_t x) { return (x > 0) - (x < 0); }

// How often the surface winds around the point, by a ray of its own; none if the point is on the surface or the ray
// meets an edge.
inline std::optional<int> exact_winding(const TriangleSoup& surface, const Integers& point, const Integers& direction) {
    int winding = 0;
    for (const Triangle& t : surface.triangles) {
        Integers corner[3];
        for (std::size_t i = 0; i < 3; ++i) corner[i] = in_eighths(surface.vertices[t[i]]) - point;
        int side[3];
        for (int i = 0; i < 3; ++i) side[i] = sign_of(direction.dot(corner[i].cross(corner[(i + 1) % 3])));
        const auto [least, most] = std::minmax({side[0], side[1], side[2]});
        if (least < 0 && most > 0) continue;
        if (least == 0 || most == 0) return std::nullopt;  // an edge, a corner, or a triangle without area: unclear
        const int ahead = sign_of(corner[0].dot(corner[1].cross(corner[2]))) * least;
        if (ahead == 0) return std::nullopt;
        if (ahead > 0) winding += least;
    }
    return winding;
}

inline std::optional<int> exact_winding(const TriangleSoup& surface, const Integers& point) {
    for (const Integers& direction : {Integers(1009, 131, 37), Integers(-211, 1013, 59), Integers(83, -307, 1019)})
        if (const auto winding = exact_winding(surface, point, direction)) return winding;
    return std::nullopt;
}

// Where a line crosses the planes of the triangles that it meets, corners and edges included; points in eighths.
inline std::vector<double> exact_depths(const TriangleSoup& surface, const GridLines& lines, const Integers& point) {
    std::vector<double> depths;
    Integers along = Integers::Zero();
    along[lines.axis] = 1;
    for (const Triangle& t : surface.triangles) {
        Integers corner[3];
        for (std::size_t i = 0; i < 3; ++i) corner[i] = in_eighths(surface.vertices[t[i]]) - point;
        std::int64_t part[3], sum = 0;
        for (int i = 0; i < 3; ++i) sum += part[i] = along.dot(corner[(i + 1) % 3].cross(corner[(i + 2) % 3]));
        if (sum == 0 || part[0] * sum < 0 || part[1] * sum < 0 || part[2] * sum < 0) continue;
        std::int64_t depth = 0;
        for (int i = 0; i < 3; ++i) depth += part[i] * corner[i][lines.axis];
        depths.push_back(static_cast<double>(point[lines.axis]) / 8 +
                         static_cast<double>(depth) / (8 * static_cast<double>(sum)));
    }
    return depths;
}

}  // namespace kolize::test
