#include "geometry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace kolize::gl {
namespace {

// Corners of triangles (corner k of triangle t is 3 t + k) that share a place and a normal, as disjoint sets.
class Corners {
public:
    explicit Corners(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

    std::uint32_t root(std::uint32_t corner) {
        while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
        return corner;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

private:
    std::vector<std::uint32_t> parent_;
};

std::uint32_t corner_at(const Mesh& mesh, std::uint32_t triangle, std::uint32_t vertex) {
    const Triangle& t = mesh.triangles[triangle];
    const auto k = static_cast<std::uint32_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
    return 3 * triangle + k;
}

Corners smooth_corners(const Mesh& mesh, double crease) {
    Corners corners(3 * mesh.triangles.size());
    const double least = std::cos(crease);
    for (const Edge& edge : mesh.edges) {
        if (edge.t0 == edge.t1 || crease <= 0 || mesh.normals[edge.t0].dot(mesh.normals[edge.t1]) < least) continue;
        for (const std::uint32_t vertex : {edge.v0, edge.v1})
            corners.join(corner_at(mesh, edge.t0, vertex), corner_at(mesh, edge.t1, vertex));
    }
    return corners;
}

// Angles as weights make the sum the same however the faces are cut into triangles (Thuermer and Wuethrich 1998).
Vec3 weighted_normal(const Mesh& mesh, std::uint32_t corner) {
    const Triangle& t = mesh.triangles[corner / 3];
    const Vec3& p = mesh.vertices[t[corner % 3]];
    const Vec3 a = mesh.vertices[t[(corner + 1) % 3]] - p, b = mesh.vertices[t[(corner + 2) % 3]] - p;
    return std::atan2(a.cross(b).norm(), a.dot(b)) * mesh.normals[corner / 3];
}

std::uint32_t middle(Surface& ball, std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>& known,
                     std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] = known.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(ball.vertices.size()));
    if (is_new) {
        const Eigen::Vector3f p = (ball.vertices[a].place + ball.vertices[b].place).normalized();
        ball.vertices.push_back({p, p});
    }
    return found->second;
}

void split(Surface& ball) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    std::vector<std::uint32_t> finer;
    for (std::size_t i = 0; i < ball.indices.size(); i += 3) {
        const std::uint32_t a = ball.indices[i], b = ball.indices[i + 1], c = ball.indices[i + 2];
        const std::uint32_t ab = middle(ball, known, a, b), bc = middle(ball, known, b, c);
        const std::uint32_t ca = middle(ball, known, c, a);
        finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    ball.indices = std::move(finer);
}

}  // namespace

Surface surface_of(const Mesh& mesh, double crease) {
    Corners corners = smooth_corners(mesh, crease);
    const auto count = static_cast<std::uint32_t>(3 * mesh.triangles.size());
    std::vector<Vec3> sums(count, Vec3::Zero());
    for (std::uint32_t corner = 0; corner < count; ++corner)
        sums[corners.root(corner)] += weighted_normal(mesh, corner);
    constexpr std::uint32_t none = ~0u;
    std::vector<std::uint32_t> vertex_of_root(count, none);
    Surface surface;
    for (std::uint32_t corner = 0; corner < count; ++corner) {
        const std::uint32_t root = corners.root(corner);
        if (vertex_of_root[root] == none) {
            vertex_of_root[root] = static_cast<std::uint32_t>(surface.vertices.size());
            const Vec3& place = mesh.vertices[mesh.triangles[corner / 3][corner % 3]];
            surface.vertices.push_back({place.cast<float>(), sums[root].normalized().cast<float>()});
        }
        surface.indices.push_back(vertex_of_root[root]);
    }
    return surface;
}

Surface unit_ball(int splits) {
    Surface ball;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {1.0f, -1.0f}) {
            const Eigen::Vector3f p = side * Eigen::Vector3f::Unit(axis);
            ball.vertices.push_back({p, p});
        }
    // Corners +x -x +y -y +z -z.
    ball.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    for (int i = 0; i < splits; ++i) split(ball);
    return ball;
}

}  // namespace kolize::gl
