// Closed triangle meshes with known properties, for tests of everything that takes a mesh.
#pragma once

#include <kolize/mesh.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace kolize::test {

inline TriangleSoup corner_tetrahedron() {
    TriangleSoup soup;
    soup.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return soup;
}

// A pyramid on a regular polygon in the plane y = 0, apex at (0, height, 0): n + 2 vertices, 2 n triangles.
inline TriangleSoup cone(std::uint32_t n, double radius, double height) {
    TriangleSoup soup;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        soup.vertices.emplace_back(radius * std::cos(angle), 0, radius * std::sin(angle));
    }
    soup.vertices.emplace_back(0, height, 0);
    soup.vertices.emplace_back(0, 0, 0);
    for (std::uint32_t i = 0; i < n; ++i) {
        soup.triangles.push_back({(i + 1) % n, i, n});
        soup.triangles.push_back({i, (i + 1) % n, n + 1});
    }
    return soup;
}

inline TriangleSoup cone48() { return cone(48, 100, 300); }

// Every triangle cut into four at the middle of its sides.
inline TriangleSoup subdivided(const TriangleSoup& soup) {
    TriangleSoup finer{soup.vertices, {}, {}, soup.file};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), finer.vertices.size());
        if (is_new) finer.vertices.push_back(0.5 * (soup.vertices[a] + soup.vertices[b]));
        return found->second;
    };
    for (const auto& [a, b, c] : soup.triangles) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const Triangle& t : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
            finer.triangles.push_back(t);
    }
    return finer;
}

inline TriangleSoup moved(TriangleSoup soup, const Mat3& rotation, const Vec3& translation) {
    for (Vec3& v : soup.vertices) v = rotation * v + translation;
    return soup;
}

inline Mat3 random_rotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const Eigen::Vector4d q(normal(random), normal(random), normal(random), normal(random));
    return Quat(q.normalized()).toRotationMatrix();
}

}  // namespace kolize::test
