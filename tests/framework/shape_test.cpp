#include "framework/solids.h"

#include <kolize/mass_properties.h>
#include <kolize/shape.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

TEST_CASE("A sphere has its closed-form volume and moments", "[shape]") {
    const Shape sphere = make_sphere("ball", 2);
    CHECK(sphere.volume == Approx(32.0 / 3 * std::numbers::pi).epsilon(1e-15));
    CHECK(sphere.moments == Vec3::Constant(1.6));
    CHECK(sphere.bounds.max == Vec3::Constant(2));
    CHECK_FALSE(sphere.mesh);
}

TEST_CASE("A box shape and the mesh of the same box have the same mass", "[shape]") {
    const Vec3 half(0.5, 1, 2);
    const Shape box = make_box("box", half);
    const Shape mesh = make_mesh("mesh", box_soup(half));
    CHECK(box.volume == 8);
    CHECK(mesh.volume == Approx(8).epsilon(1e-14));
    CHECK((box.moments - mesh.moments).norm() <= 1e-14);
    CHECK(mesh.body_to_model.coeffs() == Quat::Identity().coeffs());
    CHECK(box.mesh->closed);
    CHECK(box.radius == Approx(mesh.radius).epsilon(1e-15));
}

TEST_CASE("A mesh shape stands in its principal frame and maps back to its file", "[shape]") {
    std::mt19937 random(3);
    for (int i = 0; i < 100; ++i) {
        CAPTURE(i);
        const Mat3 rotation = random_rotation(random);
        const TriangleSoup file = moved(box_soup(Vec3(0.5, 1, 2)), rotation, 10 * rotation.col(2));
        const Shape shape = make_mesh("crate", file);
        CHECK((shape.center_in_model - 10 * rotation.col(2)).norm() <= 1e-14);
        for (std::size_t v = 0; v < file.vertices.size(); ++v) {
            const Vec3 back = shape.body_to_model * shape.mesh->vertices[v] + shape.center_in_model;
            CHECK((back - file.vertices[v]).norm() <= 1e-14);
        }
        const MassProperties body = mass_properties({shape.mesh->vertices, shape.mesh->triangles, {}, ""});
        CHECK(body.center_of_mass.norm() <= 1e-14);
        CHECK((body.inertia_over_mass - Mat3(shape.moments.asDiagonal())).norm() <= 1e-13);
    }
}

TEST_CASE("A mesh that is no solid is refused with its first defect", "[shape]") {
    TriangleSoup soup = box_soup(Vec3(1, 1, 1));
    soup.file = "lid.obj";
    soup.triangles.pop_back();
    CHECK_THROWS_WITH(make_mesh("lid", soup),
                      "the mesh must be the closed surface of a solid, but edge 4-6 has one "
                      "triangle (lid.obj, triangle 0)");
    CHECK_THROWS_AS(make_mesh("none", {}), std::invalid_argument);
}

TEST_CASE("A half space takes a normal of any length", "[shape]") {
    const Shape floor = make_half_space("floor", Vec3(0, 2, 0), 6);  // 2 y <= 6
    CHECK(floor.normal == Vec3(0, 1, 0));
    CHECK(floor.center_in_model == Vec3(0, 3, 0));
    CHECK(floor.volume == infinity);
    CHECK_FALSE(floor.bounds.finite());
}

TEST_CASE("Shapes without a usable size are refused", "[shape]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(make_sphere("s", 0), Catch::Contains("radius of a sphere must be positive and finite"));
    CHECK_THROWS_AS(make_sphere("s", nan), std::invalid_argument);
    CHECK_THROWS_AS(make_sphere("s", infinity), std::invalid_argument);
    CHECK_THROWS_WITH(make_box("b", Vec3(1, -1, 1)), Catch::Contains("half extents of a box"));
    CHECK_THROWS_AS(make_box("b", Vec3(1, nan, 1)), std::invalid_argument);
    CHECK_THROWS_AS(make_half_space("h", Vec3::Zero(), 0), std::invalid_argument);
    CHECK_THROWS_AS(make_half_space("h", Vec3::UnitX(), infinity), std::invalid_argument);
}
