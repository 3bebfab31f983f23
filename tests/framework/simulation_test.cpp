#include "framework/scenes.h"
#include "framework/solids.h"
#include "narrowphase/solids.h"
#include "oracle/allocation_counter.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

Scene box_gas() { return gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 3, 1.4, 1); }
Scene mesh_gas() { return gas(make_mesh("bar", u_bar()), 2, 3.8, 2); }

}  // namespace

TEST_CASE("any broadphase and any number of threads give the same trajectory", "[simulation]") {
    for (Scene scene : {box_gas(), mesh_gas()}) {
        const RunResult reference = run(scene, 600);
        CHECK(reference.contacts > 20);
        for (const char* broadphase : {"brute_force", "grid", "bsp", "sphere_hierarchy"})
            for (const int threads : {1, 2}) {
                CAPTURE(broadphase, threads);
                scene.pipeline.broadphase = stage(broadphase);
                const RunResult result = run(scene, 600, threads);
                CHECK(result.state_hash == reference.state_hash);
                CHECK(result.contacts == reference.contacts);
                CHECK(result.pairs == reference.pairs);
            }
    }
}

TEST_CASE("a gas of elastic bodies keeps energy and momentum in every stepping that claims to", "[simulation]") {
    for (const char* mode : {"discrete", "bisection"})
        for (Scene scene : {box_gas(), mesh_gas()}) {
            CAPTURE(mode);
            scene.pipeline.step.mode = mode;
            const RunResult result = run(scene, 600);
            CHECK(result.contacts > 20);
            CHECK(result.energy_drift < 1e-13);
            CHECK(result.momentum_drift < 1e-12);
            CHECK(result.angular_momentum_drift < 1e-11);
            CHECK(result.escaped == 0);
            CHECK(result.stuck == 0);
        }
}

TEST_CASE("a step in four parts is four steps", "[simulation]") {
    for (const char* mode : {"discrete", "rollback", "bisection", "continuous"}) {
        CAPTURE(mode);
        Scene scene = mesh_gas();
        scene.pipeline.step.mode = mode;
        scene.pipeline.step.dt = 1.0 / 64;
        scene.pipeline.step.substeps = 4;
        const RunResult parts = run(scene, 50);
        scene.pipeline.step.dt /= 4;
        scene.pipeline.step.substeps = 1;
        const RunResult steps = run(scene, 200);
        CHECK(parts.contacts > 5);
        CHECK(parts.state_hash == steps.state_hash);
        CHECK(parts.contacts == steps.contacts);
        CHECK(parts.events == steps.events);
        CHECK(parts.time == steps.time);
    }
}

TEST_CASE("bisection stops bodies at the moment of impact", "[simulation]") {
    Scene scene = box_gas();
    const double discrete = run(scene, 300).max_penetration_m;
    scene.pipeline.step.mode = "bisection";
    scene.pipeline.step.tolerance = 1e-4;
    CHECK(run(scene, 300).max_penetration_m < discrete / 20);
}

TEST_CASE("after a step with rollback nothing overlaps that was free before", "[simulation]") {
    Scene scene = box_gas();
    scene.pipeline.step.mode = "rollback";
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 300);
    for (int i = 0; i < 300; ++i) {
        simulation.step();
        CAPTURE(i);
        CHECK(simulation.contacts().rows.empty());  // of the last look of the step, after bodies went back
    }
    CHECK(simulation.result().contacts > 20);
    CHECK(simulation.result().energy_drift < 1e-13);
}

TEST_CASE("two bodies that meet head on exchange velocities", "[simulation]") {
    Scene scene = empty_scene();
    const std::uint32_t ball = add_shape(scene, make_sphere("ball", 0.5));
    BodyDescription left, right;
    scene.world.add(give(left, ball, Vec3(-2, 0, 0), Vec3(1, 0, 0)));
    scene.world.add(give(right, ball, Vec3(2, 0, 0), Vec3(-1, 0, 0)));
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 800);
    for (int i = 0; i < 800; ++i) simulation.step();
    CHECK(simulation.world().velocity[0] == Vec3(-1, 0, 0));
    CHECK(simulation.world().velocity[1] == Vec3(1, 0, 0));
}

TEST_CASE("warm steps allocate nothing", "[simulation]") {
    if (!AllocationCounter::available()) {
        WARN("allocations cannot be counted in this build");
        return;
    }
    for (const char* demo : {"box_cubes", "box_objects", "box_fighter"})
        for (const char* mode : {"discrete", "rollback", "bisection"}) {
            CAPTURE(demo, mode);
            Scene scene = load_scene(std::string(KOLIZE_SOURCE_DIR "/demos/") + demo + "/scene.toml", {}, plugins());
            scene.pipeline.step.mode = mode;
            const auto host = make_host(1);
            Simulation simulation(scene, plugins(), *host, 2000);
            for (int i = 0; i < 600; ++i) simulation.step();
            const std::uint64_t contacts_before = simulation.result().contacts;
            const AllocationCounter allocations;
            for (int i = 0; i < 1400; ++i) simulation.step();
            CHECK(allocations.count() == 0);
            CHECK(simulation.result().contacts > contacts_before);
        }
}

