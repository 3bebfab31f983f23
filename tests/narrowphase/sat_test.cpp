// Separating axes: against their definition for boxes, against distances for hulls, and at rest.
#include "framework/scenes.h"
#include "framework/volumes_of_shapes.h"
#include "narrowphase/convex_solids.h"
#include "narrowphase/two_bodies.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

Vec3 random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return {uniform(random), uniform(random), uniform(random)};
}

}  // namespace

TEST_CASE("Boxes overlap as their separating axes say, a twentieth deeper at most", "[narrowphase][sat]") {
    const unsigned seed = 20261125;
    CAPTURE(seed);
    std::mt19937 random(seed);
    NarrowphaseUnderTest sat("sat");
    const Shape a = make_box("a", Vec3(0.9, 0.4, 0.25)), b = make_box("b", Vec3(0.5, 0.6, 0.3));
    int overlaps = 0;
    for (int round = 0; round < 2000; ++round) {
        const World world = world_of({a, random_vector(random, 0.7), Quat(any_rotation(random))},
                                     {b, random_vector(random, 0.7), Quat(any_rotation(random))});
        const double depth = box_depth(world);
        CAPTURE(round, depth);
        const auto rows = sat.collide(world, Detail::normal).rows;
        REQUIRE(rows.size() == (depth > 0));
        if (depth <= 0) continue;
        ++overlaps;
        CHECK(rows[0].depth > depth - 1e-9);
        CHECK(rows[0].depth < depth / 0.95 + 1e-9);
        const auto manifold = sat.collide(world).rows;
        REQUIRE(!manifold.empty());
        REQUIRE(manifold.size() <= 4);
        for (const Contact& point : manifold) {
            CHECK((point.normal - rows[0].normal).norm() < 1e-12);
            CHECK(point.depth <= rows[0].depth + 1e-12);
        }
    }
    CHECK(overlaps > 400);
}

TEST_CASE("Hulls overlap where their distance is 0, and moved apart by the depth they touch", "[narrowphase][sat]") {
    const unsigned seed = 20261126;
    CAPTURE(seed);
    std::mt19937 random(seed);
    NarrowphaseUnderTest sat("sat"), gjk("gjk_epa");
    std::vector<Vec3> cloud;
    for (int i = 0; i < 25; ++i) cloud.push_back(random_vector(random, 0.5));
    const std::vector<Shape> shapes{make_hull("dodecahedron", corners_of_dodecahedron(0.4)), make_hull("cloud", cloud),
                                    make_box("box", Vec3(0.6, 0.3, 0.2))};
    int overlaps = 0;
    for (int round = 0; round < 400; ++round) {
        const Placed a{shapes[random() % 3], random_vector(random, 0.5), Quat(any_rotation(random))};
        Placed b{shapes[random() % 3], random_vector(random, 0.5), Quat(any_rotation(random))};
        CAPTURE(round, a.shape.name, b.shape.name);
        const auto rows = sat.collide(a, b, Detail::normal).rows;
        REQUIRE(rows.size() == gjk.collide(a, b, Detail::normal).rows.size());
        if (rows.empty()) continue;
        ++overlaps;
        b.position += (rows[0].depth + 1e-9) * rows[0].normal;
        CHECK(gjk.collide(a, b, Detail::overlap).rows.empty());
        b.position -= 1e-6 * rows[0].normal;
        CHECK(gjk.collide(a, b, Detail::overlap).rows.size() == 1);
    }
    CHECK(overlaps > 100);
}

TEST_CASE("A box that lies flat has four points under its corners", "[narrowphase][sat]") {
    NarrowphaseUnderTest sat("sat");
    const Shape box = make_box("box", Vec3(0.5, 0.25, 1));
    const std::vector<Placed> floors{
        {make_half_space("floor", Vec3::UnitY(), 0), Vec3::Zero(), Quat::Identity(), true},
        {make_box("slab", Vec3(5, 1, 5)), Vec3(0, -1, 0), Quat::Identity(), true},
        {make_hull(
             "hull",
             std::vector<Vec3>{
                 {-5, -2, -5}, {5, -2, -5}, {-5, -2, 5}, {5, -2, 5}, {-5, 0, -5}, {5, 0, -5}, {-5, 0, 5}, {5, 0, 5}}),
         Vec3::Zero(), Quat::Identity(), true}};
    for (const Placed& floor : floors) {
        CAPTURE(floor.shape.name);
        const World world = world_of(floor, {box, Vec3(0, 0.249, 0)});
        const auto rows = sat.collide(world).rows;
        REQUIRE(rows.size() == 4);
        Vec3 sum = Vec3::Zero();
        for (const Contact& row : rows) {
            CHECK((row.normal - Vec3::UnitY()).norm() < 1e-9);
            CHECK(row.depth == Approx(0.001).epsilon(1e-6));
            CHECK(std::abs(row.arm_b.x()) == Approx(0.5));
            CHECK(std::abs(row.arm_b.z()) == Approx(1));
            sum += row.arm_b;
        }
        CHECK(std::hypot(sum.x(), sum.z()) < 1e-9);
    }
}

TEST_CASE("A stack of boxes and hulls stands on sat's manifolds", "[narrowphase][sat]") {
    Scene scene = empty_scene();
    scene.pipeline.narrowphase = stage("sat");
    scene.pipeline.responses = {{stage("solver"), {}}};
    scene.pipeline.step.dt = 1 / 60.0;
    scene.world.forces.gravity = Vec3(0, -9.81, 0);
    scene.world.materials[0].restitution = 0;
    scene.world.materials[0].friction = 0.5;
    BodyDescription floor;
    floor.shape = add_shape(scene, make_half_space("floor", Vec3::UnitY(), 0));
    floor.is_static = true;
    scene.world.add(floor);
    std::vector<Vec3> corners;
    for (int i = 0; i < 6; ++i)
        for (const double y : {-0.5, 0.5})
            corners.emplace_back(0.6 * std::cos(std::numbers::pi * i / 3), y, 0.6 * std::sin(std::numbers::pi * i / 3));
    const std::uint32_t box = add_shape(scene, make_box("box", Vec3::Constant(0.5)));
    const std::uint32_t prism = add_shape(scene, make_hull("prism", corners));
    for (int i = 0; i < 5; ++i) {
        BodyDescription body;
        give(body, i % 2 ? prism : box, Vec3(0, 0.5 + i, 0), Vec3::Zero());
        scene.world.add(body);
    }
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 1);
    for (int i = 0; i < 600; ++i) simulation.step();
    for (std::uint32_t i = 1; i <= 5; ++i) {
        CHECK(simulation.world().position[i].y() == Approx(i - 0.5).margin(0.01));
        CHECK(simulation.world().velocity[i].norm() < 1e-3);
    }
}
