#include "framework/point_sets.h"

#include <kolize/bounding_volumes.h>
#include <kolize/error.h>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace kolize;
using namespace kolize::test;

namespace {

constexpr double ulp = std::numeric_limits<double>::epsilon();

// Smallest radius about any point that is equidistant from 2, 3 or 4 of the points and holds all of them. The centre
// solves the normal equations of (c - p0) . (p - p0) = |p - p0|^2 / 2 in the flat of the points, in long double.
double brute_force_radius(const std::vector<Vec3>& points) {
    using Long = long double;
    using LongVec = Eigen::Matrix<Long, 3, 1>;
    using LongMat = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;
    double least = infinity;
    for (unsigned subset = 1; subset < 1u << points.size(); ++subset) {
        std::vector<LongVec> chosen;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (subset >> i & 1) chosen.push_back(points[i].cast<Long>());
        if (chosen.size() < 2 || chosen.size() > 4) continue;
        LongMat span(3, chosen.size() - 1);
        for (std::size_t i = 1; i < chosen.size(); ++i) span.col(i - 1) = chosen[i] - chosen[0];
        const LongMat gram = span.transpose() * span;
        const LongVec center = chosen[0] + span * gram.fullPivLu().solve(0.5L * gram.diagonal()).eval();
        Long radius = 0;
        for (const Vec3& p : points) radius = std::max(radius, (p.cast<Long>() - center).norm());
        least = std::min(least, static_cast<double>(radius));
    }
    return least;
}

std::string complaint(const std::vector<Vec3>& points) {
    try {
        smallest_enclosing_sphere(points);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("The box along the axes has the least and the largest coordinates", "[bounding_volumes]") {
    const Aabb box = bounding_box(std::vector<Vec3>{{1, 5, -2}, {3, -1, 0}, {2, 2, 7}});
    CHECK(box.min == Vec3(1, -1, -2));
    CHECK(box.max == Vec3(3, 5, 7));
}

TEST_CASE("A sphere about a centre reaches to the farthest point", "[bounding_volumes]") {
    const BoundingSphere sphere = sphere_about(Vec3(1, 0, 0), std::vector<Vec3>{{1, 0, 0}, {4, 4, 0}, {1, 0, 4.5}});
    CHECK(sphere.center == Vec3(1, 0, 0));
    CHECK(sphere.radius == 5);
    CHECK(sphere.volume() == Approx(4 * std::numbers::pi / 3 * 125).epsilon(4 * ulp));
}

TEST_CASE("The smallest sphere of well-known sets is exact to rounding", "[bounding_volumes]") {
    std::mt19937 random(1);
    for (int i = 0; i < 50; ++i) {
        CAPTURE(i);
        const Mat3 turn = random_rotation(random);
        const Vec3 place = 10 * random_vector(random);
        const auto check = [&](const std::vector<Vec3>& points, double radius) {
            const BoundingSphere sphere = smallest_enclosing_sphere(moved(points, turn, place));
            CHECK(sphere.radius == Approx(radius).epsilon(64 * ulp));  // the coordinates are rounded at 10
            CHECK((sphere.center - place).norm() < 1e-13);
        };
        check(cube_corners(0.5), std::sqrt(3.0) / 2);
        check({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, std::sqrt(3.0));
        check({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, 1);
        check({{-1, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {0, 0.999, 0}}, 1);  // held by two points only
        check({{0, 2, 0}, {std::sqrt(3.0), -1, 0}, {-std::sqrt(3.0), -1, 0}, {0, 0, 1}}, 2);
    }
}

TEST_CASE("The smallest sphere is that of a search through all supporting points", "[bounding_volumes]") {
    std::mt19937 random(2);
    for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        const int count = 2 + i % 8;
        std::vector<Vec3> points = random_points(count, random);
        if (i % 4 == 1)  // flat, or nearly so
            for (Vec3& p : points) p.z() *= i % 8 == 1 ? 0 : 1e-9;
        if (i % 4 == 2)  // the sphere is decided by rounding
            for (Vec3& p : points) p.normalize();
        if (i % 4 == 3)  // on a grid: many equal distances
            for (Vec3& p : points) p = (2 * p).array().round();
        const double expected = brute_force_radius(points);
        CHECK(std::abs(smallest_enclosing_sphere(points).radius - expected) <= 16 * ulp * expected);
    }
}

TEST_CASE("A point a hair outside moves the smallest sphere, though its radius hardly grows", "[bounding_volumes]") {
    for (const double hair : {1e-6, 1e-8, 1e-10, 1e-13}) {
        CAPTURE(hair);
        const std::vector<Vec3> points{{-1, 0, 0}, {1, 0, 0}, {0, 1 + hair, 0}};
        CHECK(smallest_enclosing_sphere(points).radius <= 1 + hair * hair / 2 + 4 * ulp);
    }
}

TEST_CASE("Every bounding volume holds all points to rounding", "[bounding_volumes]") {
    std::mt19937 random(3);
    for (const auto& [name, points] : awkward_point_sets(random)) {
        CAPTURE(name);
        const double rounding = 8 * ulp * extent_of(points);
        const Aabb aabb = bounding_box(points);
        const BoundingSphere sphere = smallest_enclosing_sphere(points);
        const OrientedBox box = oriented_box(points);
        const SlabPolytope polytope = slab_polytope(points, 26);
        double outside_aabb = 0, outside_sphere = 0, outside_box = 0, outside_polytope = 0;
        for (const Vec3& p : points) {
            outside_aabb = std::max({outside_aabb, (aabb.min - p).maxCoeff(), (p - aabb.max).maxCoeff()});
            outside_sphere = std::max(outside_sphere, (p - sphere.center).stableNorm() - sphere.radius);
            const Vec3 local = box.axes.transpose() * (p - box.center);
            outside_box = std::max(outside_box, (local.cwiseAbs() - box.half_extents).maxCoeff());
            for (std::size_t i = 0; i < polytope.directions.size(); ++i) {
                const double d = polytope.directions[i].dot(p);
                outside_polytope = std::max({outside_polytope, polytope.minima[i] - d, d - polytope.maxima[i]});
            }
        }
        CHECK(outside_aabb == 0);
        CHECK(outside_sphere <= rounding);
        CHECK(outside_box <= rounding);
        CHECK(outside_polytope == 0);
    }
}

TEST_CASE("No smallest sphere is larger than the one about the middle of the box", "[bounding_volumes]") {
    std::mt19937 random(6);
    for (const auto& [name, points] : awkward_point_sets(random)) {
        CAPTURE(name);
        const double about_middle = sphere_about(bounding_box(points).center(), points).radius;
        CHECK(smallest_enclosing_sphere(points).radius <= (1 + 8 * ulp) * about_middle);
    }
}

TEST_CASE("A bounding volume wants points that are finite, and one at least", "[bounding_volumes]") {
    CHECK(complaint({}) == "a bounding volume needs one point at least, there are none");
    CHECK(complaint({Vec3::Zero(), Vec3(0, NAN, 0)}) ==
          "the points of a bounding volume must be finite, from -1e100 to 1e100; point 1 is not");
    CHECK_THROWS_AS(bounding_box({}), Error);
    CHECK_THROWS_AS(sphere_about(Vec3::Zero(), {}), Error);
    CHECK_THROWS_AS(oriented_box(std::vector<Vec3>{Vec3(infinity, 0, 0)}), Error);
    CHECK_THROWS_AS(slab_polytope({}, 6), Error);
}
