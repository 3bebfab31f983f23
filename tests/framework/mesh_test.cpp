#include "framework/solids.h"

#include <catch2/catch.hpp>

#include <set>

using namespace kolize;
using namespace kolize::test;

namespace {

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
