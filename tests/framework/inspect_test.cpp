#include "framework/solids.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

TriangleSoup named_box() {
    TriangleSoup soup = box_soup(Vec3(1, 2, 3));
    soup.file = "box.obj";
    for (int t = 0; t < 12; ++t) soup.lines.push_back(100 + t);
    return soup;
}

void flip(Triangle& t) { std::swap(t[0], t[1]); }

// Two unit cubes side by side along a diagonal: they have the vertices of one edge in common and nothing else.
TriangleSoup cubes_with_common_edge() {
    TriangleSoup cubes = box_soup(Vec3(0.5, 0.5, 0.5));
    for (const TriangleSoup second = moved(cubes, Mat3::Identity(), Vec3(1, 1, 0));
         const Triangle& t : second.triangles) {
        Triangle& copy = cubes.triangles.emplace_back();
        for (int k = 0; k < 3; ++k) {
            cubes.vertices.push_back(second.vertices[t[k]]);
            copy[k] = static_cast<std::uint32_t>(cubes.vertices.size() - 1);
        }
    }
    return join_equal_vertices(cubes);
}

// The same triangles, each with three vertices of its own.
TriangleSoup torn(const TriangleSoup& soup) {
    TriangleSoup pieces{{}, {}, soup.lines, soup.file, soup.info, soup.notes};
    for (const Triangle& t : soup.triangles) {
        const auto first = static_cast<std::uint32_t>(pieces.vertices.size());
        for (const std::uint32_t v : t) pieces.vertices.push_back(soup.vertices[v]);
        pieces.triangles.push_back({first, first + 1, first + 2});
    }
    return pieces;
}

}  // namespace

TEST_CASE("inspect finds nothing wrong with closed outward surfaces", "[mesh]") {
    for (const TriangleSoup& soup :
         {box_soup(Vec3(1, 2, 3)), corner_tetrahedron(), cone48(), subdivided(subdivided(corner_tetrahedron()))}) {
        const MeshDefects defects = inspect(soup);
        CHECK(defects.closed());
        CHECK(defects.bounds_volume());
        CHECK(defects.repeated_triangles == 0);
        CHECK(defects.first.empty());
    }
}

TEST_CASE("inspect says that a soup has no triangles", "[mesh]") {
    const MeshDefects defects = inspect({{Vec3(0, 0, 0)}, {}, {}, "points.ply"});
    CHECK(defects.empty);
    CHECK_FALSE(defects.closed());
    CHECK(defects.first == "it has no triangles (points.ply)");
}

TEST_CASE("M9 broken: inspect counts the open edges of a missing triangle", "[mesh]") {
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
    flip(soup.triangles[11]);
    const MeshDefects defects = inspect(soup);
    CHECK(defects.misoriented_edges == 3);
    CHECK_FALSE(defects.inverted);
    CHECK(defects.first == "edge 4-6 has two triangles of opposite orientation (box.obj:111)");
}

TEST_CASE("inspect tells an inside-out surface by its volume, at any place", "[mesh]") {
    for (const double distance : {0.0, 1e3, 1e6}) {
        TriangleSoup soup = moved(named_box(), Mat3::Identity(), Vec3::Constant(distance));
        CHECK_FALSE(inspect(soup).inverted);
        for (Triangle& t : soup.triangles) flip(t);
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

TEST_CASE("inspect calls edges unbalanced where a triangle is missing or turned over", "[mesh]") {
    TriangleSoup missing = named_box();
    missing.triangles.pop_back();
    missing.lines.pop_back();
    CHECK(inspect(missing).unbalanced_edges == 3);
    CHECK_FALSE(inspect(missing).bounds_volume());

    TriangleSoup turned = named_box();
    flip(turned.triangles[4]);
    CHECK(inspect(turned).unbalanced_edges == 3);
    CHECK_FALSE(inspect(turned).bounds_volume());

    TriangleSoup inward = named_box();
    for (Triangle& t : inward.triangles) flip(t);
    CHECK(inspect(inward).bounds_volume());  // a volume of negative sign
}

TEST_CASE("inspect counts triangles that are there twice", "[mesh]") {
    TriangleSoup soup = named_box();
    const auto add = [&](const Triangle& t) {
        soup.triangles.push_back(t);
        soup.lines.push_back(100 + static_cast<int>(soup.lines.size()));
    };
    const auto [a, b, c] = soup.triangles[3];
    add({b, c, a});
    const MeshDefects twice = inspect(soup);
    CHECK(twice.repeated_triangles == 1);
    CHECK(twice.unbalanced_edges == 3);
    CHECK_FALSE(twice.closed());
    CHECK(twice.first == "triangle 12 repeats triangle 3 (box.obj:112)");

    add({c, b, a});  // takes back what the other one added
    const MeshDefects thrice = inspect(soup);
    CHECK(thrice.repeated_triangles == 2);
    CHECK(thrice.bounds_volume());
    CHECK_FALSE(thrice.closed());

    soup.lines.clear();
    CHECK(inspect(soup).first == "triangle 12 repeats triangle 3 (box.obj)");
}

TEST_CASE("Cubes that share an edge bound a volume without being two-manifold", "[mesh]") {
    const TriangleSoup cubes = cubes_with_common_edge();
    REQUIRE(cubes.vertices.size() == 14);
    const MeshDefects defects = inspect(cubes);
    CHECK(defects.non_manifold_edges == 1);
    CHECK(defects.unbalanced_edges == 0);
    CHECK(defects.open_edges == 0);
    CHECK(defects.bounds_volume());
    CHECK_FALSE(defects.closed());
}

TEST_CASE("A surface in pieces is closed once equal vertices are joined", "[mesh]") {
    TriangleSoup soup = named_box();
    soup.info = {"a box"};
    soup.notes = {"box.obj:1: nothing was passed over"};
    const TriangleSoup pieces = torn(soup);
    CHECK(inspect(pieces).open_edges == 36);
    CHECK_FALSE(inspect(pieces).bounds_volume());

    const TriangleSoup joined = join_equal_vertices(pieces);
    CHECK(inspect(joined).closed());
    CHECK(joined.vertices.size() == 8);
    REQUIRE(joined.triangles.size() == soup.triangles.size());
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            CHECK(joined.vertices[joined.triangles[t][k]] == soup.vertices[soup.triangles[t][k]]);
    CHECK(joined.lines == soup.lines);
    CHECK(joined.file == soup.file);
    CHECK(joined.info == soup.info);
    CHECK(joined.notes == soup.notes);
}

TEST_CASE("Of equal vertices the first keeps its place, and zeros of both signs are equal", "[mesh]") {
    const Vec3 a(0, 1, 2), b(3, 0, 0), near_a(std::nextafter(0.0, 1.0), 1, 2), c(5, 5, 5);
    const TriangleSoup joined =
        join_equal_vertices({{a, b, Vec3(-0.0, 1, 2), near_a, c, Vec3(3, -0.0, 0)}, {{2, 5, 3}, {0, 1, 3}}, {}, ""});
    CHECK(joined.vertices == std::vector<Vec3>{a, b, near_a, c});  // c stays though no triangle uses it
    CHECK(joined.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}});
}
