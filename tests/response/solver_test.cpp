// Resting contact: what the solver makes of stacks, slopes, wheels and heaps in whole runs.
#include "framework/scenes.h"

#include <kolize/capsule.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

constexpr double g = 9.81;

// A floor whose top lies at height 0, or leans by an angle about the z axis.
Scene floor_scene(double dt, double friction, double slope = 0, const std::map<std::string, Value>& settings = {}) {
    Scene scene = empty_scene();
    scene.pipeline.broadphase = stage("grid");
    scene.pipeline.responses = {{stage("solver", settings), {}}};
    scene.pipeline.step.dt = dt;
    scene.world.forces.gravity = Vec3(0, -g, 0);
    scene.world.materials[0].restitution = 0;
    scene.world.materials[0].friction = friction;
    BodyDescription floor;
    floor.shape = add_shape(scene, make_half_space("floor", Vec3(std::sin(slope), std::cos(slope), 0), 0));
    floor.is_static = true;
    scene.world.add(floor);
    return scene;
}

std::uint32_t put(Scene& scene, std::uint32_t shape, const Vec3& position, double mass = 1, double slope = 0) {
    BodyDescription body;
    give(body, shape, position, Vec3::Zero());
    body.mass = mass;
    body.orientation = Quat(Eigen::AngleAxisd(-slope, Vec3::UnitZ()));
    return scene.world.add(body);
}

// Each box `ratio` times heavier than the one below, from the floor up.
Scene stack(int count, double ratio, const std::map<std::string, Value>& settings = {}) {
    Scene scene = floor_scene(1 / 60.0, 0.5, 0, settings);
    const std::uint32_t cube = add_shape(scene, make_box("cube", Vec3::Constant(0.5)));
    for (int i = 0; i < count; ++i) put(scene, cube, Vec3(0, 0.5 + i, 0), std::pow(ratio, i));
    return scene;
}

struct Run {
    Run(const Scene& scene, double time, int threads = 1)
        : host(make_host(threads)), simulation(scene, plugins(), *host, 1) {
        for (long i = std::lround(time / scene.pipeline.step.dt); i > 0; --i) simulation.step();
    }
    const World& world() const { return simulation.world(); }
    double fastest() const {
        double speed = 0;
        for (std::uint32_t i = 0; i < world().size(); ++i) speed = std::max(speed, world().velocity[i].norm());
        return speed;
    }

    std::unique_ptr<Host> host;
    Simulation simulation;
};

}  // namespace

TEST_CASE("A stack stands still, however much heavier each box is than the one below", "[solver]") {
    for (const double ratio : {1.0, 3.0, 10.0, 100.0}) {
        CAPTURE(ratio);
        const Run run(stack(5, ratio), 5);
        const double slop = 1e-3 * std::sqrt(0.75);
        for (std::uint32_t i = 1; i <= 5; ++i) {
            CHECK(std::abs(run.world().position[i].x()) < 1e-3);
            CHECK(std::abs(run.world().position[i].z()) < 1e-3);
            CHECK(run.world().position[i].y() == Approx(i - 0.5).margin(i * 1.01 * slop));
        }
        CHECK(run.fastest() < 1e-5);
        const RunResult result = run.simulation.result();
        CHECK(result.stuck == 0);
        CHECK(result.energy_drift < 1e-13);
        CHECK(result.momentum_drift < 1e-12);
    }
}

// Its corners lie in planes but for rounding, which grows: what holds them must not pull them against each other.
TEST_CASE("A column of ten still stands after a minute", "[solver]") {
    const Run run(stack(10, 1), 60);
    for (std::uint32_t i = 1; i <= 10; ++i) {
        CHECK(std::abs(run.world().position[i].x()) < 1e-3);
        CHECK(std::abs(run.world().position[i].z()) < 1e-3);
    }
    CHECK(run.fastest() < 1e-3);
    CHECK(run.simulation.result().unresolved == 0);
}

