// Steppings that follow each pair to its time of impact.
#include "framework/scenes.h"
#include "framework/solids.h"
#include "narrowphase/solids.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

Scene continuous(Scene scene) {
    scene.pipeline.step.mode = "continuous";
    return scene;
}

Scene box_gas() { return continuous(gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 3, 1.4, 1)); }
Scene mesh_gas() { return continuous(gas(make_mesh("bar", u_bar()), 2, 3.8, 2)); }
Scene ball_gas() { return continuous(gas(make_sphere("ball", 0.5), 3, 1.1, 3)); }

// The inside of a cube as twelve triangles without thickness.
Scene in_paper_walls(const Shape& shape, double half, const Vec3& velocity, const Vec3& spin) {
    Scene scene = continuous(empty_scene());
    BodyDescription wall, body;
    wall.shape = add_shape(scene, make_surface("walls", box_soup(Vec3::Constant(half))));
    wall.is_static = true;
    scene.world.add(wall);
    give(body, add_shape(scene, shape), Vec3::Zero(), velocity);
    body.angular_velocity = spin;
    scene.world.add(body);
    scene.pipeline.step.dt = 1.0 / 60;
    return scene;
}

}  // namespace

TEST_CASE("continuous stepping keeps energy and momentum, and nothing ever overlaps", "[continuous]") {
    for (const Scene& scene : {ball_gas(), box_gas(), mesh_gas()})
        for (const double dt : {1.0 / 240, 1.0 / 30}) {
            Scene other = scene;
            other.pipeline.step.dt = dt;
            CAPTURE(scene.world.shapes[0].name, dt);
            const RunResult result = run(other, 300);
            CHECK(result.contacts > 20);
            CHECK(result.energy_drift < 1e-13);
            CHECK(result.momentum_drift < 1e-12);
            CHECK(result.angular_momentum_drift < 1e-11);
            CHECK(result.max_penetration_m == 0);
            CHECK(result.escaped == 0);
            CHECK(result.unresolved == 0);
        }
}

TEST_CASE("continuous stepping: any broadphase and any number of threads give the same trajectory", "[continuous]") {
    for (Scene scene : {box_gas(), mesh_gas()}) {
        const RunResult reference = run(scene, 300);
        for (const char* broadphase : {"grid", "bsp", "sphere_hierarchy"})
            for (const int threads : {1, 2}) {
                CAPTURE(broadphase, threads);
                scene.pipeline.broadphase = stage(broadphase);
                CHECK(run(scene, 300, threads).state_hash == reference.state_hash);
            }
    }
}

TEST_CASE("P7 thin wall: nothing gets through walls without thickness, at any speed and spin", "[continuous]") {
    for (const double speed : {1.0, 1e3, 1e6})
        for (const double spin : {0.0, 300.0}) {
            CAPTURE(speed, spin);
            const double half = speed > 1e3 ? 1e3 : 2.0;
            Scene scene = in_paper_walls(make_mesh("spike", spike()), half,
                                         speed * Vec3(0.6, 0.48, -0.64), spin * Vec3(0.8, 0, 0.6));
            const auto host = make_host(1);
            const int steps = speed > 1e3 ? 1 : 120;
            Simulation simulation(scene, plugins(), *host, steps);
            for (int i = 0; i < steps; ++i) {
                simulation.step();
                REQUIRE(simulation.world().position[1].cwiseAbs().maxCoeff() < half);
            }
            const RunResult result = simulation.result();
            CHECK(result.contacts > 0);
            CHECK(result.energy_drift < 1e-12);
        }
}

TEST_CASE("an open surface is refused where something would have to be inside or outside of it", "[continuous]") {
    Scene scene = in_paper_walls(make_sphere("ball", 0.5), 4, Vec3(1, 2, 3), Vec3::Zero());
    scene.pipeline.step.mode = "discrete";
    REQUIRE_THROWS_WITH(run(scene, 1), Catch::Contains("is open") && Catch::Contains("continuous"));
}

