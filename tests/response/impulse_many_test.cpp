// Many contacts at once: sequential reflection.
#include "oracle/allocation_counter.h"
#include "response/response_plugin.h"

using namespace kolize;

namespace {

ResponsePlugin impulse_with(std::int64_t max_impulses) {
    return ResponsePlugin("impulse", "max_impulses", max_impulses);
}

// Up to 32 contacts of two bodies, with normals that lean at most as far as `spread` says, below a right angle.
std::vector<Contact> random_contacts(const World& world, Random& random, int count, double spread) {
    const Vec3 lead = random.direction();
    std::vector<Contact> contacts;
    for (int i = 0; i < count; ++i) {
        const Vec3 normal = (lead + 0.999 * spread * random.direction()).normalized();
        contacts.push_back(contact_at(world, 0, 1, random.normal(), normal));
    }
    return contacts;
}

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
        std::sort(contacts.begin(), contacts.end(), [](const Contact& c, const Contact& d) {
            return Pair{c.a, c.b} < Pair{d.a, d.b};
        });
    }
};

}  // namespace

TEST_CASE("One to 32 contacts of a pair all part with the same energy", "[impulse]") {
    Random random(9);
    for (int count = 1; count <= 32; ++count)
        for (const double spread : {1.0, 0.1, 0.01})
            for (int round = 0; round < 20; ++round) {
                CAPTURE(count, spread, round);
                World world = empty_world();
                add_random_body(world, random);
                add_random_body(world, random);
                std::vector<Contact> contacts = random_contacts(world, random, count, spread);
                const double before = Invariants(world).energy;
                // 64 impulses in all do where the normals are alike; leaning against each other they take more.
                ResponsePlugin impulse = impulse_with(spread > 0.1 ? 64 : 64 / count);
                impulse.respond(world, contacts);
                REQUIRE(impulse.unresolved == 0);
                REQUIRE(std::abs(Invariants(world).energy / before - 1) < 1e-14);
                const double speed = world.velocity[0].norm() + world.velocity[1].norm() +
                                     world.angular_velocity[0].norm() + world.angular_velocity[1].norm();
                for (const Contact& c : contacts) {
                    REQUIRE(normal_velocity(world, c) > -1e-11 * speed);
                    REQUIRE(c.impulse >= 0);
                }
            }
}

TEST_CASE("A heavy ball, a light ball and a wall collide as often as pi has digits", "[impulse]") {
    // G. Galperin, "Playing pool with pi", Regular and Chaotic Dynamics 8(4), 2003: masses 100^k to 1 give
    // floor(pi 10^k) impacts.
    for (const auto& [mass, impacts] : {std::pair{1.0, 3}, {1e2, 31}, {1e4, 314}, {1e6, 3141}, {1e8, 31415}}) {
        CAPTURE(mass, impacts);
        World start = empty_world();
        const std::uint32_t wall = add_obstacle(start, Vec3(-2, 0, 0));
        const std::uint32_t light = add_ball(start, Vec3::Zero(), Vec3::Zero());
        const std::uint32_t heavy = add_ball(start, Vec3(2, 0, 0), Vec3(-1, 0, 0), mass);
        const std::vector<Contact> contacts{contact_at(start, wall, light, Vec3(-1, 0, 0), Vec3::UnitX()),
                                            contact_at(start, light, heavy, Vec3(1, 0, 0), Vec3::UnitX())};
        const auto unresolved_after = [&](int pairs_of_impulses) {
            World world = start;
            std::vector<Contact> rows = contacts;
            ResponsePlugin impulse = impulse_with(pairs_of_impulses);
            impulse.respond(world, rows);
            CHECK(std::abs(Invariants(world).energy / Invariants(start).energy - 1) < 1e-15 * impacts);
            return impulse.unresolved;
        };
        CHECK(unresolved_after((impacts + 1) / 2) == 0);
        CHECK(unresolved_after((impacts - 1) / 2) > 0);
    }
}

