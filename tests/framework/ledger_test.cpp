#include "framework/liars.h"
#include "framework/solids.h"
#include "narrowphase/solids.h"
#include "oracle/allocation_counter.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

// The ledger's first break within so many steps.
std::optional<LedgerBreak> first_break(Scene scene, int steps) {
    scene.pipeline.ledger.check = true;
    const auto host = make_host(1);
    Simulation simulation(scene, liars(), *host, 1);
    for (int i = 0; i < steps && !simulation.first_break(); ++i) simulation.step();
    return simulation.first_break();
}

// What a run of so many steps ends with, "" if it goes through.
std::string failure(const Scene& scene, int steps) {
    const auto host = make_host(1);
    try {
        Simulation simulation(scene, liars(), *host, 1);
        for (int i = 0; i < steps; ++i) simulation.step();
    } catch (const std::exception& e) {
        return e.what();
    }
    return "";
}

// The step in whose course the first two of the three balls are first in contact.
std::uint64_t step_of_contact(const Scene& scene) {
    const auto host = make_host(1);
    Simulation simulation(scene, liars(), *host, 1);
    std::uint64_t step = 0;
    while (simulation.step(), simulation.contacts().rows.empty()) ++step;
    return step;
}

Scene lying(const std::string& lie) {
    Scene scene = three_balls();
    scene.pipeline.responses = {{stage("liar", {{"lie", lie}}), {}}};
    return scene;
}

// One free body that turns about all of its axes.
Scene tumbler(const Vec3& half_extents, const std::string& integrator) {
    Scene scene = empty_scene();
    BodyDescription body;
    give(body, add_shape(scene, make_box("box", half_extents)), Vec3(1, 2, 3), Vec3(0.5, 0, 0)).name = "tumbler";
    body.angular_velocity = Vec3(1, 2, 3);
    scene.world.add(body);
    scene.pipeline.step.integrator = integrator;
    return scene;
}

// Every force there is on a crowd in a room.
Scene forced_gas() {
    Scene scene = gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 2, 1.4, 7);
    scene.world.forces = {Vec3(1, -9.81, 0.5), Vec3(3, 1, -2), 0.7};
    for (std::size_t body = 0; body < scene.world.size(); ++body) {
        scene.world.constant_force[body] = Vec3(0.3, 2, -1);
        scene.world.constant_torque[body] = Vec3(-0.2, 0.1, 0.4);
    }
    return scene;
}

}  // namespace

TEST_CASE("the ledger of a healthy run balances, and changes nothing of it", "[ledger]") {
    for (const char* mode : {"discrete", "bisection", "continuous"})
        for (Scene scene :
             {gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 3, 1.4, 1), gas(make_mesh("bar", u_bar()), 2, 3.8, 2),
              gas(make_sphere("ball", 0.5), 3, 1.2, 3), forced_gas()})
            for (const double restitution : {1.0, 0.6}) {
                CAPTURE(mode, scene.world.shapes[0].name, restitution, scene.world.forces.drag);
                scene.pipeline.step.mode = mode;
                scene.world.materials[0].restitution = restitution;
                const RunResult plain = run(scene, 120);
                CHECK(plain.contacts > 0);
                const auto host = make_host(1);
                scene.pipeline.ledger.check = true;
                Simulation checked(scene, plugins(), *host, 120);
                for (int i = 0; i < 120; ++i) checked.step();
                INFO((checked.first_break() ? to_string(*checked.first_break(), checked.world()) : ""));
                CHECK_FALSE(checked.first_break());
                CHECK(checked.state_hash() == plain.state_hash);
            }
}

TEST_CASE("energy that an integrator makes is named to the joule", "[ledger]") {
    const Scene scene = tumbler(Vec3(0.5, 1, 1.5), "momentum_euler");
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 1);
    const double before = simulation.world().kinetic_energy(0);
    simulation.step();
    const double made = simulation.world().kinetic_energy(0) - before;
    REQUIRE(made > 1e-9);
    const std::optional<LedgerBreak> broken = first_break(scene, 1);
    REQUIRE(broken);
    CHECK(broken->stage == "integrator");
    CHECK(broken->plugin == "momentum_euler");
    CHECK(broken->step == 0);
    CHECK(broken->bodies == std::vector<std::uint32_t>{0});
    CHECK(broken->quantity == "energy");
    CHECK(broken->value == Approx(made));
    CHECK(broken->limit < 1e-9);
    CHECK(to_string(*broken, simulation.world())
              .starts_with(
                  "the ledger breaks at step 0 (0 s), integrator 'momentum_euler', body 0 'tumbler': energy off by "));
}

// A symmetric top that keeps its angular velocity keeps its energy, and not its angular momentum.
TEST_CASE("angular momentum that an integrator loses is named", "[ledger]") {
    const std::optional<LedgerBreak> broken = first_break(tumbler(Vec3(0.5, 0.5, 2), "semi_implicit_euler"), 10);
    REQUIRE(broken);
    CHECK(broken->quantity == "angular momentum");
    CHECK(broken->unit == "N m s");
    CHECK(broken->stage == "integrator");
}

