#include "framework/point_sets.h"

#include <kolize/bounding_volumes.h>
#include <kolize/mass_properties.h>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace kolize;
using namespace kolize::test;

namespace {

Vec3 extents_along(const Mat3& axes, const std::vector<Vec3>& points) {
    Aabb box;
    for (const Vec3& p : points) box.include(axes.transpose() * p);
    return box.max - box.min;
}

Mat3 principal_axes(const std::vector<Vec3>& points) {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : points) mean += p / points.size();
    Mat3 covariance = Mat3::Zero();
    for (const Vec3& p : points) covariance += (p - mean) * (p - mean).transpose();
    return principal_frame(covariance).axes.toRotationMatrix();
}

double least_volume_by_scan(const std::vector<Vec3>& points, int rotations, std::mt19937& random) {
    double least = infinity;
    for (int i = 0; i < rotations; ++i) least = std::min(least, extents_along(random_rotation(random), points).prod());
    return least;
}

}  // namespace

TEST_CASE("The oriented box of a turned box full of points is that box", "[bounding_volumes]") {
    std::mt19937 random(11);
    for (int i = 0; i < 20; ++i) {
        CAPTURE(i);
        const Vec3 half = i % 4 == 0 ? Vec3::Ones() : Vec3(random_vector(random).cwiseAbs() + Vec3::Constant(0.01));
        std::vector<Vec3> points = box_soup(half).vertices;
        for (int inside = 0; inside < 20 * (i % 5); ++inside)
            points.push_back(random_vector(random).cwiseProduct(half));
        const Vec3 place = 5 * random_vector(random);
        const OrientedBox box = oriented_box(moved(points, random_rotation(random), place));
        CHECK(box.volume() == Approx(8 * half.prod()).epsilon(1e-12));
        CHECK((box.center - place).norm() < 1e-12);
    }
}

TEST_CASE("The oriented box of a regular tetrahedron is the cube whose face diagonals it takes", "[bounding_volumes]") {
    std::mt19937 random(12);
    const std::vector<Vec3> tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (int i = 0; i < 20; ++i) {
        CAPTURE(i);
        const OrientedBox box = oriented_box(moved(tetrahedron, random_rotation(random), random_vector(random)));
        CHECK(box.volume() == Approx(8).epsilon(1e-12));
    }
}

TEST_CASE("The oriented box of a turned cone is not larger than the one that stands upright", "[bounding_volumes]") {
    std::mt19937 random(13);
    for (int i = 0; i < 2; ++i) {
        CAPTURE(i);
        const OrientedBox box = oriented_box(moved(cone(48, 1, 3), random_rotation(random), Vec3::Zero()).vertices);
        CHECK(box.volume() <= 2 * 2 * 3 * (1 + 1e-12));
    }
}

TEST_CASE("No oriented box is larger than the box along the axes or along the principal axes", "[bounding_volumes]") {
    std::mt19937 random(14);
    for (const auto& [name, points] : awkward_point_sets(random)) {
        CAPTURE(name);
        // The centre is a point of the frame: rounded there, it costs what coordinates cost.
        const double extent = extent_of(points), rounding = 1e-15 * (extent + points[0].cwiseAbs().maxCoeff());
        const Vec3 loss = Vec3::Constant(2 * rounding);
        const double volume = oriented_box(points).volume();
        CHECK(volume <= (extents_along(Mat3::Identity(), points) + loss).prod() * (1 + 1e-13));
        CHECK(volume <= (extents_along(principal_axes(points), points) + loss).prod() * (1 + 1e-13));
    }
}

TEST_CASE("No rotation found at random gives a box that is smaller by more than a little", "[bounding_volumes]") {
    std::mt19937 random(17);
    for (const int count : {4, 6, 10, 30}) {
        CAPTURE(count);
        const std::vector<Vec3> points = random_points(count, random);
        CHECK(oriented_box(points).volume() <= 1.0001 * least_volume_by_scan(points, 5000, random));
    }
}

