// Closed outward surfaces with curved sides.
#pragma once

#include "framework/solids.h"

namespace kolize::test {

// An octahedron, subdivided and blown up: vertices on the sphere of radius 1, 8 * 4^levels triangles.
inline TriangleSoup unit_sphere(int levels) {
    TriangleSoup soup;
    soup.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    soup.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int i = 0; i < levels; ++i) soup = subdivided(soup);
    for (Vec3& v : soup.vertices) v.normalize();
    return soup;
}

// About the z axis: radius 1 to the middle of a tube of the given radius; 2 * around * across triangles.
inline TriangleSoup torus(double tube, std::uint32_t around, std::uint32_t across) {
    TriangleSoup soup;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
            const double r = 1 + tube * std::cos(v);
            soup.vertices.emplace_back(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
            const std::uint32_t next_i = (i + 1) % around, next_j = (j + 1) % across;
            const std::uint32_t a = i * across + j, b = next_i * across + j;
            const std::uint32_t c = next_i * across + next_j, d = i * across + next_j;
            soup.triangles.push_back({a, b, c});
            soup.triangles.push_back({a, c, d});
        }
    return soup;
}

}  // namespace kolize::test