TEST_CASE("A box slides down a slope that is too steep, with Coulomb's acceleration", "[solver]") {
    const double slope = std::acos(-1.0) / 6, mu = 0.5;
    Scene scene = floor_scene(1 / 240.0, mu, slope);
    const std::uint32_t cube = add_shape(scene, make_box("cube", Vec3(0.5, 0.1, 0.5)));
    const Vec3 up(std::sin(slope), std::cos(slope), 0), down(std::cos(slope), -std::sin(slope), 0);
    const std::uint32_t box = put(scene, cube, 0.0995 * up, 1, slope);
    const Run start(scene, 1), end(scene, 5);
    const double acceleration = g * (std::sin(slope) - mu * std::cos(slope));
    CHECK(acceleration == Approx(0.657145).epsilon(1e-6));
    CHECK((end.world().velocity[box] - start.world().velocity[box]).dot(down) / 4 ==
          Approx(acceleration).epsilon(1e-6));
    CHECK(end.world().angular_velocity[box].norm() < 1e-6);
}

TEST_CASE("A box that friction holds on a slope does not creep", "[solver]") {
    const double slope = std::acos(-1.0) / 6;
    Scene scene = floor_scene(1 / 240.0, 0.6, slope);
    const std::uint32_t cube = add_shape(scene, make_box("cube", Vec3(0.5, 0.1, 0.5)));
    const Vec3 up(std::sin(slope), std::cos(slope), 0), down(std::cos(slope), -std::sin(slope), 0);
    const std::uint32_t box = put(scene, cube, 0.0995 * up, 1, slope);
    const Run start(scene, 1), end(scene, 11);
    CHECK(std::abs(down.dot(end.world().position[box] - start.world().position[box])) < 1e-6);
}

TEST_CASE("A sliding ball ends up rolling at five sevenths of its speed", "[solver]") {
    const double v0 = 10, mu = 0.2, dt = 2e-4, radius = 0.5;
    Scene scene = floor_scene(dt, mu, 0, {{"slop", 1e-8}});
    const std::uint32_t ball = put(scene, add_shape(scene, make_sphere("ball", radius)), Vec3(0, radius, 0));
    scene.world.velocity[ball] = Vec3(v0, 0, 0);
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 1);
    double rolls_at = 0, last_slip = v0;
    for (int step = 0; step < 10000; ++step) {
        simulation.step();
        const World& world = simulation.world();
        const double slip = world.velocity[ball].x() + world.angular_velocity[ball].z() * radius;
        // Slip falls evenly: where the line meets zero, rolling begins.
        if (slip < 1e-9 && rolls_at == 0) rolls_at = step * dt + last_slip / (3.5 * mu * g);
        last_slip = slip;
    }
    CHECK(rolls_at == Approx(2 * v0 / (7 * mu * g)).margin(1e-4));
    CHECK(simulation.world().velocity[ball].x() == Approx(5 * v0 / 7).epsilon(1e-6));
}

TEST_CASE("A ball bounces as high as its restitution says, and then lies still", "[solver]") {
    Scene scene = floor_scene(1 / 240.0, 0);
    scene.pipeline.step.mode = "continuous";
    scene.world.materials[0].restitution = 0.5;
    const double radius = 0.1;
    const std::uint32_t ball = put(scene, add_shape(scene, make_sphere("ball", radius)), Vec3(0, 1 + radius, 0));
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 1);
    // First bounce at sqrt(2 h / g), every flight half as long as the last: rest after three times that.
    const double first = std::sqrt(2 / g);
    double highest = 0;
    while (static_cast<double>(simulation.step_number()) / 240 < 1.9 * first) {
        simulation.step();
        if (static_cast<double>(simulation.step_number()) / 240 > 1.1 * first)
            highest = std::max(highest, simulation.world().position[ball].y() - radius);
    }
    CHECK(highest == Approx(0.25).margin(0.25 * g * 1e-5));
    while (static_cast<double>(simulation.step_number()) / 240 < 3 * first + 0.1) simulation.step();
    CHECK(simulation.world().velocity[ball].norm() < 1e-12);
    CHECK(std::abs(simulation.world().position[ball].y() - radius) < 1e-9);
}

TEST_CASE("A pyramid comes to rest, the same bits with any number of threads and any broadphase", "[solver]") {
    Scene scene = floor_scene(1 / 60.0, 0.5);
    const std::uint32_t cube = add_shape(scene, make_box("cube", Vec3(0.5, 0.4, 0.3)));
    for (int layer = 0; layer < 3; ++layer)
        for (int i = 0; i < 3 - layer; ++i)
            put(scene, cube, Vec3(1.05 * (i + 0.5 * layer) + 0.01 * layer, 0.42 + 0.85 * layer, 0.03 * i));
    const Run run(scene, 5);
    const RunResult result = run.simulation.result();
    CHECK(run.fastest() < 1e-3);
    CHECK(result.energy_drift < 1e-12);
    CHECK(Run(scene, 5, 2).simulation.state_hash() == result.state_hash);
    scene.pipeline.broadphase = stage("brute_force");
    CHECK(Run(scene, 5).simulation.state_hash() == result.state_hash);
}