TEST_CASE("an explosion removes the missile, tells where, and looks no further than the first triangles",
          "[simulation]") {
    Scene scene = empty_scene();
    const std::uint32_t shape = add_shape(scene, make_mesh("cone", subdivided(subdivided(cone(48, 1, 3)))));
    BodyDescription target, missile;
    scene.world.add(give(target, shape, Vec3::Zero(), Vec3::Zero()));
    give(missile, shape, Vec3(4, 0.3, 0.1), Vec3(-30, 0, 0)).kind = "missile";
    scene.world.add(missile);
    const auto run_with = [&](const char* response) {
        scene.pipeline.responses = {{stage(response), {"missile"}}};
        const auto host = make_host(1);
        auto simulation = std::make_unique<Simulation>(scene, plugins(), *host, 40);
        std::size_t explosions = 0;
        for (int i = 0; i < 40; ++i) {
            simulation->step();
            for (const Event& event : simulation->events()) explosions += event.kind == EventKind::explosion;
        }
        return std::tuple(simulation->result(), explosions, simulation->world().removed);
    };
    const auto [exploded, explosions, removed] = run_with("explode");
    CHECK(explosions == 1);
    CHECK(removed == std::vector<std::uint8_t>{0, 1});
    CHECK(exploded.energy_drift < 1e-14);  // what left with the missile is accounted for
    const auto [bounced, none, kept] = run_with("impulse");
    CHECK(none == 0);
    CHECK(bounced.contacts > 0);
    CHECK(10 * exploded.triangle_tests < bounced.triangle_tests);
}

TEST_CASE("balls that only bounce simply never reach a triangle", "[simulation]") {
    Scene scene = mesh_gas();
    const std::uint32_t ball = scene.world.intern_kind("ball");
    for (auto& kind : scene.world.kind) kind = ball;
    scene.pipeline.responses = {{stage("simple_bounce"), {"ball"}}};
    const RunResult result = run(scene, 600);
    CHECK(result.contacts > 20);
    CHECK(result.triangle_tests == 0);
    CHECK(result.energy_drift < 1e-13);
}

TEST_CASE("rules send each pair to the first response that fits", "[simulation]") {
    Scene scene = empty_scene();
    const std::uint32_t ball = add_shape(scene, make_sphere("ball", 0.5));
    for (const auto& [kind, x, v] : {std::tuple("missile", -3.0, 4.0), std::tuple("body", -1.0, 0.0),
                                     std::tuple("ball", 3.0, -4.0), std::tuple("ghost", 5.0, -40.0)}) {
        BodyDescription body;
        give(body, ball, Vec3(x, 0, 0), Vec3(v, 0, 0)).kind = kind;
        scene.world.add(body);
    }
    scene.pipeline.responses = {{stage("explode"), {"missile"}}, {stage("impulse"), {"ball", "body"}}};
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 240);
    for (int i = 0; i < 240; ++i) simulation.step();
    const World& world = simulation.world();
    CHECK(world.removed == std::vector<std::uint8_t>{1, 0, 0, 0});
    CHECK(world.velocity[1] == Vec3(-4, 0, 0));  // hit by the ball, which stopped
    CHECK(world.velocity[2] == Vec3::Zero());
    CHECK(world.velocity[3] == Vec3(-40, 0, 0));  // no rule takes a ghost: it flies through everything
}

TEST_CASE("a ball that falls and bounces keeps its energy at any step", "[simulation]") {
    for (const double dt : {1.0 / 30, 1.0 / 240}) {
        CAPTURE(dt);
        Scene scene = empty_scene();
        scene.world.forces.gravity = Vec3(0, -9.81, 0);
        scene.pipeline.step.dt = dt;
        BodyDescription body;
        scene.world.add(give(body, add_shape(scene, make_sphere("ball", 0.5)), Vec3(0, 0, 0), Vec3(1, 0, 2)));
        scene.rooms.push_back(room_of(5));
        const RunResult result = run(scene, static_cast<std::uint64_t>(20 / dt));
        CHECK(result.contacts > 5);
        CHECK(result.energy_drift < 1e-12);
        CHECK(result.momentum_drift < 1e-11);
        CHECK(result.angular_momentum_drift < 1e-11);
        CHECK(result.escaped == 0);
    }
}

TEST_CASE("energy that restitution takes is accounted for, energy that appears is not", "[simulation]") {
    Scene scene = box_gas();
    scene.world.materials[0].restitution = 0.5;
    const RunResult inelastic = run(scene, 300);
    CHECK(inelastic.energy_final_J < 0.9 * inelastic.energy_initial_J);
    CHECK(inelastic.energy_drift < 1e-13);

    Scene spinning = gas(make_mesh("bar", u_bar()), 1, 100, 3);
    spinning.pipeline.step.integrator = "momentum_euler";
    const RunResult growing = run(spinning, 2000);
    CHECK(growing.energy_final_J > 1.001 * growing.energy_initial_J);
    CHECK(growing.energy_drift == Approx(growing.energy_final_J / growing.energy_initial_J - 1).epsilon(0.01));
}

TEST_CASE("a body that leaves its room is counted once, and one with no number for a position too", "[simulation]") {
    Scene scene = gas(make_sphere("ball", 0.2), 2, 1, 4);
    scene.rooms[0].open = {true, true, true, true, true, false};
    scene.rooms[0].min = Vec3(-1, -1, -1);
    const RunResult open = run(scene, 480);
    CHECK(open.escaped == 0);  // an open side does not bound
    scene.rooms[0].open = {};
    scene.pipeline.responses = {{stage("impulse"), {"nobody"}}};  // nothing answers: everything leaves
    CHECK(run(scene, 480).escaped == 8);
}
