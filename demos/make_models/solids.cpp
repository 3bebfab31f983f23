#include "models.h"

#include <array>
#include <cmath>
#include <numbers>

namespace kolize::models {

namespace {

using std::numbers::pi;

constexpr std::uint32_t round_sides = 16;

// A solid between a polygon in the plane y = 0 and its scaled copy at y = height; both are seen whole from the axis.
TriangleSoup drum(const std::vector<Eigen::Vector2d>& polygon, double top_scale, double height) {
    TriangleSoup soup;
    const auto n = static_cast<std::uint32_t>(polygon.size());
    for (const Eigen::Vector2d& p : polygon) {
        soup.vertices.emplace_back(p.x(), 0, -p.y());  // counter-clockwise seen from above
        soup.vertices.emplace_back(top_scale * p.x(), height, -top_scale * p.y());
    }
    soup.vertices.emplace_back(0, 0, 0);
    soup.vertices.emplace_back(0, height, 0);
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t low = 2 * i, high = low + 1, next_low = 2 * ((i + 1) % n), next_high = next_low + 1;
        soup.triangles.push_back({low, next_low, next_high});
        soup.triangles.push_back({low, next_high, high});
        soup.triangles.push_back({next_low, low, 2 * n});
        soup.triangles.push_back({high, next_high, 2 * n + 1});
    }
    round_vertices(soup);
    return soup;
}

std::vector<Eigen::Vector2d> polygon(std::uint32_t n, double even_radius, double odd_radius) {
    std::vector<Eigen::Vector2d> points;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double angle = 2 * pi * i / n, radius = i % 2 ? odd_radius : even_radius;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return points;
}

// A bar of 0.3 m square cells in the plane z = 0..0.3.
TriangleSoup bar(int nx, int ny, std::function<bool(int, int, int)> is_solid) {
    return lattice_surface(
        {nx, ny, 1, std::move(is_solid), [](int i, int j, int k) { return Vec3(0.3 * i, 0.3 * j, 0.3 * k); }});
}

}  // namespace

TriangleSoup tetrahedron() {
    const double radius = 0.6, base = radius * std::sqrt(8.0) / 3;  // of the spheres around solid and base
    TriangleSoup soup;
    for (int i = 0; i < 3; ++i)
        soup.vertices.emplace_back(base * std::cos(2 * pi * i / 3), 0, -base * std::sin(2 * pi * i / 3));
    soup.vertices.emplace_back(0, 4 * radius / 3, 0);
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    round_vertices(soup);
    return soup;
}

TriangleSoup frustum() { return drum(polygon(4, 0.65, 0.65), 0.5, 0.7); }

TriangleSoup cylinder() { return drum(polygon(round_sides, 0.4, 0.4), 1, 0.9); }

TriangleSoup star() { return drum(polygon(10, 0.65, 0.28), 1, 0.3); }

TriangleSoup cone() {
    TriangleSoup soup;
    for (const Eigen::Vector2d& p : polygon(round_sides, 0.5, 0.5)) soup.vertices.emplace_back(p.x(), 0, -p.y());
    soup.vertices.emplace_back(0, 0.9, 0);
    soup.vertices.emplace_back(0, 0, 0);
    for (std::uint32_t i = 0; i < round_sides; ++i) {
        soup.triangles.push_back({i, (i + 1) % round_sides, round_sides});
        soup.triangles.push_back({(i + 1) % round_sides, i, round_sides + 1});
    }
    round_vertices(soup);
    return soup;
}

TriangleSoup u_bar() {
    return bar(3, 3, [](int i, int j, int) { return i != 1 || j == 0; });
}

TriangleSoup l_bar() {
    return bar(2, 3, [](int i, int j, int) { return i == 0 || j == 0; });
}

TriangleSoup torus() {
    constexpr std::uint32_t around = 16, across = 8;
    const double ring = 0.5, tube = 0.18;
    TriangleSoup soup;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const double u = 2 * pi * i / around, v = 2 * pi * j / across, reach = ring + tube * std::cos(v);
            soup.vertices.emplace_back(reach * std::cos(u), tube + tube * std::sin(v), -reach * std::sin(u));
        }
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const std::uint32_t a = i * across + j, b = (i + 1) % around * across + j;
            const std::uint32_t c = (i + 1) % around * across + (j + 1) % across, d = i * across + (j + 1) % across;
            soup.triangles.push_back({a, b, c});
            soup.triangles.push_back({a, c, d});
        }
    round_vertices(soup);
    return soup;
}

std::span<const Model> object_models() {
    static constexpr std::array<Model, 8> models = {{{"tetrahedron", tetrahedron},
                                                     {"frustum", frustum},
                                                     {"cone", cone},
                                                     {"cylinder", cylinder},
                                                     {"u_bar", u_bar},
                                                     {"l_bar", l_bar},
                                                     {"torus", torus},
                                                     {"star", star}}};
    return models;
}

}  // namespace kolize::models
