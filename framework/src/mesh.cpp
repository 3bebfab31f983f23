#include <kolize/mesh.h>

#include <kolize/mass_properties.h>

#include <algorithm>
#include <span>

namespace kolize {

namespace {

// One side of a triangle. Sides of the same edge stand side by side when sorted, in the order of their triangles.
struct Side {
    std::uint32_t v0, v1;  // v0 <= v1
    std::uint32_t triangle;
    std::uint32_t corner;  // the side joins this corner and the next one
    bool forward;          // the triangle runs v0 -> v1

    bool same_edge(const Side& o) const { return v0 == o.v0 && v1 == o.v1; }
    bool operator<(const Side& o) const {
        if (v0 != o.v0) return v0 < o.v0;
        if (v1 != o.v1) return v1 < o.v1;
        return triangle != o.triangle ? triangle < o.triangle : corner < o.corner;
    }
};

using Sides = std::span<const Side>;

bool repeats_vertex(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

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

template <class Visit>
void for_each_edge(const std::vector<Side>& sides, const Visit& visit) {
    for (std::size_t begin = 0; begin < sides.size();) {
        std::size_t end = begin + 1;
        while (end < sides.size() && sides[end].same_edge(sides[begin])) ++end;
        visit(Sides(&sides[begin], end - begin));
        begin = end;
    }
}

// Unit normal of a triangle; zero if it is flat to within rounding. The two shorter sides are multiplied: their product
// is what the rounding error of the cross product scales with, so that needles keep an accurate normal.
Vec3 unit_normal(const Vec3& p, const Vec3& q, const Vec3& r) {
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

Vec3 unit_normal(const TriangleSoup& soup, const Triangle& t) {
    return unit_normal(soup.vertices[t[0]], soup.vertices[t[1]], soup.vertices[t[2]]);
}

std::string place_of(const TriangleSoup& soup, std::uint32_t triangle) {
    if (!soup.lines.empty()) return " (" + to_string(SourceLocation{soup.file, soup.lines[triangle]}) + ")";
    return " (" + (soup.file.empty() ? "" : soup.file + ", ") + "triangle " + std::to_string(triangle) + ")";
}

// Counts defects and describes the first one.
class Inspector {
public:
    explicit Inspector(const TriangleSoup& soup) : soup_(soup) {}

    MeshDefects run() {
        found_.empty = soup_.triangles.empty();
        if (found_.empty) describe("it has no triangles" + (soup_.file.empty() ? "" : " (" + soup_.file + ")"));
        look_at_triangles();
        look_at_edges();
        if (found_.closed()) look_at_volume();
        return found_;
    }

private:
    void describe(const std::string& phrase) {
        if (found_.first.empty()) found_.first = phrase;
    }

    void look_at_triangles() {
        for (std::uint32_t t = 0; t < soup_.triangles.size(); ++t) {
            const Triangle& triangle = soup_.triangles[t];
            const bool repeats = repeats_vertex(triangle);
            if (!repeats && !unit_normal(soup_, triangle).isZero(0)) continue;
            ++found_.degenerate_triangles;
            describe((repeats ? "a triangle names a vertex twice" : "a triangle has no area") + place_of(soup_, t));
        }
    }

    // A triangle that names a vertex twice is a collapsed one: without it its two neighbours share the edge.
    void look_at_edges() {
        std::vector<Side> sides = sorted_sides(soup_.triangles);
        std::erase_if(sides, [&](const Side& side) { return repeats_vertex(soup_.triangles[side.triangle]); });
        for_each_edge(sides, [&](Sides edge) { look_at_edge(edge); });
    }

    void look_at_edge(Sides edge) {
        if (edge.size() == 1) {
            ++found_.open_edges;
            describe_edge(edge, "has one triangle");
        } else if (edge.size() > 2) {
            ++found_.non_manifold_edges;
            describe_edge(edge, "has " + std::to_string(edge.size()) + " triangles");
        } else if (edge[0].forward == edge[1].forward) {
            ++found_.misoriented_edges;
            describe_edge(edge, "has two triangles of opposite orientation");
        }
    }

    void describe_edge(Sides edge, const std::string& what) {
        if (!found_.first.empty()) return;
        describe("edge " + std::to_string(edge[0].v0) + "-" + std::to_string(edge[0].v1) + " " + what +
                 place_of(soup_, edge.back().triangle));
    }

    void look_at_volume() {
        const double volume = mass_properties(soup_).volume;
        found_.inverted = volume <= 0;
        if (!found_.inverted) return;
        describe((volume < 0 ? "its triangles face inward" : "it encloses no volume") +
                 (soup_.file.empty() ? std::string() : " (" + soup_.file + ")"));
    }

    const TriangleSoup& soup_;
    MeshDefects found_;
};

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

MeshDefects inspect(const TriangleSoup& soup) { return Inspector(soup).run(); }

std::shared_ptr<const Mesh> build_mesh(const TriangleSoup& soup) {
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
    mesh->closed = inspect(soup).closed();
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
