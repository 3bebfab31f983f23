#include "framework/solids.h"

#include <catch2/catch.hpp>

#include <set>

using namespace kolize;
using namespace kolize::test;

namespace {

TriangleSoup named_box() {
    TriangleSoup soup = box_soup(Vec3(1, 2, 3));
    soup.file = "box.obj";
    for (int t = 0; t < 12; ++t) soup.lines.push_back(100 + t);
    return soup;
}

// The closed surfaces that the property tests below run over.
std::vector<TriangleSoup> closed_solids() {
    return {box_soup(Vec3(1, 2, 3)), corner_tetrahedron(), cone48(), subdivided(subdivided(corner_tetrahedron()))};
}

bool runs(const Triangle& t, std::uint32_t from, std::uint32_t to) {
    for (int k = 0; k < 3; ++k)
        if (t[k] == from && t[(k + 1) % 3] == to) return true;
    return false;
}

}  // namespace

TEST_CASE("inspect finds nothing wrong with closed outward surfaces", "[mesh]") {
    for (const TriangleSoup& soup : closed_solids()) {
        const MeshDefects defects = inspect(soup);
        CHECK(defects.closed());
        CHECK(defects.first.empty());
    }
}

TEST_CASE("inspect says that a soup has no triangles", "[mesh]") {
    const MeshDefects defects = inspect({{Vec3(0, 0, 0)}, {}, {}, "points.ply"});
    CHECK(defects.empty);
    CHECK_FALSE(defects.closed());
    CHECK(defects.first == "it has no triangles (points.ply)");
}

TEST_CASE("inspect counts the open edges of a missing triangle", "[mesh]") {
    TriangleSoup soup = named_box();
    soup.triangles.erase(soup.triangles.begin());  // {0, 4, 6}
    soup.lines.erase(soup.lines.begin());
    const MeshDefects defects = inspect(soup);
    CHECK(defects.open_edges == 3);
    CHECK_FALSE(defects.closed());
    CHECK(defects.first == "edge 0-4 has one triangle (box.obj:105)");  // its other triangle is {0, 5, 4}
}

TEST_CASE("inspect counts edges with three triangles", "[mesh]") {
    TriangleSoup soup = corner_tetrahedron();
    soup.vertices.emplace_back(1, 1, 1);
    soup.triangles.push_back({1, 2, 4});
    const MeshDefects defects = inspect(soup);
    CHECK(defects.non_manifold_edges == 1);
    CHECK(defects.open_edges == 2);
    CHECK(defects.first == "edge 1-2 has 3 triangles (triangle 4)");
}

TEST_CASE("inspect counts edges that two triangles run through the same way", "[mesh]") {
    TriangleSoup soup = named_box();
    std::swap(soup.triangles[11][0], soup.triangles[11][1]);
    const MeshDefects defects = inspect(soup);
    CHECK(defects.misoriented_edges == 3);
    CHECK_FALSE(defects.inverted);
    CHECK(defects.first == "edge 4-6 has two triangles of opposite orientation (box.obj:111)");
}

TEST_CASE("inspect tells an inside-out surface by its volume, at any place", "[mesh]") {
    for (const double distance : {0.0, 1e3, 1e6}) {
        TriangleSoup soup = moved(named_box(), Mat3::Identity(), Vec3::Constant(distance));
        CHECK_FALSE(inspect(soup).inverted);
        for (Triangle& t : soup.triangles) std::swap(t[0], t[1]);
        const MeshDefects defects = inspect(soup);
        CHECK(defects.inverted);
        CHECK(defects.first == "its triangles face inward (box.obj)");
    }
}

TEST_CASE("inspect refuses a closed surface that encloses nothing", "[mesh]") {
    const MeshDefects defects =
        inspect({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 2, 1}}, {}, ""});
    CHECK(defects.inverted);
    CHECK(defects.first == "it encloses no volume");
}

TEST_CASE("inspect counts triangles without area", "[mesh]") {
    TriangleSoup twice = named_box();
    twice.triangles.push_back({3, 3, 5});
    twice.lines.push_back(200);
    CHECK(inspect(twice).degenerate_triangles == 1);
    CHECK(inspect(twice).open_edges == 0);  // a collapsed triangle opens nothing
    CHECK(inspect(twice).first == "a triangle names a vertex twice (box.obj:200)");

    std::mt19937 random(7);
    for (int i = 0; i < 100; ++i) {  // three points of a line, rounded
        const Vec3 direction = random_rotation(random).col(0), start = random_rotation(random).col(1);
        const TriangleSoup line{{start, start + 0.3 * direction, start + direction}, {{0, 1, 2}}, {}, ""};
        CAPTURE(i);
        CHECK(inspect(line).degenerate_triangles + (build_mesh(line)->normals[0].norm() > 0.5) == 1);
    }
}