TEST_CASE("P4 bouncing: balls that fall keep their energy at every step", "[continuous]") {
    for (const double dt : {1e-3, 1e-2, 1e-1}) {
        CAPTURE(dt);
        Scene scene = continuous(empty_scene());
        scene.world.forces.gravity = Vec3(0, -9.81, 0);
        scene.pipeline.step.dt = dt;
        BodyDescription floor, ball;
        floor.shape = add_shape(scene, make_half_space("floor", Vec3::UnitY(), 0));
        floor.is_static = true;
        scene.world.add(floor);
        const std::uint32_t shape = add_shape(scene, make_sphere("ball", 0.2));
        for (int i = 0; i < 7; ++i)
            for (int j = 0; j < 7; ++j)
                scene.world.add(give(ball, shape, Vec3(i, 5 + 0.05 * i + 0.01 * j, j), Vec3::Zero()));
        const RunResult result = run(scene, static_cast<std::uint64_t>(5 / dt));
        CHECK(result.contacts > 49);
        CHECK(result.energy_drift < 1e-12);
        CHECK(result.max_penetration_m == 0);
    }
}

TEST_CASE("R9 Zeno: a ball that loses half its speed comes to rest when the series ends, and stays", "[continuous]") {
    Scene scene = continuous(empty_scene());
    scene.world.forces.gravity = Vec3(0, -9.81, 0);
    scene.world.materials[0].restitution = 0.5;
    scene.pipeline.step.dt = 1e-3;
    BodyDescription floor, ball;
    floor.shape = add_shape(scene, make_half_space("floor", Vec3::UnitY(), 0));
    floor.is_static = true;
    scene.world.add(floor);
    const double radius = 0.1, fall = std::sqrt(2 / 9.81), rest = fall * (1 + 2 * 0.5 / (1 - 0.5));
    REQUIRE(rest == Approx(1.354570923).epsilon(1e-9));
    scene.world.add(give(ball, add_shape(scene, make_sphere("ball", radius)), Vec3(0, 1 + radius, 0), Vec3::Zero()));
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 2000);
    for (int i = 1; i <= 2000; ++i) {
        simulation.step();
        const double time = i * 1e-3, height = simulation.world().position[1].y() - radius;
        CAPTURE(time, height);
        REQUIRE(height >= 0);
        // The parabola of the bounce that the time falls into.
        double begin = -fall, length = 2 * fall, top = 1;
        while (begin + length <= time && length > 1e-7) begin += length, length *= 0.5, top *= 0.25;
        const double s = (time - begin) / length, expected = time < rest && length > 1e-7 ? 4 * top * s * (1 - s) : 0;
        REQUIRE(std::abs(height - expected) < 1e-6);
    }
    CHECK(simulation.world().velocity[1].norm() < 1e-2);
    CHECK(simulation.result().energy_drift < 1e-6);
}

TEST_CASE("a few fast bodies cost their own impacts and leave the others alone", "[continuous]") {
    Scene scene = box_gas();
    const RunResult calm = run(scene, 10);
    scene.world.velocity[13] *= 300;  // in the middle
    const RunResult wild = run(scene, 10);
    CHECK(wild.energy_drift < 1e-12);
    CHECK(wild.escaped == 0);
    CHECK(wild.contacts > calm.contacts);
}

TEST_CASE("bisection with many bodies stops each pair at its own moment of impact", "[continuous]") {
    Scene scene = gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 5, 1.4, 4);
    const double discrete = run(scene, 100).max_penetration_m;
    scene.pipeline.step.mode = "bisection";
    scene.pipeline.step.tolerance = 1e-4;
    const RunResult result = run(scene, 100);
    CHECK(result.contacts > 50);
    CHECK(result.max_penetration_m < discrete / 20);
    CHECK(result.energy_drift < 1e-13);
}
