#include "framework/capsules.h"

#include <catch2/catch.hpp>

#include <bit>

using namespace kolize;
using namespace kolize::test;

namespace {

// Without what tells where the capsule comes from.
std::string world_part(const std::string& text) { return text.substr(text.find("[capsule.forces]")); }

Scene two_rooms() {
    Scene scene = gas(make_sphere("ball", 0.4), 2, 1, 13);
    scene.rooms.push_back(scene.rooms[0]);
    scene.rooms[1].min.x() += 100;
    scene.rooms[1].max.x() += 100;
    return scene;
}

}  // namespace

TEST_CASE("a capsule of any step goes on to the same bits as the run that it is of", "[capsule]") {
    const Scene crowds[] = {mixed_crowd(), gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 3, 1.4, 1),
                            gas(make_mesh("bar", u_bar()), 2, 3.8, 2), two_rooms()};
    for (const char* mode : {"discrete", "rollback", "bisection", "continuous"})
        for (Scene scene : crowds)
            for (const int at : {1, 60}) {
                CAPTURE(mode, scene.world.shapes[0].name, scene.world.size(), at);
                scene.pipeline.step.mode = mode;
                scene.pipeline.step.dt = 1 / 120.0;
                const auto host = make_host(1);
                Simulation original(scene, liars(), *host, 200);
                advance(original, at);
                const std::string text = capsule_text(original.capture(), "a test");
                Simulation replay(read_capsule(text), liars(), *host, 200);
                CHECK(replay.state_hash() == original.state_hash());
                CHECK((world_part(capsule_text(replay.capture(), "a test")) == world_part(text)));
                advance(original, 100);
                advance(replay, 100);
                CHECK(replay.state_hash() == original.state_hash());
                CHECK(replay.world().removed == original.world().removed);
                CHECK(original.result().contacts > 0);
            }
}

TEST_CASE("a crowd of a capsule test does lose bodies and use bounding spheres", "[capsule]") {
    const auto host = make_host(1);
    Simulation simulation(mixed_crowd(), liars(), *host, 200);
    advance(simulation, 190);
    const World& world = simulation.world();
    CHECK(std::count(world.removed.begin(), world.removed.end(), 1) > 0);
    const auto marble = std::find(world.name.begin(), world.name.end(), "marble on the way") - world.name.begin();
    CHECK(world.shape_of(static_cast<std::uint32_t>(marble)).kind == ShapeKind::sphere);
    CHECK(world.shape_of(static_cast<std::uint32_t>(marble)).name == "bar");
}

TEST_CASE("every bit of every column comes back", "[capsule]") {
    const unsigned seed = 20;
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto number = [&] {
        double value = infinity;
        while (!std::isfinite(value)) value = std::bit_cast<double>(random());
        return random() % 8 == 0 ? -0.0 : random() % 8 == 0 ? value * 0x1p-1070 : value;
    };
    const auto vector = [&] { return Vec3(number(), number(), number()); };
    const auto unit = [&] { return Quat(number() > 0 ? 1 : -1, 1e-4 * (random() % 9), 0x1p-1070, -0.0); };
    Scene scene = mixed_crowd();
    scene.capsule_step = 123456789012;
    World& world = scene.world;
    for (std::size_t body = 0; body < world.size(); ++body) {
        world.position[body] = vector();
        world.orientation[body] = unit();
        world.constant_force[body] = vector();
        world.constant_torque[body] = vector();
        world.removed[body] = random() % 2;
        if (world.is_static[body]) continue;
        world.velocity[body] = vector();
        world.angular_velocity[body] = vector();
        world.inverse_mass[body] =
            std::ldexp(1 + 1e-9 * static_cast<double>(random() % 1000), int(random() % 2000) - 1000);
    }
    world.forces = {vector(), vector(), std::abs(number())};
    const Scene back = read_capsule(capsule_text(scene, "exact"));
    const auto same = [](const auto& a, const auto& b) {
        return a.size() == b.size() && std::memcmp(static_cast<const void*>(a.data()),
                                                   static_cast<const void*>(b.data()), a.size() * sizeof(a[0])) == 0;
    };
    CHECK(back.capsule_step == scene.capsule_step);
    CHECK(same(back.world.position, world.position));
    CHECK(same(back.world.orientation, world.orientation));
    CHECK(same(back.world.velocity, world.velocity));
    CHECK(same(back.world.angular_velocity, world.angular_velocity));
    CHECK(same(back.world.inverse_mass, world.inverse_mass));
    CHECK(same(back.world.inverse_inertia, world.inverse_inertia));
    CHECK(same(back.world.constant_force, world.constant_force));
    CHECK(same(back.world.constant_torque, world.constant_torque));
    CHECK(back.world.removed == world.removed);
    CHECK(back.world.is_static == world.is_static);
    CHECK(back.world.shape == world.shape);
    CHECK(back.world.material == world.material);
    CHECK(back.world.name == world.name);
    CHECK(back.world.kinds == world.kinds);
    CHECK(same(back.world.forces.wind, world.forces.wind));
    CHECK(back.world.materials[1].name == "dull \"rubber\"");
    REQUIRE(back.world.shapes.size() == world.shapes.size());
    for (std::size_t i = 0; i < world.shapes.size(); ++i) {
        const Shape &a = back.world.shapes[i], &b = world.shapes[i];
        CHECK(same(a.moments, b.moments));
        CHECK(same(a.center_in_model, b.center_in_model));
        CHECK(a.body_to_model.coeffs() == b.body_to_model.coeffs());
        CHECK(a.radius == b.radius);
        CHECK(a.volume == b.volume);
        CHECK(a.normal == b.normal);
        CHECK(bool(a.mesh) == bool(b.mesh));
        if (!a.mesh || !b.mesh) continue;
        CHECK(same(a.mesh->vertices, b.mesh->vertices));
        CHECK(a.mesh->triangles == b.mesh->triangles);
        CHECK(a.mesh->hierarchy.order == b.mesh->hierarchy.order);
        CHECK(a.mesh->closed == b.mesh->closed);
    }
}

