// The response at its extremes: energy, momentum and angular momentum of an event, and that it ends. Each table goes as
// far as its bounds hold.
#include "response/response_plugin.h"

using namespace kolize;

namespace {

struct Extreme {
    double mass_ratio = 1;
    double condition = 1;  // largest moment of inertia over the smallest
    double reach = 1;      // of the contact points, in sizes of the bodies
    int contacts = 1;
    double spread = 0.1;  // of the normals
    double restitution = 1;
};

// Relative to the energy, to the momentum that was passed on, to the speeds at the contacts.
struct Worst {
    double energy = 0, momentum = 0, angular_momentum = 0, approach = 0;
    int unresolved = 0;
};

World two_bodies(const Extreme& extreme, Random& random) {
    World world = empty_world();
    world.materials[0].restitution = extreme.restitution;
    for (const double mass : {1.0, extreme.mass_ratio}) {
        BodyDescription body;
        body.mass = mass;
        body.orientation = random.rotation();
        body.position = random.normal();
        body.velocity = random.normal();
        body.angular_velocity = random.normal();
        add_body(world, Vec3(1, 1, 1 / extreme.condition), body);
    }
    return world;
}

Worst worst_of(const std::string& order, const Extreme& extreme, std::int64_t max_impulses, int rounds = 40) {
    Random random(100);
    Worst worst;
    ResponsePlugin impulse("impulse", {{"order", order}, {"max_impulses", max_impulses}});
    for (int round = 0; round < rounds; ++round) {
        World world = two_bodies(extreme, random);
        std::vector<Contact> contacts = random_contacts(world, random, extreme.contacts, extreme.spread, extreme.reach);
        const double speed = contact_speed(world, contacts);
        const Invariants before(world);
        impulse.respond(world, contacts);
        const Invariants after(world);
        double passed_on = before.momentum_scale;
        for (const Contact& c : contacts) passed_on += c.impulse * (1 + c.arm_a.norm() + c.arm_b.norm());
        const auto note = [](double& value, double candidate) { value = std::max(value, candidate); };
        note(worst.energy, std::abs(before.energy - after.energy - impulse.dissipated_J) / before.energy);
        note(worst.momentum, (after.momentum - before.momentum).norm() / passed_on);
        note(worst.angular_momentum, (after.angular_momentum - before.angular_momentum).norm() / passed_on);
        note(worst.approach, fastest_approach(world, contacts) / speed);
        worst.unresolved += impulse.unresolved > 0;
    }
    return worst;
}

void check_bounds(const Extreme& extreme, std::int64_t max_impulses = 64) {
    for (const std::string order : {"sequential", "symmetric"}) {
        CAPTURE(order, extreme.mass_ratio, extreme.condition, extreme.reach, extreme.contacts, extreme.spread,
                extreme.restitution);
        const Worst worst = worst_of(order, extreme, max_impulses);
        CHECK(worst.energy <= 1e-14);
        CHECK(worst.momentum <= 1e-15);
        CHECK(worst.angular_momentum <= 2e-15);
        CHECK(worst.approach <= 1e-12);
        CHECK(worst.unresolved == 0);
    }
}

}  // namespace

TEST_CASE("One impact is exact up to mass ratio 1e15, condition 1e12 and arms of 1e6 sizes", "[impulse][extremes]") {
    for (const double restitution : {0.0, 0.5, 1.0}) {
        for (const double ratio : {1e-15, 1e-6, 1.0, 1e6, 1e15})
            check_bounds({.mass_ratio = ratio, .restitution = restitution});
        for (const double condition : {1.0, 1e3, 1e6, 1e9, 1e12})
            check_bounds({.condition = condition, .restitution = restitution});
        for (const double reach : {1.0, 1e2, 1e4, 1e6}) check_bounds({.reach = reach, .restitution = restitution});
    }
}

TEST_CASE("Up to 64 contacts with normals as near as 1e-8 are answered by at most 64 impulses", "[impulse][extremes]") {
    for (const int contacts : {2, 8, 32, 64})
        for (const double spread : {0.1, 1e-4, 1e-8, 1e-12})
            check_bounds({.contacts = contacts, .spread = spread}, 64 / contacts);
}

TEST_CASE("Sixteen contacts at once hold their bounds up to mass ratio 1e15, at any restitution",
          "[impulse][extremes]") {
    for (const double restitution : {0.0, 0.5, 1.0})
        for (const double ratio : {1e3, 1e9, 1e15})
            check_bounds({.mass_ratio = ratio, .contacts = 16, .restitution = restitution});
}

TEST_CASE("Sixteen contacts at once hold their bounds up to condition 1e2 and arms of ten sizes",
          "[impulse][extremes]") {
    for (const double restitution : {0.0, 0.5, 1.0}) {
        check_bounds({.condition = 1e2, .contacts = 16, .restitution = restitution});
        check_bounds({.reach = 10, .contacts = 16, .restitution = restitution});
    }
}

TEST_CASE("Contacts too many and too far out for an answer are reported, and no energy comes in",
          "[impulse][extremes]") {
    for (const std::string order : {"sequential", "symmetric"})
        for (const double reach : {1e2, 1e4, 1e6}) {
            CAPTURE(order, reach);
            const Worst worst = worst_of(order, {.reach = reach, .contacts = 16}, 16, 5);
            CHECK(worst.energy <= 1e-12);
            if (worst.unresolved == 0) CHECK(worst.approach <= 1e-12);
        }
}
