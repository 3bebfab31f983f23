#include "oracle/allocation_counter.h"
#include "response/response_plugin.h"

using namespace kolize;

namespace {

// A pair of balls of random masses that touch; B lies along `normal` from A.
World random_pair(Random& random, const Vec3& normal) {
    World world = empty_world();
    add_ball(world, Vec3::Zero(), random.normal(), random.uniform(0.1, 10));
    add_ball(world, 2 * normal, random.normal(), random.uniform(0.1, 10));
    for (Vec3& spin : world.angular_velocity) spin = random.normal();
    return world;
}

}  // namespace

TEST_CASE("A ball slides along the obstacle that it runs into", "[slide]") {
    World world = empty_world();
    add_obstacle(world, Vec3(0, -1, 0));
    const std::uint32_t ball = add_ball(world, Vec3(0, 1, 0), Vec3(3, -4, 1), 2);
    world.angular_velocity[ball] = Vec3(1, 2, 3);
    std::vector<Contact> contacts{contact_at(world, 0, ball, Vec3::Zero(), Vec3::UnitY())};
    ResponsePlugin slide("slide");
    slide.respond(world, contacts);
    CHECK((world.velocity[ball] - Vec3(3, 0, 1)).norm() < 1e-15);
    CHECK(world.angular_velocity[ball] == Vec3(1, 2, 3));
    CHECK(contacts[0].impulse == Approx(8));
    CHECK(slide.dissipated_J == Approx(16));
}

TEST_CASE("In a corner a ball slides along both walls, and out of it freely", "[slide]") {
    const Vec3 walls[] = {Vec3::UnitX(), Vec3(-1, 1, 0).normalized()};
    for (const double sign : {-1.0, 1.0}) {
        World world = empty_world();
        add_obstacle(world);
        add_obstacle(world);
        const Vec3 velocity = sign * Vec3(1, 2, 5);
        const std::uint32_t ball = add_ball(world, Vec3::Zero(), velocity);
        std::vector<Contact> contacts;
        for (std::uint32_t wall = 0; wall < 2; ++wall)
            contacts.push_back(contact_at(world, wall, ball, -walls[wall], walls[wall]));
        ResponsePlugin slide("slide", {{"max_passes", std::int64_t(1000)}});
        slide.respond(world, contacts);
        CHECK(slide.unresolved == 0);
        if (sign > 0)
            CHECK(world.velocity[ball] == velocity);
        else
            CHECK((world.velocity[ball] - Vec3(0, 0, -5)).norm() < 1e-10);
    }
}

TEST_CASE("Two balls that slide have one velocity along the line of centres", "[slide]") {
    Random random(71);
    for (int round = 0; round < 1000; ++round) {
        CAPTURE(round);
        const Vec3 normal = random.direction();
        World world = random_pair(random, normal);
        const World before = world;
        std::vector<Contact> contacts{contact_at(world, 0, 1, normal, normal)};
        ResponsePlugin slide("slide");
        slide.respond(world, contacts);
        if (normal.dot(before.velocity[1] - before.velocity[0]) < 0)
            CHECK(std::abs(normal.dot(world.velocity[1] - world.velocity[0])) < 1e-14);
        else
            CHECK(world.velocity == before.velocity);
        CHECK(world.angular_velocity == before.angular_velocity);
        const Invariants first(before), last(world);
        CHECK((last.momentum - first.momentum).norm() < 1e-13);
        CHECK(first.energy - last.energy == Approx(slide.dissipated_J).margin(1e-13));
    }
}

TEST_CASE("A ball that stops at an obstacle stands still", "[stop]") {
    Random random(72);
    for (int round = 0; round < 100; ++round) {
        CAPTURE(round);
        World world = empty_world();
        const Vec3 normal = random.direction();
        add_obstacle(world, -normal);
        const std::uint32_t ball = add_ball(world, normal, random.normal() - 9 * normal, random.uniform(0.1, 10));
        world.angular_velocity[ball] = random.normal();
        const double energy = world.kinetic_energy(ball);
        std::vector<Contact> contacts{contact_at(world, 0, ball, Vec3::Zero(), normal)};
        ResponsePlugin stop("stop");
        stop.respond(world, contacts);
        CHECK(world.velocity[ball].norm() < 1e-14);
        CHECK(world.angular_velocity[ball].norm() < 1e-13);
        CHECK(stop.dissipated_J == Approx(energy));
        CHECK(std::abs(contacts[0].friction.dot(normal)) < 1e-13);
    }
}

TEST_CASE("Two balls that stop each other go on as one body", "[stop]") {
    Random random(73);
    for (int round = 0; round < 1000; ++round) {
        CAPTURE(round);
        const Vec3 normal = random.direction();
        World world = random_pair(random, normal);
        const World before = world;
        std::vector<Contact> contacts{contact_at(world, 0, 1, normal, normal)};
        ResponsePlugin stop("stop");
        stop.respond(world, contacts);
        if (normal.dot(before.velocity[1] - before.velocity[0]) >= 0) {
            CHECK(world.velocity == before.velocity);
            CHECK(world.angular_velocity == before.angular_velocity);
            continue;
        }
        const Contact& c = contacts[0];
        CHECK((world.angular_velocity[1] - world.angular_velocity[0]).norm() < 1e-12);
        CHECK((world.velocity_at(1, c.arm_b) - world.velocity_at(0, c.arm_a)).norm() < 1e-12);
        CHECK(c.impulse > 0);
        const Invariants first(before), last(world);
        CHECK((last.momentum - first.momentum).norm() < 1e-13 * (1 + first.momentum_scale));
        CHECK((last.angular_momentum - first.angular_momentum).norm() < 1e-12 * (1 + first.momentum_scale));
        CHECK(stop.dissipated_J >= 0);
        CHECK(first.energy - last.energy == Approx(stop.dissipated_J).margin(1e-12));
        // What the contact tells is what B got.
        const Vec3 change = (world.velocity[1] - before.velocity[1]) / world.inverse_mass[1];
        CHECK((change - c.total_impulse()).norm() < 1e-12);
        const Vec3 spun = world.angular_momentum(1) - before.angular_momentum(1);
        CHECK((spun - c.arm_b.cross(c.total_impulse()) - c.couple).norm() < 1e-12);
    }
}

TEST_CASE("Stopping and sliding allocate nothing", "[stop][slide][allocation]") {
    if (!AllocationCounter::available()) WARN("allocations cannot be counted under a sanitizer");
    for (const char* name : {"stop", "slide"}) {
        CAPTURE(name);
        World world = empty_world();
        add_ball(world, Vec3(-1, 0, 0), Vec3(1, 0, 0));
        add_ball(world, Vec3(1, 0, 0), Vec3::Zero());
        std::vector<Contact> contacts{contact_at(world, 0, 1, Vec3::Zero(), Vec3::UnitX())};
        const std::vector<std::uint8_t> hit{3};
        ResponsePlugin response(name);
        const AllocationCounter allocations;
        response.run({contacts, hit, 0.01}, world);
        CHECK(allocations.count() == 0);
        CHECK(world.velocity[0].x() == 0.5);
        CHECK(world.velocity[1].x() == 0.5);
    }
}