// v' = v + g h and x' = x + h v' leave the parabola's energy by m g^2 h^2 / 2 in every step.
TEST_CASE("the energy that a symplectic Euler step takes from a falling body is named", "[ledger]") {
    Scene scene = three_balls();
    scene.world.forces.gravity = Vec3(0, 0, -8);
    scene.pipeline.step.integrator = "semi_implicit_euler";
    const std::optional<LedgerBreak> broken = first_break(scene, 1);
    REQUIRE(broken);
    CHECK(broken->quantity == "energy");
    CHECK(broken->value == Approx(2 * 64 / (2.0 * 64 * 64)));
    scene.pipeline.ledger.energy = 0.5;
    scene.pipeline.ledger.angular_momentum = 1;
    CHECK_FALSE(first_break(scene, 5));
}

// Rollback moves bodies back in no time, with the velocities that they have now: p x h v of angular momentum is gone.
TEST_CASE("the angular momentum that a rollback takes is named", "[ledger]") {
    Scene scene = three_balls();
    scene.world.position[1].y() = 0.6;
    scene.pipeline.step.mode = "rollback";
    scene.pipeline.ledger.check = true;
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 1);
    const Vec3 velocity = scene.world.velocity[0];
    while (!simulation.first_break()) simulation.step();
    const LedgerBreak& broken = *simulation.first_break();
    CHECK(broken.stage == "stepping");
    CHECK(broken.plugin == "rollback");
    CHECK(broken.quantity == "angular momentum");
    CHECK(broken.bodies == std::vector<std::uint32_t>{0});
    CHECK(broken.value == Approx((velocity / 64).cross(2 * simulation.world().velocity[0]).norm()));
}

TEST_CASE("forces far away and fast are no break", "[ledger]") {
    for (const double offset : {1e3, 1e6, 1e9})
        for (const double speed : {1.0, 1e4, 1e8}) {
            CAPTURE(offset, speed);
            Scene scene = forced_gas();
            scene.rooms.clear();
            scene.world.forces.drag = 0;
            for (std::size_t body = 0; body < scene.world.size(); ++body) {
                scene.world.constant_torque[body] = Vec3::Zero();
                scene.world.position[body] += Vec3::Constant(offset);
                scene.world.velocity[body] = Vec3::Constant(speed);
            }
            const auto broken = first_break(scene, 30);
            INFO((broken ? to_string(*broken, scene.world) : ""));
            CHECK_FALSE(broken);
        }
}

TEST_CASE("what a response does against its contract is named with pair, quantity and size", "[ledger]") {
    struct Case {
        const char *lie, *quantity, *unit;
        double value;
        std::vector<std::uint32_t> bodies;
    };
    // Reduced mass 2/3 kg at 5 m/s: 25/3 J in the relative motion. Twice the momentum exchanged: 20/3 N s.
    const double relative = 25.0 / 3, spin = 0.4 * 2 * 0.25 * 4;
    const Case cases[] = {{"gain", "energy", "J", relative * (1.5 * 1.5 - 1), {0, 1}},
                          {"loss", "energy", "J", relative * (1 - 0.5 * 0.5), {0, 1}},
                          {"credit", "energy", "J", 3, {0, 1}},
                          {"silence", "momentum", "N s", 20.0 / 3, {0, 1}},
                          {"spin", "angular momentum", "N m s", 2 * spin, {0, 1}},
                          {"shift", "position", "m", 0.25, {0}},
                          {"bystander", "velocity", "m/s", 0.5, {2}}};
    for (const Case& expected : cases) {
        CAPTURE(expected.lie);
        const Scene scene = lying(expected.lie);
        const std::optional<LedgerBreak> broken = first_break(scene, 40);
        REQUIRE(broken);
        CHECK(broken->stage == "response");
        CHECK(broken->plugin == "liar");
        CHECK(broken->step == step_of_contact(scene));
        CHECK(broken->time == static_cast<double>(broken->step) / 64);
        CHECK(broken->quantity == expected.quantity);
        CHECK(broken->unit == expected.unit);
        CHECK(broken->value == Approx(expected.value));
        CHECK(broken->limit < 1e-9);
        CHECK(broken->bodies == expected.bodies);
    }
    CHECK_FALSE(first_break(lying("none"), 40));
}

TEST_CASE("of many collisions at once the pair that gains energy is the one that is named", "[ledger]") {
    Scene scene = empty_scene();
    const std::uint32_t ball = add_shape(scene, make_sphere("ball", 0.5));
    for (int pair = 0; pair < 5; ++pair)
        for (const double side : {-1.0, 1.0}) {
            BodyDescription body;
            give(body, ball, Vec3(0.45 * side, 3 * pair, 0), Vec3(-5 * side, 0, 0)).kind = pair == 3 ? "odd" : "ball";
            scene.world.add(body);
        }
    scene.pipeline.responses = {{stage("impulse"), {"ball"}}, {stage("liar", {{"lie", std::string("gain")}}), {"odd"}}};
    const std::optional<LedgerBreak> broken = first_break(scene, 1);
    REQUIRE(broken);
    CHECK(broken->plugin == "liar");
    CHECK(broken->bodies == std::vector<std::uint32_t>{6, 7});
}

