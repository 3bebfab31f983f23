// Bodies that come to rest on each other in stepping `continuous`.
#include "framework/scenes.h"
#include "framework/solids.h"
#include "narrowphase/solids.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

constexpr double g = 9.81;

// A floor whose top lies at height 0, or leans by an angle about the z axis.
Scene floor_scene(double dt, double restitution, double slope = 0) {
    Scene scene = empty_scene();
    scene.pipeline.step.mode = "continuous";
    scene.pipeline.step.dt = dt;
    scene.pipeline.ledger.check = true;
    scene.world.forces.gravity = Vec3(0, -g, 0);
    scene.world.materials[0].restitution = restitution;
    BodyDescription floor;
    floor.shape = add_shape(scene, make_half_space("floor", Vec3(std::sin(slope), std::cos(slope), 0), 0));
    floor.is_static = true;
    scene.world.add(floor);
    return scene;
}

std::uint32_t put(Scene& scene, std::uint32_t shape, const Vec3& position, const Vec3& velocity = Vec3::Zero(),
                  const Vec3& spin = Vec3::Zero(), const Quat& orientation = Quat::Identity()) {
    BodyDescription body;
    give(body, shape, position, velocity);
    body.angular_velocity = spin;
    body.orientation = orientation;
    return scene.world.add(body);
}

// Runs, and requires after every step that nothing overlaps and nothing was left unanswered.
struct Run {
    Run(const Scene& scene, double time)
        : host(make_host(1)),
          simulation(scene, plugins(), *host, 1),
          steps(std::lround(time / scene.pipeline.step.dt)) {
        for (long i = 0; i < steps; ++i) simulation.step();
        const RunResult result = simulation.result();
        CHECK(result.max_penetration_m == 0);
        CHECK(result.unresolved == 0);
        CHECK(result.energy_drift < 1e-12);
        const auto broken = simulation.first_break();
        CHECK((broken ? to_string(*broken, simulation.world()) : "") == "");
    }
    const World& world() const { return simulation.world(); }

    std::unique_ptr<Host> host;
    Simulation simulation;
    long steps;
};

}  // namespace

TEST_CASE("a box that falls flat rests on its four corners", "[continuous][resting]") {
    for (const double restitution : {0.0, 0.4})
        for (const double dt : {1e-3, 1.0 / 60}) {
            CAPTURE(restitution, dt);
            Scene scene = floor_scene(dt, restitution);
            const auto box = put(scene, add_shape(scene, make_box("box", Vec3(0.4, 0.3, 0.5))), Vec3(0, 0.4, 0));
            const Run run(scene, 2);
            CHECK(run.world().position[box].y() >= 0.3);
            CHECK(run.world().position[box].y() < 0.3 + 1e-9);
            CHECK(run.world().velocity[box].norm() < 1e-9);
            CHECK(run.world().angular_velocity[box].norm() < 1e-9);
        }
}

TEST_CASE("a box that lies on the floor slides and spins as if the floor were not there", "[continuous][resting]") {
    for (const double dt : {1e-3, 1.0 / 60}) {
        CAPTURE(dt);
        Scene scene = floor_scene(dt, 0);
        const Vec3 velocity(1, 0, 0.3), spin(0, 2, 0);
        const auto box =
            put(scene, add_shape(scene, make_box("box", Vec3(0.4, 0.3, 0.5))), Vec3(0, 0.3, 0), velocity, spin);
        const Run run(scene, 1);
        CHECK((run.world().position[box] - Vec3(1, 0.3, 0.3)).norm() < 1e-8);
        CHECK((run.world().angular_velocity[box] - spin).norm() < 1e-9);
        CHECK((run.world().orientation[box] * Vec3::UnitX() - Vec3(std::cos(2), 0, -std::sin(2))).norm() < 1e-7);
    }
}

TEST_CASE("what lies on a slope slides down as on an inclined plane", "[continuous][resting]") {
    const double slope = 0.4, time = 0.5;
    const Vec3 normal(std::sin(slope), std::cos(slope), 0), down(std::cos(slope), -std::sin(slope), 0);
    for (const char* response : {"impulse", "simple_bounce"}) {
        CAPTURE(response);
        Scene scene = floor_scene(1e-3, 0.5, slope);
        scene.pipeline.responses[0].stage = stage(response);
        const auto ball = put(scene, add_shape(scene, make_sphere("ball", 0.2)), 0.2 * normal);
        const Run run(scene, time);
        const Vec3 expected = 0.2 * normal + 0.5 * g * std::sin(slope) * time * time * down;
        CHECK((run.world().position[ball] - expected).norm() < 1e-9);
    }
}