TEST_CASE("the capsule of a broken step breaks at once, with the same sentence", "[capsule][ledger]") {
    for (const std::string lie : {"gain", "silence", "shift"}) {
        CAPTURE(lie);
        Scene scene = three_balls();
        scene.pipeline.ledger.check = true;
        scene.pipeline.responses = {{stage("liar", {{"lie", lie}}), {}}};
        const auto host = make_host(1);
        Simulation simulation(scene, liars(), *host, 40);
        advance(simulation, 40);
        REQUIRE(simulation.first_break());
        const std::string sentence = to_string(*simulation.first_break(), simulation.world());
        const Scene capsule = read_capsule(capsule_text(simulation.capture_failure(), sentence));
        CHECK(capsule.capsule_step == simulation.first_break()->step);
        Simulation replay(capsule, liars(), *host, 1);
        replay.step();
        REQUIRE(replay.first_break());
        CHECK(to_string(*replay.first_break(), replay.world()) == sentence);
    }
}

TEST_CASE("the capsule of a step that failed fails at once, with the same sentence", "[capsule]") {
    for (const std::string lie : {"nan_velocity", "throw"}) {
        CAPTURE(lie);
        Scene scene = three_balls();
        scene.pipeline.responses = {{stage("liar", {{"lie", lie}}), {}}};
        const auto host = make_host(1);
        const auto sentence_of = [](Simulation& simulation, int steps) -> std::string {
            try {
                advance(simulation, steps);
            } catch (const std::runtime_error& e) {
                return e.what();
            }
            return "";
        };
        Simulation simulation(scene, liars(), *host, 40);
        simulation.keep_steps();
        const std::string sentence = sentence_of(simulation, 40);
        REQUIRE(sentence.find("failed at step") != std::string::npos);
        Simulation replay(read_capsule(capsule_text(simulation.capture_failure(), sentence)), liars(), *host, 1);
        CHECK(sentence_of(replay, 1) == sentence);
    }
}

TEST_CASE("a capsule says which step it is of, and is run for that step alone", "[capsule]") {
    const auto host = make_host(1);
    Simulation simulation(two_rooms(), liars(), *host, 8);
    advance(simulation, 7);
    const Scene capsule = read_capsule(capsule_text(simulation.capture(), "a test"));
    CHECK(capsule.capsule_step == 7);
    CHECK(capsule.pipeline.step.time == capsule.pipeline.step.dt);
    CHECK(capsule.rooms.size() == 2);
    CHECK(capsule.world.size() == simulation.world().size());  // the walls of both rooms are there, once
}