TEST_CASE("a narrowphase that moves a body is named, bit for bit", "[ledger]") {
    Scene scene = three_balls();
    scene.pipeline.narrowphase = stage("liar", {{"moves", true}});
    const std::optional<LedgerBreak> broken = first_break(scene, 40);
    REQUIRE(broken);
    CHECK(broken->stage == "narrowphase");
    CHECK(broken->plugin == "liar");
    CHECK(broken->bodies == std::vector<std::uint32_t>{0});
    CHECK(broken->quantity == "position");
    CHECK(broken->value == 0.125);
    CHECK(broken->limit == 0);
}

TEST_CASE("a contact deeper than the limit is named with its depth", "[ledger]") {
    Scene scene = three_balls();
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 1);
    while (simulation.step(), simulation.contacts().rows.empty()) continue;
    const double depth = simulation.contacts().rows[0].depth;
    scene.pipeline.ledger.penetration = 0.99 * depth;
    const std::optional<LedgerBreak> broken = first_break(scene, 40);
    REQUIRE(broken);
    CHECK(broken->quantity == "penetration");
    CHECK(broken->stage == "narrowphase");
    CHECK(broken->plugin == "moller");
    CHECK(broken->value == depth);
    CHECK(broken->limit == 0.99 * depth);
    CHECK(broken->bodies == std::vector<std::uint32_t>{0, 1});
    scene.pipeline.ledger.penetration = depth;
    CHECK_FALSE(first_break(scene, 40));
}

TEST_CASE("what is not finite goes no further than the response that made it", "[ledger][finite]") {
    const auto [lie, what] = GENERATE(table<std::string, std::string>({
        {"nan_velocity", "the velocity of body 0 is not finite (bodies 0 and 1)"},
        {"nan_bystander", "the angular velocity of body 2 is not finite, and it is in none of the contacts"},
        {"nan_impulse", "the impulse of a contact is not finite (bodies 0 and 1)"},
        {"nan_energy", "the energy that it says it took is not finite"},
        {"far_event", "it reports an event of body 3; there are 3, counted from 0"},
        {"throw", "no luck today (bodies 0 and 1)"},
    }));
    CAPTURE(lie);
    Scene scene = lying(lie);
    const std::string step = std::to_string(step_of_contact(lying("none")));
    CHECK(failure(scene, 40) == "response 'liar' failed at step " + step + ": " + what);
}

TEST_CASE("what is not finite goes no further than the integrator that made it", "[ledger][finite]") {
    for (const char* mode : {"discrete", "rollback", "bisection", "continuous"})
        for (const char* integrator : {"pdmv4", "momentum_euler", "semi_implicit_euler"})
            for (const bool checked : {false, true}) {
                CAPTURE(mode, integrator, checked);
                Scene scene = three_balls();
                scene.pipeline.step.mode = mode;
                scene.pipeline.step.integrator = integrator;
                scene.pipeline.ledger.check = checked;
                scene.world.inverse_mass[1] = 1e6;
                scene.world.constant_force[1] = Vec3(0, 1e308, 0);
                const std::string what = failure(scene, 3);
                INFO(what);
                CHECK(what.starts_with("integrator '" + std::string(integrator) + "' failed at step 0: the "));
                CHECK(what.find("of body 1 is not finite") != std::string::npos);
            }
}

TEST_CASE("a narrowphase that throws is named with the pair that it threw over", "[ledger][finite]") {
    Scene scene = three_balls();
    scene.world.position[0] = Vec3(100, 0, 0);  // the touching pairs are 1 and 3, 2 and 4
    for (const double x : {2.3, 50.3}) {
        BodyDescription body;
        scene.world.add(give(body, 0, Vec3(x, 0, 0), Vec3::Zero()));
    }
    scene.world.name[2] = "third";
    scene.pipeline.narrowphase = stage("liar", {{"fails_at", std::int64_t(2)}});
    CHECK(failure(scene, 1) == "narrowphase 'liar' failed at step 0: no luck today (bodies 2 'third' and 4)");
}

TEST_CASE("a ledger allocates nothing while it balances", "[ledger]") {
    if (!AllocationCounter::available()) {
        WARN("allocations cannot be counted in this build");
        return;
    }
    Scene scene = gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 3, 1.4, 1);
    scene.pipeline.ledger.check = true;
    const auto host = make_host(1);
    Simulation simulation(scene, plugins(), *host, 600);
    for (int i = 0; i < 200; ++i) simulation.step();
    const std::uint64_t contacts = simulation.result().contacts;
    const AllocationCounter allocations;
    for (int i = 0; i < 300; ++i) simulation.step();
    CHECK(allocations.count() == 0);
    CHECK(simulation.result().contacts > contacts);
    CHECK_FALSE(simulation.first_break());
}
