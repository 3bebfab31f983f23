#include "triangle_sides.h"
#include "vertex_welder.h"

#include <algorithm>

namespace kolize {

namespace {

// The first side of the edge that runs the other way and is not taken yet.
const Side* find_partner(Sides edge, const Side& side, const std::vector<Triangle>& triangle_edges) {
    for (const Side& other : edge)
        if (other.forward != side.forward && triangle_edges[other.triangle][other.corner] == ~0u) return &other;
    return nullptr;
}

// Every side goes with one that runs the other way; what is left over (open, misoriented or non-manifold edges) gets an
// edge of its own with t1 == t0.
void add_edges(Mesh& mesh, Sides sides) {
    for (const Side& side : sides) {
        if (mesh.triangle_edges[side.triangle][side.corner] != ~0u) continue;
        const auto id = static_cast<std::uint32_t>(mesh.edges.size());
        const Side* partner = find_partner(sides, side, mesh.triangle_edges);
        mesh.triangle_edges[side.triangle][side.corner] = id;
        if (!partner) {
            mesh.edges.push_back({side.v0, side.v1, side.triangle, side.triangle});
            continue;
        }
        mesh.triangle_edges[partner->triangle][partner->corner] = id;
        const auto [ahead, back] = side.forward ? std::pair(&side, partner) : std::pair(partner, &side);
        mesh.edges.push_back({side.v0, side.v1, ahead->triangle, back->triangle});
    }
}

}  // namespace

TriangleSoup join_equal_vertices(TriangleSoup soup) {
    std::vector<Vec3> vertices;
    VertexWelder welder(vertices);
    std::vector<std::uint32_t> joined;
    joined.reserve(soup.vertices.size());
    for (const Vec3& p : soup.vertices) joined.push_back(welder.index_of(p));
    for (Triangle& triangle : soup.triangles)
        for (std::uint32_t& v : triangle) v = joined[v];
    soup.vertices = std::move(vertices);
    return soup;
}

std::shared_ptr<const Mesh> build_mesh(const TriangleSoup& soup) { return build_mesh(soup, inspect(soup).closed()); }

std::shared_ptr<const Mesh> build_mesh(const TriangleSoup& soup, bool closed) {
    auto mesh = std::make_shared<Mesh>();
    mesh->vertices = soup.vertices;
    mesh->triangles = soup.triangles;
    mesh->valence.assign(soup.vertices.size(), 0);
    for (const Triangle& triangle : soup.triangles) {
        mesh->normals.push_back(unit_normal(soup, triangle));
        for (const std::uint32_t v : triangle) ++mesh->valence[v];
    }
    mesh->triangle_edges.assign(soup.triangles.size(), {~0u, ~0u, ~0u});
    for_each_edge(sorted_sides(soup.triangles), [&](Sides sides) { add_edges(*mesh, sides); });
    mesh->hierarchy = build_hierarchy(mesh->vertices, mesh->triangles);
    for (std::size_t v = 0; v < mesh->vertices.size(); ++v) {
        if (mesh->valence[v] == 0) continue;  // a vertex that no triangle uses takes up no space
        mesh->bounds.include(mesh->vertices[v]);
        mesh->radius = std::max(mesh->radius, mesh->vertices[v].norm());
    }
    mesh->closed = closed;
    return mesh;
}

TriangleSoup box_soup(const Vec3& half_extents) {
    TriangleSoup soup;
    for (int corner = 0; corner < 8; ++corner)
        soup.vertices.push_back(
            Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1).cwiseProduct(half_extents));
    soup.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},   // -x, +x
                      {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},   // -y, +y
                      {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};  // -z, +z
    return soup;
}

}  // namespace kolize
