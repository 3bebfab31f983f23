#include "oracle/allocation_counter.h"
#include "response/response_plugin.h"

using namespace kolize;

TEST_CASE("A ball bounces off an obstacle like light off a mirror", "[simple_bounce]") {
    for (const double restitution : {1.0, 0.5, 0.0}) {
        CAPTURE(restitution);
        World world = empty_world();
        world.materials[0].restitution = restitution;
        add_obstacle(world, Vec3(0, -1, 0));
        const std::uint32_t ball = add_ball(world, Vec3(0, 1, 0), Vec3(3, -4, 1), 2);
        world.angular_velocity[ball] = Vec3(1, 2, 3);
        std::vector<Contact> contacts{contact_at(world, 0, ball, Vec3(0.5, 0, 0), Vec3::UnitY())};
        ResponsePlugin bounce("simple_bounce");
        bounce.respond(world, contacts);
        CHECK((world.velocity[ball] - Vec3(3, 4 * restitution, 1)).norm() < 1e-15);
        CHECK(world.angular_velocity[ball] == Vec3(1, 2, 3));
        CHECK(contacts[0].impulse == Approx(2 * 4 * (1 + restitution)));
        CHECK(bounce.dissipated_J == Approx(0.5 * 2 * 16 * (1 - restitution * restitution)).margin(1e-13));
        CHECK(bounce.unresolved == 0);
    }
}

TEST_CASE("Two balls exchange momentum along the line of centres and keep the rest", "[simple_bounce]") {
    Random random(70);
    for (int round = 0; round < 1000; ++round) {
        CAPTURE(round);
        World world = empty_world();
        const Vec3 normal = random.direction();
        const double mass_a = random.uniform(0.1, 10), mass_b = random.uniform(0.1, 10);
        add_ball(world, Vec3::Zero(), random.normal(), mass_a);
        add_ball(world, 2 * normal, random.normal(), mass_b);
        const World before = world;
        std::vector<Contact> contacts{contact_at(world, 0, 1, normal, normal)};
        ResponsePlugin bounce("simple_bounce");
        bounce.respond(world, contacts);
        const double u = before.velocity[0].dot(normal), v = before.velocity[1].dot(normal);
        const bool meet = v < u;
        // One-dimensional elastic collision along the normal.
        const double total = mass_a + mass_b;
        const double u_after = meet ? ((mass_a - mass_b) * u + 2 * mass_b * v) / total : u;
        const double v_after = meet ? ((mass_b - mass_a) * v + 2 * mass_a * u) / total : v;
        CHECK((world.velocity[0] - before.velocity[0] - (u_after - u) * normal).norm() < 1e-13);
        CHECK((world.velocity[1] - before.velocity[1] - (v_after - v) * normal).norm() < 1e-13);
        CHECK(Invariants(world).energy == Approx(Invariants(before).energy).epsilon(1e-14));
    }
}

TEST_CASE("A push goes through a row of balls in either order of names", "[simple_bounce]") {
    for (const bool reversed : {false, true}) {
        CAPTURE(reversed);
        const int count = 10;
        World world = empty_world();
        for (int i = 0; i < count; ++i) {
            const int place = reversed ? count - 1 - i : i;
            add_ball(world, Vec3(2 * place, 0, 0), place == 0 ? Vec3(1, 0, 0) : Vec3(0, 0, 0));
        }
        const Vec3 normal = reversed ? Vec3(-1, 0, 0) : Vec3(1, 0, 0);
        std::vector<Contact> contacts;
        for (int i = 0; i + 1 < count; ++i)
            contacts.push_back(contact_at(world, i, i + 1, world.position[i] + normal, normal));
        ResponsePlugin bounce("simple_bounce");
        bounce.respond(world, contacts);
        CHECK(bounce.unresolved == 0);
        for (int i = 0; i < count; ++i) CHECK(world.velocity[i].x() == (world.position[i].x() == 2 * (count - 1)));
    }
}

TEST_CASE("A ball jammed between two obstacles is reported after the last pass", "[simple_bounce]") {
    World world = empty_world();
    add_ball(world, Vec3::Zero(), Vec3(1, 0, 0));
    add_obstacle(world, Vec3(-2, 0, 0));
    add_obstacle(world, Vec3(2, 0, 0));
    std::vector<Contact> contacts{contact_at(world, 0, 1, Vec3(-1, 0, 0), -Vec3::UnitX()),
                                  contact_at(world, 0, 2, Vec3(1, 0, 0), Vec3::UnitX())};
    ResponsePlugin bounce("simple_bounce", {{"max_passes", std::int64_t(5)}});
    bounce.respond(world, contacts);
    CHECK(bounce.unresolved == 1);
    CHECK(world.velocity[0].norm() == 1);
}

TEST_CASE("A simple bounce allocates nothing", "[simple_bounce][allocation]") {
    if (!AllocationCounter::available()) WARN("allocations cannot be counted under a sanitizer");
    World world = empty_world();
    add_ball(world, Vec3(-1, 0, 0), Vec3(1, 0, 0));
    add_ball(world, Vec3(1, 0, 0), Vec3::Zero());
    std::vector<Contact> contacts{contact_at(world, 0, 1, Vec3::Zero(), Vec3::UnitX())};
    const std::vector<std::uint8_t> hit{3};
    ResponsePlugin bounce("simple_bounce");
    const AllocationCounter allocations;
    bounce.run({contacts, hit, 0.01}, world);
    CHECK(allocations.count() == 0);
    CHECK(world.velocity[1].x() == 1);
}
