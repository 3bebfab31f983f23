#include "framework/round_solids.h"
#include "oracle/exact_triangles.h"

#include <catch2/catch.hpp>
#include <kolize/self_intersection.h>

#include <set>

using namespace kolize;
using namespace kolize::test;

namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

oracle::Corners exact_corners(const TriangleSoup& soup, std::uint32_t triangle) {
    oracle::Corners corners;
    for (std::size_t k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
            corners[k][i] = static_cast<std::int64_t>(soup.vertices[soup.triangles[triangle][k]][i]);
    return corners;
}

// An edge of one triangle passes through the other one's interior.
bool cross_properly(const oracle::Corners& a, const oracle::Corners& b) {
    for (int k = 0; k < 3; ++k)
        for (const bool of_a : {true, false}) {
            const oracle::Corners &edges = of_a ? a : b, &face = of_a ? b : a;
            if (oracle::segment_triangle(edges[k], edges[(k + 1) % 3], face) == oracle::Answer::intersect) return true;
        }
    return false;
}

// All crossings of a soup with whole coordinates, in exact arithmetic.
Pairs exact_crossings(const TriangleSoup& soup) {
    Pairs pairs;
    for (std::uint32_t a = 0; a < soup.triangles.size(); ++a)
        for (std::uint32_t b = a + 1; b < soup.triangles.size(); ++b) {
            const Triangle &ta = soup.triangles[a], &tb = soup.triangles[b];
            if (std::find_first_of(ta.begin(), ta.end(), tb.begin(), tb.end()) != ta.end()) continue;
            if (cross_properly(exact_corners(soup, a), exact_corners(soup, b))) pairs.emplace(a, b);
        }
    return pairs;
}

void check_against_oracle(const TriangleSoup& soup) {
    const Pairs exact = exact_crossings(soup);
    const SelfIntersections found = find_self_intersections(soup);
    CHECK(found.pairs == exact.size());
    if (exact.empty() || found.pairs == 0) return;
    CHECK(std::pair(found.triangle_a, found.triangle_b) == *exact.begin());
}

TriangleSoup joined(TriangleSoup a, const TriangleSoup& b) {
    const auto count = static_cast<std::uint32_t>(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const auto& [p, q, r] : b.triangles) a.triangles.push_back({p + count, q + count, r + count});
    return a;
}

TriangleSoup shifted(const TriangleSoup& soup, const Vec3& by) { return moved(soup, Mat3::Identity(), by); }

// Triangles with whole coordinates from 0 to the limit; each vertex is used by about three of them.
TriangleSoup random_soup(std::mt19937_64& random, std::uint32_t triangles, std::int64_t limit) {
    std::uniform_int_distribution<std::int64_t> coordinate(0, limit);
    std::uniform_int_distribution<std::uint32_t> vertex(0, triangles - 1);
    TriangleSoup soup;
    for (std::uint32_t i = 0; i < triangles; ++i) {
        Vec3& p = soup.vertices.emplace_back();
        for (double& x : p) x = static_cast<double>(coordinate(random));
    }
    for (std::uint32_t i = 0; i < triangles; ++i) {
        Triangle& t = soup.triangles.emplace_back();
        for (std::uint32_t& v : t) v = vertex(random);
    }
    return soup;
}

double distance_to_plane(const TriangleSoup& soup, std::uint32_t triangle, const Vec3& point) {
    const auto& [a, b, c] = soup.triangles[triangle];
    const Vec3& p = soup.vertices[a];
    const Vec3 normal = (soup.vertices[b] - p).cross(soup.vertices[c] - p).normalized();
    return std::abs(normal.dot(point - p));
}

}  // namespace

TEST_CASE("Two cubes that reach into each other cross where exact arithmetic says so", "[self_intersection]") {
    const TriangleSoup cube = box_soup(Vec3(10, 10, 10));
    for (const Vec3& by : {Vec3(7, 5, 3), Vec3(1, 2, 19), Vec3(-4, 9, 1)}) {
        CAPTURE(by.transpose());
        const TriangleSoup both = joined(cube, shifted(cube, by));
        CHECK(find_self_intersections(both).pairs > 0);
        check_against_oracle(both);
    }
}

TEST_CASE("The point of a crossing lies on both triangles", "[self_intersection]") {
    constexpr unsigned seed = 4;
    CAPTURE(seed);
    std::mt19937 random(seed);
    for (int i = 0; i < 50; ++i) {
        const TriangleSoup cube = moved(box_soup(Vec3(1, 1, 1)), random_rotation(random), Vec3(1.2, 0.3, 0.1));
        const TriangleSoup both = joined(box_soup(Vec3(1, 1, 1)), cube);
        const SelfIntersections found = find_self_intersections(both);
        REQUIRE(found.pairs > 0);
        CHECK(found.triangle_a < 12);
        CHECK(found.triangle_b >= 12);
        for (const std::uint32_t t : {found.triangle_a, found.triangle_b}) {
            CHECK(distance_to_plane(both, t, found.point) < 1e-14);
            Aabb box;
            for (const std::uint32_t v : both.triangles[t]) box.include(both.vertices[v]);
            CHECK((found.point - box.min).minCoeff() > -1e-14);
            CHECK((box.max - found.point).minCoeff() > -1e-14);
        }
    }
}

