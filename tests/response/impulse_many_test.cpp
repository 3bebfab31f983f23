// Many contacts at once at restitution 1: named cases, whatever the order of reflections.
#include "response/response_plugin.h"

using namespace kolize;

namespace {

ResponsePlugin impulse_with(const std::string& order, std::int64_t max_impulses = 64) {
    return ResponsePlugin("impulse", {{"order", order}, {"max_impulses", max_impulses}});
}

// A light ball at rest between a wall and a heavy ball that comes in at speed 1; all touch.
struct Billiard {
    World world = empty_world();
    std::uint32_t wall = add_obstacle(world, Vec3(-2, 0, 0));
    std::uint32_t light = add_ball(world, Vec3::Zero(), Vec3::Zero());
    std::uint32_t heavy;
    std::vector<Contact> contacts;

    explicit Billiard(double mass) : heavy(add_ball(world, Vec3(2, 0, 0), Vec3(-1, 0, 0), mass)) {
        contacts.push_back(contact_at(world, wall, light, Vec3(-1, 0, 0), Vec3::UnitX()));
        contacts.push_back(contact_at(world, light, heavy, Vec3(1, 0, 0), Vec3::UnitX()));
    }
};

// Two random bodies on a wall that touch each other and the wall. The normals are independent, so that they can part.
struct Wedge {
    World world = empty_world();
    std::vector<Contact> contacts;

    explicit Wedge(Random& random) {
        const std::uint32_t wall = add_obstacle(world);
        add_random_body(world, random);
        add_random_body(world, random);
        for (const std::uint32_t body : {1, 2})
            contacts.push_back(contact_at(world, wall, body, random.normal(), Vec3::UnitZ()));
        contacts.push_back(contact_at(world, 1, 2, random.normal(), random.direction()));
    }
};

}  // namespace

TEST_CASE("R3 Galperin: a heavy ball, a light ball and a wall collide as often as pi has digits", "[impulse]") {
    // G. Galperin, "Playing pool with pi", Regular and Chaotic Dynamics 8(4), 2003: masses 100^k to 1 give
    // floor(pi 10^k) impacts, and turn (sqrt(M) V, v) by twice atan(1 / sqrt(M)) every two. One impact more or less
    // would leave the light ball on its way back.
    for (const std::string order : {"sequential", "symmetric"})
        for (const auto& [mass, impacts] :
             {std::pair{1.0, 3}, {1e2, 31}, {1e4, 314}, {1e6, 3141}, {1e8, 31415}, {1e10, 314159}}) {
            CAPTURE(order, mass, impacts);
            const int with_heavy = (impacts + 1) / 2;
            const double turned = 2 * with_heavy * std::atan(1 / std::sqrt(mass));
            Billiard scene(mass);
            const double before = Invariants(scene.world).energy;
            ResponsePlugin impulse = impulse_with(order, with_heavy);
            impulse.respond(scene.world, scene.contacts);
            CHECK(impulse.unresolved == 0);
            // Rounding of the heavy ball's velocity, once every two impacts, is a random walk: 5e-14 after 157,080.
            CHECK(std::abs(Invariants(scene.world).energy / before - 1) < (impacts < 100000 ? 2e-14 : 1e-13));
            CHECK(scene.world.velocity[scene.heavy].x() == Approx(-std::cos(turned)).margin(1e-12));
            const double light_speed = (impacts % 2 == 1 ? -1 : 1) * std::sqrt(mass) * std::sin(turned);
            CHECK(scene.world.velocity[scene.light].x() == Approx(light_speed).margin(1e-13 * mass));
            Billiard cut_short(mass);
            ResponsePlugin too_few = impulse_with(order, (impacts - 1) / 2);
            too_few.respond(cut_short.world, cut_short.contacts);
            CHECK(too_few.unresolved == 1);
        }
}

TEST_CASE("R4 cradle: as many balls go on as came in", "[impulse]") {
    for (const std::string order : {"sequential", "symmetric"})
        for (const auto& [count, moving] :
             {std::pair{2, 1}, {3, 1}, {3, 2}, {5, 1}, {5, 2}, {5, 3}, {100, 7}, {100, 50}, {1000, 1}, {1000, 30}}) {
            CAPTURE(order, count, moving);
            World world = empty_world();
            std::vector<Contact> contacts;
            for (int i = 0; i < count; ++i)
                add_ball(world, Vec3(2 * i, 0, 0), i < moving ? Vec3(1, 0, 0) : Vec3(0, 0, 0));
            for (int i = 0; i + 1 < count; ++i)
                contacts.push_back(contact_at(world, i, i + 1, Vec3(2 * i + 1, 0, 0), Vec3::UnitX()));
            ResponsePlugin impulse = impulse_with(order);
            impulse.respond(world, contacts);
            CHECK(impulse.unresolved == 0);
            double worst = 0;
            for (int i = 0; i < count; ++i)
                worst = std::max(worst, (world.velocity[i] - Vec3(i >= count - moving ? 1 : 0, 0, 0)).norm());
            CHECK(worst <= (moving == 1 ? 0 : 1e-14));
        }
}

