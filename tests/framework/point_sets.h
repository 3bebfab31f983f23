// Point sets for tests of bounding volumes: all the ways in which points can lie badly.
#pragma once

#include "framework/solids.h"

#include <string>
#include <vector>

namespace kolize::test {

struct PointSet {
    std::string name;
    std::vector<Vec3> points;
};

inline double random_number(std::mt19937& random, double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
}

inline Vec3 random_vector(std::mt19937& random) {
    return {random_number(random, -1, 1), random_number(random, -1, 1), random_number(random, -1, 1)};
}

template <class Make>
std::vector<Vec3> make_points(int count, const Make& make) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(make());
    return points;
}

inline std::vector<Vec3> moved(std::vector<Vec3> points, const Mat3& rotation, const Vec3& translation) {
    for (Vec3& p : points) p = rotation * p + translation;
    return points;
}

inline std::vector<Vec3> random_points(int count, std::mt19937& random) {
    return make_points(count, [&] { return random_vector(random); });
}

inline std::vector<Vec3> cube_corners(double half) { return box_soup(Vec3::Constant(half)).vertices; }

inline std::vector<PointSet> awkward_point_sets(std::mt19937& random) {
    const Mat3 turn = random_rotation(random);
    const Vec3 normal = random_vector(random), along = random_vector(random), far(1e6, -3e6, 2e6);
    const std::vector<Vec3> cloud = random_points(50, random);
    std::vector<Vec3> repeated(50, normal);
    repeated.resize(100, along);
    return {
        {"one point", {normal}},
        {"one point, many times", std::vector<Vec3>(20, normal)},
        {"two points", {normal, along}},
        {"two points, many times", repeated},
        {"three points", random_points(3, random)},
        {"on a line", make_points(30, [&] { return Vec3(normal + random_number(random, -1, 1) * along); })},
        {"in a plane", make_points(30, [&] { return random_vector(random).cross(normal).eval(); })},
        {"in the plane z = 0",
         make_points(30, [&] { return Vec3(random_vector(random).cwiseProduct(Vec3(1, 1, 0))); })},
        {"on a sphere", make_points(50, [&] { return random_vector(random).normalized(); })},
        {"on a circle", make_points(50, [&] { return random_vector(random).cross(normal).normalized().eval(); })},
        {"a cube", cube_corners(1)},
        {"a turned cube", moved(cube_corners(1), turn, along)},
        {"a needle",
         moved(make_points(30, [&] { return random_vector(random).cwiseProduct(Vec3(1, 1e-7, 1e-9)).eval(); }), turn,
               along)},
        {"a cloud", cloud},
        {"two clusters", make_points(30, [&] { return Vec3(1e-9 * random_vector(random) + (random() % 2) * along); })},
        {"a far cloud", moved(cloud, turn, far)},
        {"a far sphere", make_points(50, [&] { return Vec3(random_vector(random).normalized() + far); })},
        {"a far plane", make_points(30, [&] { return Vec3(random_vector(random).cross(normal) + far); })},
        {"huge", moved(cloud, 1e90 * turn, Vec3::Zero())},
        {"tiny", moved(cloud, 1e-200 * turn, Vec3::Zero())},
    };
}

// The largest coordinate difference, never 0: what "a few ulp of their extent" refers to.
inline double extent_of(const std::vector<Vec3>& points) {
    Aabb box;
    for (const Vec3& p : points) box.include(p);
    return std::max((box.max - box.min).maxCoeff(), std::numeric_limits<double>::min());
}

}  // namespace kolize::test
