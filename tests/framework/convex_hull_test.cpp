#include "framework/scenes.h"

#include <kolize/convex_hull.h>
#include <kolize/mass_properties.h>
#include <kolize/predicates.h>

#include <catch2/catch.hpp>

#include <numbers>

using namespace kolize;
using namespace kolize::test;

namespace {

// Closed, oriented, and with no point outside of any face: by exact predicates.
void require_hull(const std::vector<Vec3>& points, const TriangleSoup& hull) {
    const MeshDefects defects = inspect(hull);
    CAPTURE(defects.first);
    REQUIRE(defects.closed());
    for (const auto& [a, b, c] : hull.triangles)
        for (const Vec3& p : points) REQUIRE(orient3d(hull.vertices[a], hull.vertices[b], hull.vertices[c], p) <= 0);
}

}  // namespace

TEST_CASE("A convex hull holds all points and has no dent", "[convex_hull]") {
    for (unsigned seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        // Few different coordinates: many points coincide, or lie on lines and in planes with others.
        const int steps = seed % 3 == 0 ? 3 : seed % 3 == 1 ? 7 : 1 << 20;
        std::uniform_int_distribution<int> coordinate(0, steps);
        std::vector<Vec3> points;
        for (int i = 0; i < 60; ++i) {
            const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
            points.push_back(Vec3(x, y, z) / steps);
        }
        require_hull(points, convex_hull(points));
    }
}

TEST_CASE("The hull of a cube's corners, edges and middle is the cube", "[convex_hull]") {
    std::vector<Vec3> points;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) points.emplace_back(x, y, z);
    std::mt19937 random(7);
    for (int round = 0; round < 20; ++round) {
        std::shuffle(points.begin(), points.end(), random);
        const TriangleSoup hull = convex_hull(points);
        require_hull(points, hull);
        CHECK(mass_properties(hull).volume == Approx(8).epsilon(1e-14));
    }
}

TEST_CASE("Points that span no solid have no hull", "[convex_hull]") {
    const Vec3 o = Vec3::Zero(), x = Vec3::UnitX(), y = Vec3::UnitY();
    CHECK_THROWS_WITH(convex_hull({}), "a convex hull needs points");
    for (const std::vector<Vec3>& flat :
         {std::vector{o}, {o, o, o, o}, {o, x, Vec3(2 * x), Vec3(3 * x)}, {o, x, y, Vec3(x + y)}})
        CHECK_THROWS_WITH(convex_hull(flat), "the points of a convex hull must not lie in one plane");
    CHECK_THROWS_WITH(convex_hull(std::vector{o, x, Vec3(0, std::nan(""), 0)}),
                      "the points of a convex hull must be finite");
}

TEST_CASE("A capsule has the mass of a fine mesh of it", "[shape]") {
    for (const double half_height : {0.0, 0.3, 4.0}) {
        CAPTURE(half_height);
        const double radius = 0.5;
        const Shape capsule = make_capsule("capsule", radius, half_height);
        std::vector<Vec3> points;
        constexpr int meridians = 64, circles = 32;
        for (const double end : {-1.0, 1.0})
            for (int i = 0; i <= circles; ++i)
                for (int k = 0; k < (i == circles ? 1 : meridians); ++k) {
                    const double latitude = 0.5 * std::numbers::pi * i / circles;
                    const double longitude = 2 * std::numbers::pi * (k + 0.5 * (i % 2)) / meridians;
                    points.emplace_back(radius * std::cos(latitude) * std::cos(longitude),
                                        end * (half_height + radius * std::sin(latitude)),
                                        radius * std::cos(latitude) * std::sin(longitude));
                }
        const MassProperties mesh = mass_properties(convex_hull(points));
        CHECK(capsule.volume == Approx(mesh.volume).epsilon(0.01));
        for (int axis = 0; axis < 3; ++axis)
            CHECK(capsule.moments[axis] == Approx(mesh.inertia_over_mass(axis, axis)).epsilon(0.01));
    }
    const Shape ball = make_capsule("ball", 2, 0), sphere = make_sphere("sphere", 2);
    CHECK((ball.moments - sphere.moments).norm() < 1e-14);
    CHECK(ball.volume == Approx(sphere.volume));
    CHECK_THROWS_WITH(make_capsule("", -1, 1), "the radius of a capsule must be positive and finite, is -1.000000");
}

TEST_CASE("Hulls collide as meshes of the same form do, in every stepping", "[hull]") {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 0.4 : -0.4, i & 2 ? 0.3 : -0.3, i & 4 ? 0.5 : -0.5);
    const Shape hull = make_hull("hull", corners), mesh = make_mesh("mesh", convex_hull(corners));
    for (const char* mode : {"discrete", "continuous"}) {
        CAPTURE(mode);
        Scene hulls = gas(hull, 3, 1.4, 5), meshes = gas(mesh, 3, 1.4, 5);
        hulls.pipeline.step.mode = meshes.pipeline.step.mode = mode;
        const RunResult of_hulls = run(hulls, 120), of_meshes = run(meshes, 120);
        CHECK(of_hulls.state_hash == of_meshes.state_hash);
        CHECK(of_hulls.contacts > 0);
    }
}

TEST_CASE("A capsule is refused where the narrowphase does not take it, and runs where it does", "[capsule_shape]") {
    Scene scene = gas(make_capsule("capsule", 0.3, 0.4), 3, 1.6, 6);
    scene.pipeline.narrowphase = stage("sat");
    CHECK_THROWS_WITH(run(scene, 1), Catch::Contains("capsule") && Catch::Contains("bounding_volume"));
    scene.pipeline.narrowphase = stage("bounding_volume", {{"volume", "sphere"}});
    scene.pipeline.responses = {{stage("simple_bounce"), {}}};
    const RunResult result = run(scene, 240);
    CHECK(result.contacts > 0);
    CHECK(result.escaped == 0);
}
