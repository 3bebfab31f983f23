// Islands: contacts that share moving bodies are answered together, and only those.
#include "oracle/allocation_counter.h"
#include "response/response_plugin.h"

using namespace kolize;

namespace {

// Reflects the fastest approach of the whole scene until there is none: the textbook formula, no islands.
void reflect_all(World& world, const std::vector<Contact>& contacts) {
    for (;;) {
        const Contact* fastest = nullptr;
        for (const Contact& c : contacts)
            if (!fastest || normal_velocity(world, c) < normal_velocity(world, *fastest)) fastest = &c;
        const double speed = normal_velocity(world, *fastest);
        if (speed > -1e-11) return;
        const Contact& c = *fastest;
        const Vec3 turn_a = world.world_inverse_inertia(c.a) * c.arm_a.cross(c.normal);
        const Vec3 turn_b = world.world_inverse_inertia(c.b) * c.arm_b.cross(c.normal);
        const double impulse = -2 * speed /
                               (world.inverse_mass[c.a] + world.inverse_mass[c.b] +
                                c.normal.dot(turn_a.cross(c.arm_a) + turn_b.cross(c.arm_b)));
        world.velocity[c.a] -= impulse * world.inverse_mass[c.a] * c.normal;
        world.velocity[c.b] += impulse * world.inverse_mass[c.b] * c.normal;
        world.angular_velocity[c.a] -= impulse * turn_a;
        world.angular_velocity[c.b] += impulse * turn_b;
    }
}

// Clusters of a few bodies that touch each other and one obstacle that all clusters share.
struct Clusters {
    World world = empty_world();
    std::vector<Contact> contacts;

    Clusters(Random& random, int clusters) {
        const std::uint32_t obstacle = add_obstacle(world);
        for (int k = 0; k < clusters; ++k) {
            const std::uint32_t first = static_cast<std::uint32_t>(world.size());
            for (int i = 0; i < 3; ++i) add_random_body(world, random);
            contacts.push_back(contact_at(world, obstacle, first, random.normal(), random.direction()));
            contacts.push_back(contact_at(world, first, first + 1, random.normal(), random.direction()));
            contacts.push_back(contact_at(world, first + 1, first + 2, random.normal(), random.direction()));
        }
        sort_canonically(contacts);
    }
};

}  // namespace

TEST_CASE("Islands give what reflecting the fastest of the whole scene gives", "[impulse]") {
    for (unsigned seed = 10; seed < 60; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        Clusters scene(random, 8);
        World expected = scene.world;
        reflect_all(expected, scene.contacts);
        ResponsePlugin impulse("impulse");
        impulse.respond(scene.world, scene.contacts);
        REQUIRE(impulse.unresolved == 0);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            CHECK((scene.world.velocity[i] - expected.velocity[i]).norm() < 1e-9);
            CHECK((scene.world.angular_velocity[i] - expected.angular_velocity[i]).norm() < 1e-9);
        }
    }
}

TEST_CASE("What one island does has no part in another", "[impulse]") {
    Random random(60);
    Clusters scene(random, 2);
    std::vector<Contact> first_only;
    for (const Contact& c : scene.contacts)
        if (c.b <= 3) first_only.push_back(c);
    REQUIRE(first_only.size() == 3);
    World alone = scene.world;
    ResponsePlugin impulse("impulse");
    impulse.respond(alone, first_only);
    impulse.respond(scene.world, scene.contacts);
    for (int i : {1, 2, 3}) {
        CHECK(scene.world.velocity[i] == alone.velocity[i]);
        CHECK(scene.world.angular_velocity[i] == alone.angular_velocity[i]);
    }
}

TEST_CASE("A warm impulse response allocates nothing", "[impulse][allocation]") {
    if (!AllocationCounter::available()) WARN("allocations cannot be counted under a sanitizer");
    for (const std::string order : {"sequential", "symmetric"})
        for (const double restitution : {1.0, 0.5, 0.0}) {
            CAPTURE(order, restitution);
            Random random(62);
            Clusters scene(random, 50);
            scene.world.materials[0].restitution = restitution;
            const std::vector<std::uint8_t> hit(scene.contacts.size(), 3);
            const World start = scene.world;
            ResponsePlugin impulse("impulse", {{"order", order}});
            impulse.run({scene.contacts, hit, 0.01}, scene.world);
            scene.world.velocity = start.velocity;
            scene.world.angular_velocity = start.angular_velocity;
            const AllocationCounter allocations;
            impulse.run({scene.contacts, hit, 0.01}, scene.world);
            CHECK(allocations.count() == 0);
        }
}
