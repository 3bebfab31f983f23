// Non-convex test bodies.
#pragma once

#include <kolize/mesh.h>

namespace kolize::test {

// A "U" in the x-y plane, its feet up: floor y = 0, inner floor y = 1, feet end at y = 2 over x in +-[0.5, 1.5];
// z from -0.5 to 0.5.
inline TriangleSoup u_bar() {
    const double outline[8][2] = {{-1.5, 0}, {1.5, 0}, {1.5, 2}, {0.5, 2}, {0.5, 1}, {-0.5, 1}, {-0.5, 2}, {-1.5, 2}};
    const Triangle cap[6] = {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}};
    TriangleSoup soup;
    for (const double z : {-0.5, 0.5})
        for (const auto& [x, y] : outline) soup.vertices.emplace_back(x, y, z);
    for (const auto& [a, b, c] : cap) {
        soup.triangles.push_back({a + 8, b + 8, c + 8});
        soup.triangles.push_back({a, c, b});
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
        const std::uint32_t j = (i + 1) % 8;
        soup.triangles.push_back({i, j, j + 8});
        soup.triangles.push_back({i, j + 8, i + 8});
    }
    return soup;
}

// A square pyramid, apex down at the origin, base 2 x 2 at y = 1.
inline TriangleSoup spike() {
    TriangleSoup soup;
    soup.vertices = {Vec3(0, 0, 0), Vec3(-1, 1, -1), Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(-1, 1, 1)};
    soup.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 4, 3}, {1, 3, 2}};
    return soup;
}

}  // namespace kolize::test