TEST_CASE("a pile of boxes stands", "[continuous][resting]") {
    Scene scene = floor_scene(1.0 / 120, 0);
    const std::uint32_t shape = add_shape(scene, make_box("box", Vec3(0.4, 0.3, 0.5)));
    std::vector<std::uint32_t> boxes;
    for (int i = 0; i < 5; ++i) boxes.push_back(put(scene, shape, Vec3(0.05 * (i % 2), 0.31 + 0.62 * i, 0.03 * i)));
    const Run run(scene, 1.5);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Vec3 expected(0.05 * (i % 2), 0.3 + 0.6 * i, 0.03 * i);
        CAPTURE(i);
        CHECK((run.world().position[boxes[i]] - expected).norm() < 1e-6);
        CHECK(run.world().velocity[boxes[i]].norm() < 1e-6);
    }
}

TEST_CASE("a box that falls on an edge ends on a face, and its energy only falls", "[continuous][resting]") {
    for (const char* order : {"sequential", "symmetric"}) {
        CAPTURE(order);
        Scene scene = floor_scene(2e-3, 0);
        scene.pipeline.responses[0].stage = stage("impulse", {{"order", std::string(order)}});
        const auto box = put(scene, add_shape(scene, make_box("box", Vec3(0.4, 0.3, 0.5))), Vec3(0, 0.8, 0),
                             Vec3::Zero(), Vec3::Zero(), Quat(Eigen::AngleAxisd(0.5, Vec3(0.6, 0, 0.8))));
        const auto host = make_host(1);
        Simulation simulation(scene, plugins(), *host, 1);
        const auto energy = [&] {
            const World& world = simulation.world();
            return world.kinetic_energy(box) + g * world.position[box].y() / world.inverse_mass[box];
        };
        double before = energy();
        const double first = before;
        for (int i = 0; i < 2000; ++i) {
            simulation.step();
            CAPTURE(i);
            // Within a step a hop of g dt^2 / 8 is allowed.
            REQUIRE(energy() < before + 1e-4 * first);
            before = std::min(before, energy());
        }
        CHECK(simulation.result().max_penetration_m == 0);
        CHECK(simulation.world().velocity[box].norm() < 1e-6);
        CHECK(simulation.world().angular_velocity[box].norm() < 1e-6);
    }
}

TEST_CASE("bodies that fall into a room come to rest in a heap without overlapping", "[continuous][resting]") {
    const Shape shapes[] = {make_box("box", Vec3(0.25, 0.2, 0.3)), make_mesh("bar", u_bar())};
    for (const Shape& shape : shapes)
        for (const double restitution : {0.0, 0.5}) {
            CAPTURE(shape.name, restitution);
            Scene scene = floor_scene(0.004, restitution);
            const double r = shape.radius;
            Room room = room_of(3 * r);
            room.min.y() = 0;
            room.max.y() = 9 * r;
            scene.rooms.push_back(room);
            const std::uint32_t id = add_shape(scene, shape);
            std::mt19937 random(5);
            std::normal_distribution<double> turn;
            for (int i = 0; i < 8; ++i) {
                const Quat q(turn(random), turn(random), turn(random), turn(random));
                put(scene, id, r * Vec3(i % 2 ? 1.3 : -1.3, 1.5 + 2.5 * (i / 4), i / 2 % 2 ? 1.3 : -1.3), Vec3::Zero(),
                    Vec3::Zero(), q.normalized());
            }
            const auto host = make_host(1);
            Simulation simulation(scene, plugins(), *host, 1);
            for (int i = 0; i < 250; ++i) simulation.step();
            const RunResult result = simulation.result();
            CHECK(result.max_penetration_m < 1e-9);
            CHECK(result.escaped == 0);
            CHECK(result.energy_drift < 1e-12);
            CHECK(result.energy_final_J < result.energy_initial_J);
        }
}

TEST_CASE("P6 666: balls that fall onto each other without bouncing never overlap", "[continuous][resting]") {
    Scene scene = floor_scene(1e-3, 0);
    const std::uint32_t shape = add_shape(scene, make_sphere("ball", 0.2));
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            for (int k = 0; k < 6; ++k)
                put(scene, shape,
                    Vec3(0.5 * i + 0.01 * std::sin(7 * i + 3 * j + k), 0.3 + 0.5 * k,
                         0.5 * j + 0.01 * std::cos(5 * j + k)));
    const Run run(scene, 0.5);
    CHECK(run.simulation.result().contacts > 216);
    for (std::uint32_t a = 1; a < run.world().size(); ++a) {
        REQUIRE(run.world().position[a].y() >= 0.2 - 1e-12);
        for (std::uint32_t b = 1; b < a; ++b)
            REQUIRE((run.world().position[a] - run.world().position[b]).norm() >= 0.4 - 1e-12);
    }
}
