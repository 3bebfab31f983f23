// Named cases of whole pipelines: what a run has to keep, for how long, at which steps.
#include "framework/scenes.h"

#include <kolize/mesh_io.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

Vec3 random_vector(std::mt19937& random, double length) {
    std::normal_distribution<double> normal(0, 1);
    const double x = normal(random), y = normal(random), z = normal(random);
    return length * Vec3(x, y, z).normalized();
}

Shape fighter(double scale) {
    TriangleSoup soup = read_mesh(KOLIZE_SOURCE_DIR "/demos/box_fighter/fighter.obj");
    for (Vec3& vertex : soup.vertices) vertex *= scale;
    return make_mesh("fighter", soup);
}

// One fighter in a cube of 600 m: the case that blew up in the source thesis.
Scene box_fighter(unsigned seed, double dt, double spin) {
    std::mt19937 random(seed);
    Scene scene = empty_scene();
    BodyDescription body;
    give(body, add_shape(scene, fighter(1)), Vec3::Zero(), random_vector(random, Vec3(90, 70, -55).norm()));
    body.angular_velocity = random_vector(random, spin);
    scene.world.add(body);
    scene.rooms.push_back(room_of(300));
    scene.pipeline.step.dt = dt;
    return scene;
}

Scene fighter_gas(unsigned seed, double dt) {
    Scene scene = gas(fighter(3.0 / 197), 3, 2.85, seed);
    scene.pipeline.broadphase = stage("grid");
    scene.pipeline.step.dt = dt;
    return scene;
}

void check_elastic(const RunResult& result) {
    CHECK(result.contacts > 0);
    CHECK(result.energy_drift < 1e-12);
    CHECK(result.escaped == 0);
    CHECK(result.stuck == 0);
}

}  // namespace

TEST_CASE("P1 Box-Fighter: a fighter bounces in a box for an hour, stopped at impacts or not", "[long_run]") {
    constexpr double hour = 3600, dt = 1.0 / 60;
    for (const char* mode : {"discrete", "bisection"}) {
        CAPTURE(mode);
        Scene scene = box_fighter(1, dt, 2);
        scene.pipeline.step.mode = mode;
        check_elastic(run(scene, static_cast<std::uint64_t>(hour / dt)));
    }
    Scene scene = box_fighter(1, dt, 2);
    scene.pipeline.step.mode = "continuous";
    const RunResult touched = run(scene, static_cast<std::uint64_t>(60 / dt));
    check_elastic(touched);
    CHECK(touched.max_penetration_m <= 1e-7);
}

TEST_CASE("P2 sweep: the same at other steps, spins and starts", "[long_run]") {
    constexpr double wing = 100;  // m
    for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240})
        for (const double spin : {0.2, 2.0, 20.0})
            for (unsigned seed = 1; seed <= 4; ++seed) {
                CAPTURE(dt, spin, seed);
                Scene scene = box_fighter(seed, dt, spin);
                // A wing may go no farther than a fraction of the body in a step that looks at its end only.
                if (spin * dt * wing > 0.2 * wing) scene.pipeline.step.mode = "continuous";
                check_elastic(run(scene, 3000));
            }
}

TEST_CASE("P3 gas: 27 fighters keep their energy and share it between motion and rotation", "[long_run]") {
    for (const double dt : {1.0 / 30, 1.0 / 240}) {
        CAPTURE(dt);
        check_elastic(run(fighter_gas(2, dt), 3000));
    }
    // Equipartition: three degrees of freedom each. The mean of independent stretches of 20 s, after 40 s to mix.
    const Scene scene = fighter_gas(3, 1.0 / 60);
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 12000);
    std::vector<double> shares;
    for (int stretch = -2; stretch < 8; ++stretch) {
        double moving = 0, turning = 0;
        for (int i = 0; i < 1200; ++i) {
            simulation.step();
            if (i % 10) continue;
            const World& world = simulation.world();
            for (std::uint32_t body = 0; body < 27; ++body) {
                const double linear = 0.5 * world.velocity[body].squaredNorm() / world.inverse_mass[body];
                moving += linear;
                turning += world.kinetic_energy(body) - linear;
            }
        }
        if (stretch >= 0) shares.push_back(moving / (moving + turning));
    }
    double mean = 0, spread = 0;
    for (const double share : shares) mean += share / static_cast<double>(shares.size());
    for (const double share : shares) spread += (share - mean) * (share - mean);
    const double error = std::sqrt(spread / (static_cast<double>(shares.size()) * (shares.size() - 1.0)));
    CAPTURE(mean, error);
    CHECK(std::abs(mean - 0.5) < 3 * error + 0.005);
}

TEST_CASE("P5 elastic666: 216 balls fall on each other without losing or winning energy", "[long_run]") {
    for (const char* mode : {"discrete", "continuous"}) {
        CAPTURE(mode);
        Scene scene = empty_scene();
        scene.pipeline.broadphase = stage("grid");
        scene.world.forces.gravity = Vec3(0, -9.81, 0);
        scene.pipeline.step.mode = mode;
        scene.pipeline.step.dt = 1e-3;
        std::mt19937 random(5);
        std::uniform_real_distribution<double> aside(-0.01, 0.01);
        const std::uint32_t ball = add_shape(scene, make_sphere("ball", 0.2));
        BodyDescription floor, body;
        floor.shape = add_shape(scene, make_half_space("floor", Vec3::UnitY(), 0));
        floor.is_static = true;
        scene.world.add(floor);
        for (int i = 0; i < 216; ++i) {
            const double x = aside(random), z = aside(random);
            scene.world.add(
                give(body, ball, Vec3(0.5 * (i % 6) + x, 0.5 + 0.5 * (i / 36), 0.5 * (i / 6 % 6) + z), Vec3::Zero()));
        }
        const RunResult result = run(scene, 1500);
        CHECK(result.contacts > 216);
        CHECK(result.energy_drift < 1e-10);
        CHECK(result.escaped == 0);
    }
}

TEST_CASE("P9 predictability: a nudge of 1e-12 m grows as in any billiard, not by a jump", "[long_run]") {
    const auto host = make_host(1);
    Scene scene = box_fighter(7, 1.0 / 60, 2), nudged = scene;
    scene.pipeline.step.mode = nudged.pipeline.step.mode = "continuous";
    nudged.world.position[0].x() += 1e-12;
    Simulation first(scene, plugins(), *host, 600), second(nudged, plugins(), *host, 600);
    double last = 1e-12;
    int horizon = 0;
    for (; horizon < 600 && last < 1; ++horizon) {
        first.step();
        second.step();
        const double distance = (first.world().position[0] - second.world().position[0]).norm();
        CAPTURE(horizon, last, distance);
        // An impact multiplies what there is; it does not depend on which side of a threshold a body lies.
        CHECK(distance < 1e3 * last + 1e-9);
        last = std::max(last, distance);
    }
    INFO("horizon " << horizon << " steps, distance " << last << " m");
    CHECK(horizon > 100);
}