TEST_CASE("A cradle passes on as many balls as hit it", "[impulse]") {
    for (const auto& [count, moving] : {std::pair{2, 1}, {5, 1}, {5, 2}, {5, 3}, {100, 7}, {1000, 1}}) {
        CAPTURE(count, moving);
        World world = empty_world();
        std::vector<Contact> contacts;
        for (int i = 0; i < count; ++i) add_ball(world, Vec3(2 * i, 0, 0), i < moving ? Vec3(1, 0, 0) : Vec3(0, 0, 0));
        for (int i = 0; i + 1 < count; ++i)
            contacts.push_back(contact_at(world, i, i + 1, Vec3(2 * i + 1, 0, 0), Vec3::UnitX()));
        ResponsePlugin impulse("impulse");
        impulse.respond(world, contacts);
        CHECK(impulse.unresolved == 0);
        bool as_expected = true;
        for (int i = 0; i < count; ++i)
            as_expected = as_expected && world.velocity[i] == Vec3(i >= count - moving ? 1 : 0, 0, 0);
        CHECK(as_expected);
    }
}

TEST_CASE("One ball that hits two at once answers them one after the other", "[impulse]") {
    World world = empty_world();
    const Vec3 up(std::sqrt(3) / 2, 0.5, 0), down(std::sqrt(3) / 2, -0.5, 0);
    add_ball(world, Vec3::Zero(), Vec3(1, 0, 0));
    add_ball(world, 2 * up, Vec3::Zero());
    add_ball(world, 2 * down, Vec3::Zero());
    std::vector<Contact> contacts{contact_at(world, 0, 1, up, up), contact_at(world, 0, 2, down, down)};
    ResponsePlugin impulse("impulse");
    impulse.respond(world, contacts);
    // The first hit takes sqrt(3)/2 along `up`; (1/4, -sqrt(3)/4) is left and gives sqrt(3)/4 along `down`.
    CHECK(world.velocity[1].norm() == Approx(std::sqrt(3) / 2).epsilon(1e-12));
    CHECK(world.velocity[2].norm() == Approx(std::sqrt(3) / 4).epsilon(1e-12));
    CHECK(world.velocity[0].norm() == Approx(0.25).epsilon(1e-12));
}

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

TEST_CASE("With restitution below one many contacts come to rest against each other", "[impulse]") {
    Random random(61);
    for (const double restitution : {0.0, 0.3, 0.8}) {
        CAPTURE(restitution);
        World world = empty_world();
        world.materials[0].restitution = restitution;
        add_random_body(world, random);
        add_random_body(world, random);
        std::vector<Contact> contacts = random_contacts(world, random, 4, 0.1);
        const double before = Invariants(world).energy;
        ResponsePlugin impulse = impulse_with(10000);
        impulse.respond(world, contacts);
        CHECK(impulse.unresolved == 0);
        for (const Contact& c : contacts) CHECK(normal_velocity(world, c) > -1e-10);
        CHECK(before - Invariants(world).energy == Approx(impulse.dissipated_J).margin(1e-13 * before));
    }
}

TEST_CASE("A ball jammed between two walls is reported as unresolved and keeps its energy", "[impulse]") {
    World world = empty_world();
    add_ball(world, Vec3::Zero(), Vec3(1, 0, 0));
    add_obstacle(world, Vec3(-2, 0, 0));
    add_obstacle(world, Vec3(2, 0, 0));
    std::vector<Contact> contacts{contact_at(world, 0, 1, Vec3(-1, 0, 0), -Vec3::UnitX()),
                                  contact_at(world, 0, 2, Vec3(1, 0, 0), Vec3::UnitX())};
    ResponsePlugin impulse("impulse");
    impulse.respond(world, contacts);
    CHECK(impulse.unresolved == 1);
    CHECK(world.velocity[0].norm() == 1);
}

TEST_CASE("A warm impulse response allocates nothing", "[impulse][allocation]") {
    if (!AllocationCounter::available()) WARN("allocations cannot be counted under a sanitizer");
    Random random(62);
    Clusters scene(random, 50);
    const std::vector<std::uint8_t> hit(scene.contacts.size(), 3);
    const World start = scene.world;
    ResponsePlugin impulse("impulse");
    impulse.run({scene.contacts, hit, 0.01}, scene.world);
    scene.world.velocity = start.velocity;
    scene.world.angular_velocity = start.angular_velocity;
    const AllocationCounter allocations;
    impulse.run({scene.contacts, hit, 0.01}, scene.world);
    CHECK(allocations.count() == 0);
}