TEST_CASE("Random triangles cross where exact arithmetic says so", "[self_intersection]") {
    constexpr unsigned seed = 5;
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const std::int64_t limit : {2ll, 3ll, 5ll, 100ll, 1ll << 39})  // the small ones are full of special positions
        for (const std::uint32_t triangles : {2u, 10u, 100u}) {
            CAPTURE(limit, triangles);
            for (int i = 0; i < 10; ++i) check_against_oracle(random_soup(random, triangles, limit));
        }
}

TEST_CASE("Surfaces that do not pass through themselves have no crossings", "[self_intersection]") {
    std::mt19937 random(6);
    for (const TriangleSoup& soup : {unit_sphere(4), torus(0.4, 60, 30), torus(0.98, 60, 30), cone48(),
                                     box_soup(Vec3(1, 1e-9, 1)), box_soup(Vec3(1, 2, 3))})
        for (const double distance : {0.0, 1e3, 1e6}) {
            CAPTURE(soup.triangles.size(), distance);
            CHECK(find_self_intersections(soup).pairs == 0);
            const TriangleSoup far = moved(soup, random_rotation(random), Vec3::Constant(distance));
            CHECK(find_self_intersections(far).pairs == 0);
        }
}

TEST_CASE("Solids that only touch have no crossings, however they are turned", "[self_intersection]") {
    constexpr unsigned seed = 7;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const TriangleSoup cube = box_soup(Vec3(1, 1, 1)), small = box_soup(Vec3(0.5, 0.5, 0.5));
    const TriangleSoup touching[] = {
        joined(cube, shifted(cube, Vec3(2, 0, 0))),        // face to face
        joined(cube, shifted(cube, Vec3(2, 0.3, 0.7))),    // shifted along it
        joined(cube, shifted(cube, Vec3(2, 2, 0))),        // edge to edge
        joined(cube, shifted(cube, Vec3(2, 2, 2))),        // corner to corner
        joined(cube, cube),                                // in the same place
        joined(cube, shifted(small, Vec3(0, 0, 1.5))),     // on a face
        joined(cube, shifted(small, Vec3(0.1, 0, -0.5))),  // inside of a face
    };
    for (const TriangleSoup& both : touching)
        for (const double distance : {0.0, 10.0, 1e5}) {
            CAPTURE(both.vertices[8].transpose(), distance);
            CHECK(find_self_intersections(both).pairs == 0);
            for (int i = 0; i < 30; ++i) {
                const TriangleSoup turned = moved(both, random_rotation(random), Vec3::Constant(distance));
                CHECK(find_self_intersections(turned).pairs == 0);
            }
        }
}

TEST_CASE("A crossing of more than rounding is found far from the origin", "[self_intersection]") {
    const TriangleSoup cube = box_soup(Vec3(1, 1, 1));
    for (const double distance : {0.0, 1e3, 1e6}) {
        const double depth = 1e-14 * std::max(1.0, distance);
        CAPTURE(distance);
        // A spike with its tip in the middle of a triangle of the cube, once above and once below the face.
        for (const bool inside : {false, true}) {
            TriangleSoup spike = cone(3, 1, 1);
            for (Vec3& v : spike.vertices) v = Vec3(v.x() + 0.3, v.z() - 0.2, 2 - v.y());
            spike.vertices[3].z() += inside ? -1e3 * depth : 1e3 * depth;
            const TriangleSoup both = shifted(joined(cube, spike), Vec3::Constant(distance));
            CHECK((find_self_intersections(both).pairs > 0) == inside);
        }
    }
}

TEST_CASE("A soup without triangles, or with collapsed ones, has no crossings", "[self_intersection]") {
    CHECK(find_self_intersections({}).pairs == 0);
    const std::vector<Vec3> points = {Vec3(0, 0, -1), Vec3(0, 0, 1),  Vec3(-1, -1, 0),
                                      Vec3(2, -1, 0), Vec3(-1, 2, 0), Vec3(0, 0, 0)};
    CHECK(find_self_intersections({points, {{0, 1, 1}, {5, 5, 5}, {2, 2, 2}}, {}, ""}).pairs == 0);
    CHECK(find_self_intersections({points, {{0, 1, 1}, {2, 3, 4}}, {}, ""}).pairs == 1);  // a side is a side
}
