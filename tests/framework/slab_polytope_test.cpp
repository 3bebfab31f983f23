#include "framework/point_sets.h"

#include <kolize/bounding_volumes.h>
#include <kolize/error.h>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace kolize;
using namespace kolize::test;

namespace {

struct Plane {
    Vec3 normal;
    double offset;
};

std::vector<Plane> planes_of(const SlabPolytope& polytope) {
    std::vector<Plane> planes;
    for (std::size_t i = 0; i < polytope.directions.size(); ++i) {
        planes.push_back({polytope.directions[i], polytope.maxima[i]});
        planes.push_back({-polytope.directions[i], -polytope.minima[i]});
    }
    return planes;
}

// The points where three planes meet and no plane cuts them off.
std::vector<Vec3> vertices_of(const std::vector<Plane>& planes, double tolerance) {
    std::vector<Vec3> vertices;
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = i + 1; j < planes.size(); ++j)
            for (std::size_t k = j + 1; k < planes.size(); ++k) {
                Mat3 normals;
                normals << planes[i].normal, planes[j].normal, planes[k].normal;
                if (std::abs(normals.determinant()) < 0.5) continue;  // the normals are of integers
                const Vec3 p =
                    normals.transpose().inverse() * Vec3(planes[i].offset, planes[j].offset, planes[k].offset);
                const auto holds = [&](const Plane& plane) { return plane.normal.dot(p) <= plane.offset + tolerance; };
                if (std::all_of(planes.begin(), planes.end(), holds)) vertices.push_back(p);
            }
    return vertices;
}

// Area of the convex polygon of points in a plane: the fan of the triangles about their middle, by angle.
double polygon_area(std::vector<Vec3> points, const Vec3& normal) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : points) middle += p / points.size();
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const auto angle = [&](const Vec3& p) { return std::atan2(v.dot(p - middle), u.dot(p - middle)); };
    std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) { return angle(a) < angle(b); });
    double area = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        area += (points[i] - middle).cross(points[(i + 1) % points.size()] - middle).dot(normal) / 2;
    return area;
}

// Volume from the vertices: pyramids over the vertices that lie in each plane.
double volume_by_vertices(const SlabPolytope& polytope) {
    const std::vector<Plane> planes = planes_of(polytope);
    const double tolerance = 1e-10;
    const std::vector<Vec3> vertices = vertices_of(planes, tolerance);
    if (vertices.empty()) return 0;
    Vec3 inner = Vec3::Zero();
    for (const Vec3& p : vertices) inner += p / vertices.size();
    double volume = 0;
    for (const Plane& plane : planes) {
        std::vector<Vec3> face;
        for (const Vec3& p : vertices)
            if (plane.normal.dot(p) >= plane.offset - tolerance) face.push_back(p);
        const double length = plane.normal.norm();
        if (face.size() >= 3)
            volume += (plane.offset - plane.normal.dot(inner)) / length * polygon_area(face, plane.normal / length) / 3;
    }
    return volume;
}

std::vector<Vec3> octahedron() { return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}; }

}  // namespace

TEST_CASE("A slab polytope has the bounds of the points along its directions", "[bounding_volumes]") {
    const std::vector<Vec3> points{{1, 2, 3}, {-4, 0, 5}};
    const SlabPolytope polytope = slab_polytope(points, 26);
    REQUIRE(polytope.directions.size() == 13);
    for (std::size_t i = 0; i < polytope.directions.size(); ++i) {
        const Vec3& direction = polytope.directions[i];
        CHECK(direction.cwiseAbs().maxCoeff() == 1);
        CHECK(polytope.minima[i] == std::min(direction.dot(points[0]), direction.dot(points[1])));
        CHECK(polytope.maxima[i] == std::max(direction.dot(points[0]), direction.dot(points[1])));
        for (std::size_t j = 0; j < i; ++j) CHECK(direction.cross(polytope.directions[j]).norm() > 0.5);
    }
    CHECK(slab_polytope(points, 6).directions.size() == 3);
    CHECK(slab_polytope(points, 18).directions.size() == 9);
}

TEST_CASE("A slab polytope has 6, 18 or 26 planes", "[bounding_volumes]") {
    CHECK_THROWS_WITH(slab_polytope(octahedron(), 14), "a slab polytope has 6, 18 or 26 planes, not 14");
    CHECK_THROWS_AS(slab_polytope(octahedron(), 0), Error);
}

TEST_CASE("Slabs that touch a box in edges and corners take nothing off it", "[bounding_volumes]") {
    std::mt19937 random(30);
    for (int i = 0; i < 100; ++i) {
        const auto half_extent = [&] { return std::pow(10, random_number(random, -i / 12.0, i / 12.0)); };
        const Vec3 half(half_extent(), half_extent(), half_extent());  // from cubes to needles and plates
        for (const int planes : {6, 18, 26}) {
            CAPTURE(half, planes);
            CHECK(slab_polytope(box_soup(half).vertices, planes).volume() == Approx(8 * half.prod()).epsilon(1e-14));
        }
    }
}

TEST_CASE("The slab polytopes of simple solids have the volumes of geometry", "[bounding_volumes]") {
    CHECK(slab_polytope(octahedron(), 6).volume() == Approx(8).epsilon(1e-14));
    CHECK(slab_polytope(octahedron(), 18).volume() == Approx(2).epsilon(1e-14));  // a rhombic dodecahedron
    CHECK(slab_polytope(octahedron(), 26).volume() == Approx(4.0 / 3).epsilon(1e-14));
    CHECK(slab_polytope(corner_tetrahedron().vertices, 26).volume() == Approx(1.0 / 6).epsilon(1e-14));
}

TEST_CASE("The volume of a slab polytope is that of its vertices", "[bounding_volumes]") {
    std::mt19937 random(31);
    for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        std::vector<Vec3> points = random_points(4 + i, random);
        if (i % 3 == 1)  // as tight as a ball
            for (Vec3& p : points) p.normalize();
        if (i % 3 == 2)  // on a grid: many planes through one vertex
            for (Vec3& p : points) p = (2 * p).array().round();
        const SlabPolytope polytope = slab_polytope(points, i % 2 ? 18 : 26);
        CHECK(std::abs(polytope.volume() - volume_by_vertices(polytope)) < 1e-9);
    }
}

TEST_CASE("More planes never make a slab polytope larger", "[bounding_volumes]") {
    std::mt19937 random(32);
    for (const auto& [name, points] : awkward_point_sets(random)) {
        CAPTURE(name);
        const double with6 = slab_polytope(points, 6).volume(), with18 = slab_polytope(points, 18).volume(),
                     with26 = slab_polytope(points, 26).volume();
        CHECK(with18 <= with6 * (1 + 1e-13));
        CHECK(with26 <= with18 * (1 + 1e-13));
    }
}

TEST_CASE("The slab polytope of a flat set that lies in one of its planes has no volume", "[bounding_volumes]") {
    CHECK(slab_polytope(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 26).volume() == 0);
    CHECK(slab_polytope(std::vector<Vec3>{{1, 2, 3}}, 26).volume() == 0);
    const std::vector<Vec3> oblique{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    CHECK(slab_polytope(oblique, 26).volume() < 1e-15);
}