// Contacts that slide and wedge each other in: an answer that has not come to its end must not be taken.
TEST_CASE("Tumbling boxes fall in a heap and come to rest, none ever faster than its fall", "[solver]") {
    const std::string narrowphase = GENERATE("moller", "sat");
    CAPTURE(narrowphase);
    Scene scene = floor_scene(1 / 250.0, 0.5);
    scene.pipeline.narrowphase = stage(narrowphase);
    const std::uint32_t box = add_shape(scene, make_box("box", Vec3(0.4, 0.3, 0.3)));
    for (const double side : {-1.0, 1.0})
        for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())}) {
            BodyDescription wall;
            wall.shape = add_shape(scene, make_half_space("wall", side * axis, -2.5));
            wall.is_static = true;
            scene.world.add(wall);
        }
    const unsigned seed = 11;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    constexpr double top = 9;
    for (int i = 0; i < 24; ++i) {
        const std::uint32_t body = put(scene, box,
                                       Vec3((i % 3 - 1) * 1.3, 1 + (i / 3) * (top - 1) / 8, (i / 3 % 3 - 1) * 1.2) +
                                           0.1 * Vec3(uniform(random), 0, uniform(random)),
                                       200);
        scene.world.angular_velocity[body] = Vec3(uniform(random), uniform(random), uniform(random));
    }
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 1);
    double fastest = 0;
    const auto speed = [&] {
        double most = 0;
        for (const Vec3& v : simulation.world().velocity) most = std::max(most, v.norm());
        return most;
    };
    for (int i = 0; i < 1500; ++i) {
        simulation.step();
        fastest = std::max(fastest, speed());
    }
    CHECK(fastest < 1.05 * std::sqrt(2 * g * top));
    CHECK(speed() < 1e-3);
}

TEST_CASE("A capsule of a resting stack has the solver's memory and goes on to the same bits", "[solver][capsule]") {
    const Scene scene = stack(4, 2, {{"sleep_time", 0.3}});
    const auto host = make_host(1);
    Simulation original(scene, plugins(), *host, 1);
    for (int at : {20, 200}) {
        while (original.step_number() < static_cast<std::uint64_t>(at)) original.step();
        Scene kept = original.capture();
        REQUIRE(kept.memory.size() == 1);
        CHECK(kept.memory[0].words.size() > 1);
        Simulation again(kept, plugins(), *host, 1);
        kept.memory.clear();
        Simulation forgetful(kept, plugins(), *host, 1);
        for (int i = 0; i < 5; ++i) again.step(), forgetful.step(), original.step();
        CHECK(again.state_hash() == original.state_hash());
        if (at == 20) CHECK(forgetful.state_hash() != original.state_hash());
    }
}

TEST_CASE("An island sleeps when it has been slow for long enough, and wakes when it is touched", "[solver]") {
    Scene scene = stack(3, 1, {{"sleep_time", 0.5}});
    const std::uint32_t cube = 0;
    const auto host = make_host(1);
    const std::uint32_t visitor = put(scene, scene.world.shape[1] + cube, Vec3(0.2, 30, 0));
    Simulation simulation(scene, plugins(), *host, 1);
    while (simulation.step_number() < 60) simulation.step();
    for (std::uint32_t i = 1; i <= 3; ++i) CHECK(simulation.world().asleep[i] == 1);
    CHECK(simulation.world().asleep[visitor] == 0);
    const Vec3 bed = simulation.world().position[3];
    while (simulation.step_number() < 120) simulation.step();
    CHECK(simulation.world().position[3] == bed);
    bool woke = false;
    while (simulation.step_number() < 240) {
        simulation.step();
        woke = woke || simulation.world().asleep[3] == 0;
    }
    CHECK(woke);
    SECTION("and when something is put in") {
        ForcesInput forces{scene.world.forces};
        simulation.apply(forces);
        for (std::uint32_t i = 1; i <= 3; ++i) CHECK(simulation.world().asleep[i] == 0);
    }
}