TEST_CASE("The oriented box of very many points holds them all and is as tight", "[bounding_volumes]") {
    std::mt19937 random(22);
    const Vec3 half(1, 2, 3);
    std::vector<Vec3> points = box_soup(half).vertices;
    for (int inside = 0; inside < 5000; ++inside) points.push_back(random_vector(random).cwiseProduct(half));
    points = moved(points, random_rotation(random), Vec3::Zero());
    const OrientedBox box = oriented_box(points);
    CHECK(box.volume() == Approx(48).epsilon(1e-12));
    for (const Vec3& p : points)
        REQUIRE(((box.axes.transpose() * (p - box.center)).cwiseAbs() - box.half_extents).maxCoeff() <= 1e-14);
}

TEST_CASE("The oriented box of a flat set is flat and tight in its plane", "[bounding_volumes]") {
    std::mt19937 random(18);
    for (int i = 0; i < 20; ++i) {
        CAPTURE(i);
        const double width = i % 2 ? 0.5 : 1e-6;
        std::vector<Vec3> points{{-1, -width, 0}, {1, -width, 0}, {1, width, 0}, {-1, width, 0}};
        for (int inside = 0; inside < 10; ++inside)
            points.push_back(random_vector(random).cwiseProduct(Vec3(1, width, 0)));
        const OrientedBox box = oriented_box(moved(points, random_rotation(random), Vec3::Zero()));
        CHECK(box.half_extents[0] == Approx(1).epsilon(1e-12));
        CHECK(box.half_extents[1] == Approx(width).epsilon(1e-9));
        CHECK(box.half_extents[2] < 1e-14);
    }
}

TEST_CASE("The oriented box of a straight set has its length only", "[bounding_volumes]") {
    std::mt19937 random(19);
    for (int i = 0; i < 20; ++i) {
        CAPTURE(i);
        const Vec3 along = random_vector(random).normalized();
        std::vector<Vec3> points{-along, along};
        for (int inside = 0; inside < 10; ++inside) points.push_back(random_number(random, -1, 1) * along);
        const OrientedBox box = oriented_box(points);
        CHECK(box.half_extents[0] == Approx(1).epsilon(1e-14));
        CHECK(box.half_extents[1] < 1e-14);
        CHECK(box.half_extents[2] < 1e-14);
    }
}

TEST_CASE("A box along the axes keeps exact axes", "[bounding_volumes]") {
    const OrientedBox box = oriented_box(moved(box_soup(Vec3(1, 2, 3)).vertices, Mat3::Identity(), Vec3(5, 6, 7)));
    CHECK(box.center == Vec3(5, 6, 7));
    CHECK(box.half_extents == Vec3(3, 2, 1));
    CHECK(box.axes.col(0) == Vec3(0, 0, 1));
    CHECK(box.axes.col(1) == Vec3(0, 1, 0));
    CHECK(box.axes.col(2) == Vec3(-1, 0, 0));
}

TEST_CASE("The axes of an oriented box are orthonormal, right-handed and in order", "[bounding_volumes]") {
    std::mt19937 random(20);
    for (const auto& [name, points] : awkward_point_sets(random)) {
        CAPTURE(name);
        const OrientedBox box = oriented_box(points);
        CHECK((box.axes.transpose() * box.axes - Mat3::Identity()).cwiseAbs().maxCoeff() <= 1e-15);
        CHECK(box.axes.determinant() > 0);
        CHECK(box.half_extents[0] >= box.half_extents[1]);
        CHECK(box.half_extents[1] >= box.half_extents[2]);
        CHECK(box.half_extents[2] >= 0);
    }
}

TEST_CASE("The oriented box of the same points is the same to the last bit", "[bounding_volumes]") {
    std::mt19937 random(21);
    const std::vector<Vec3> points = random_points(100, random);
    const OrientedBox first = oriented_box(points), second = oriented_box(points);
    CHECK(first.axes == second.axes);
    CHECK(first.center == second.center);
    CHECK(first.half_extents == second.half_extents);
}