TEST_CASE("A thin triangle is not taken for one without area", "[mesh]") {
    for (const double thickness : {1e-3, 1e-9, 1e-15, 1e-60}) {
        CAPTURE(thickness);
        for (const Vec3& tip : {Vec3(0, thickness, 0), Vec3(1, thickness, 0)}) {
            const TriangleSoup needle{{Vec3(0, 0, 0), Vec3(1, 0, 0), tip}, {{0, 1, 2}}, {}, ""};
            CHECK(inspect(needle).degenerate_triangles == 0);
            CHECK(build_mesh(needle)->normals[0] == Vec3(0, 0, 1));
        }
        CHECK(inspect(box_soup(Vec3(1, 1, thickness))).closed());
    }
}

TEST_CASE("Every edge of a closed mesh is run through once each way, as documented", "[mesh]") {
    for (const TriangleSoup& soup : closed_solids()) {
        const auto mesh = build_mesh(soup);
        CHECK(mesh->closed);
        CHECK(mesh->vertices.size() + mesh->triangles.size() == mesh->edges.size() + 2);  // Euler, genus 0
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
        for (const Edge& edge : mesh->edges) {
            REQUIRE(edge.v0 < edge.v1);
            REQUIRE(runs(mesh->triangles[edge.t0], edge.v0, edge.v1));
            REQUIRE(runs(mesh->triangles[edge.t1], edge.v1, edge.v0));
            REQUIRE(seen.emplace(edge.v0, edge.v1).second);
        }
    }
}

TEST_CASE("Side k of a triangle joins vertex k and the next one", "[mesh]") {
    TriangleSoup open = box_soup(Vec3(1, 1, 1));
    open.triangles.resize(7);
    std::vector<TriangleSoup> soups = closed_solids();
    soups.push_back(open);
    for (const TriangleSoup& soup : soups) {
        const auto mesh = build_mesh(soup);
        for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t)
            for (std::uint32_t k = 0; k < 3; ++k) {
                const Edge& edge = mesh->edges.at(mesh->triangle_edges[t][k]);
                const auto [low, high] = std::minmax(mesh->triangles[t][k], mesh->triangles[t][(k + 1) % 3]);
                REQUIRE((edge.v0 == low && edge.v1 == high));
                REQUIRE((edge.t0 == t || edge.t1 == t));
            }
    }
}

TEST_CASE("Valence counts the triangles around each vertex", "[mesh]") {
    const auto mesh = build_mesh(cone48());
    CHECK(mesh->valence[48] == 48);
    CHECK(mesh->valence[49] == 48);
    for (int v = 0; v < 48; ++v) CHECK(mesh->valence[v] == 4);
}

TEST_CASE("Normals of a mesh are unit and point out of a convex solid", "[mesh]") {
    for (const TriangleSoup& soup : {box_soup(Vec3(1, 2, 3)), moved(cone48(), Mat3::Identity(), Vec3(0, -75, 0))}) {
        const auto mesh = build_mesh(soup);
        for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
            CHECK(mesh->normals[t].norm() == Approx(1).epsilon(1e-15));
            CHECK(mesh->normals[t].dot(mesh->vertices[mesh->triangles[t][0]]) > 0);
        }
    }
}

TEST_CASE("A box is twelve outward triangles with the given half extents", "[mesh]") {
    const auto mesh = build_mesh(box_soup(Vec3(1, 2, 3)));
    CHECK(mesh->closed);
    CHECK(mesh->triangles.size() == 12);
    CHECK(mesh->bounds.min == Vec3(-1, -2, -3));
    CHECK(mesh->bounds.max == Vec3(1, 2, 3));
    CHECK(mesh->radius == Approx(std::sqrt(14.0)).epsilon(1e-15));
    for (const Vec3& normal : mesh->normals) CHECK(normal.cwiseAbs().sum() == 1);
}

TEST_CASE("An open or non-manifold soup makes a mesh that says so", "[mesh]") {
    TriangleSoup soup = corner_tetrahedron();
    soup.vertices.emplace_back(1, 1, 1);
    soup.triangles.push_back({1, 2, 4});
    const auto mesh = build_mesh(soup);
    CHECK_FALSE(mesh->closed);
    CHECK(mesh->edges.size() == 9);  // six of the tetrahedron, three of the fin
    for (const std::uint32_t e : mesh->triangle_edges[4]) CHECK(mesh->edges[e].t0 == mesh->edges[e].t1);
}

TEST_CASE("A vertex that no triangle uses does not widen the mesh", "[mesh]") {
    TriangleSoup soup = box_soup(Vec3(1, 1, 1));
    soup.vertices.emplace_back(1e6, 0, 0);
    const auto mesh = build_mesh(soup);
    CHECK(mesh->closed);
    CHECK(mesh->bounds.max == Vec3(1, 1, 1));
    CHECK(mesh->radius == Approx(std::sqrt(3.0)));
}