TEST_CASE("R12 m contacts: 1 to 32 contacts of a pair all part with the same energy", "[impulse]") {
    Random random(9);
    for (const std::string order : {"sequential", "symmetric"})
        for (int count = 1; count <= 32; ++count)
            for (const double spread : {1.0, 0.5, 0.1, 0.01})
                for (int round = 0; round < 20; ++round) {
                    CAPTURE(order, count, spread, round);
                    World world = empty_world();
                    add_random_body(world, random);
                    add_random_body(world, random);
                    std::vector<Contact> contacts = random_contacts(world, random, count, spread);
                    const double speed = contact_speed(world, contacts);
                    const double before = Invariants(world).energy;
                    // 64 impulses in all do. One at a time they do not where normals lean as far as a right angle,
                    // at which bodies are jammed.
                    const bool near_jam = order == "sequential" && spread > 0.5;
                    ResponsePlugin impulse = impulse_with(order, near_jam ? 64 : 64 / count);
                    impulse.respond(world, contacts);
                    REQUIRE(impulse.unresolved == 0);
                    REQUIRE(std::abs(Invariants(world).energy / before - 1) < 1e-14);
                    REQUIRE(fastest_approach(world, contacts) <= 1e-12 * speed);
                    for (const Contact& c : contacts) REQUIRE(c.impulse >= 0);
                }
}

TEST_CASE("R13 one hits two: one after the other, or both at once", "[impulse]") {
    const Vec3 up(std::sqrt(3) / 2, 0.5, 0), down(std::sqrt(3) / 2, -0.5, 0);
    World start = empty_world();
    add_ball(start, Vec3::Zero(), Vec3(1, 0, 0));
    add_ball(start, 2 * up, Vec3::Zero());
    add_ball(start, 2 * down, Vec3::Zero());
    std::vector<Contact> contacts{contact_at(start, 0, 1, up, up), contact_at(start, 0, 2, down, down)};
    World world = start;
    // The first hit takes sqrt(3)/2 along `up`; (1/4, -sqrt(3)/4) is left and gives sqrt(3)/4 along `down`.
    impulse_with("sequential").respond(world, contacts);
    CHECK((world.velocity[1] - std::sqrt(3) / 2 * up).norm() < 1e-12);
    CHECK((world.velocity[2] - std::sqrt(3) / 4 * down).norm() < 1e-12);
    CHECK(world.velocity[0].norm() == Approx(0.25).epsilon(1e-12));
    // Momentum and energy along the axis of symmetry: sqrt(3) p + v = 1, 2 p^2 + v^2 = 1.
    world = start;
    impulse_with("symmetric").respond(world, contacts);
    CHECK((world.velocity[1] - 2 * std::sqrt(3) / 5 * up).norm() < 1e-12);
    CHECK((world.velocity[2] - 2 * std::sqrt(3) / 5 * down).norm() < 1e-12);
    CHECK((world.velocity[0] - Vec3(-0.2, 0, 0)).norm() < 1e-12);
}

TEST_CASE("P8 wedge: two bodies and a wall that touch at once always part", "[impulse]") {
    for (const std::string order : {"sequential", "symmetric"}) {
        Random random(10);
        ResponsePlugin impulse = impulse_with(order, 1000);
        int jammed = 0;
        double worst_energy = 0, worst = 0;
        for (int round = 0; round < 10000; ++round) {
            Wedge scene(random);
            const double speed = contact_speed(scene.world, scene.contacts);
            const double before = Invariants(scene.world).energy;
            impulse.respond(scene.world, scene.contacts);
            jammed += impulse.unresolved > 0;
            worst_energy = std::max(worst_energy, std::abs(Invariants(scene.world).energy / before - 1));
            worst = std::max(worst, fastest_approach(scene.world, scene.contacts) / speed);
        }
        CAPTURE(order, worst_energy);
        CHECK(jammed == 0);
        CHECK(worst <= 1e-12);
        CHECK(worst_energy < 1e-13);
    }
}

TEST_CASE("A ball jammed between two walls is reported as unresolved and keeps its energy", "[impulse]") {
    for (const std::string order : {"sequential", "symmetric"}) {
        CAPTURE(order);
        World world = empty_world();
        add_ball(world, Vec3::Zero(), Vec3(1, 0, 0));
        add_obstacle(world, Vec3(-2, 0, 0));
        add_obstacle(world, Vec3(2, 0, 0));
        std::vector<Contact> contacts{contact_at(world, 0, 1, Vec3(-1, 0, 0), -Vec3::UnitX()),
                                      contact_at(world, 0, 2, Vec3(1, 0, 0), Vec3::UnitX())};
        ResponsePlugin impulse = impulse_with(order);
        impulse.respond(world, contacts);
        CHECK(impulse.unresolved == 1);
        CHECK(world.velocity[0].norm() == 1);
    }
}
