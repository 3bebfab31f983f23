// Restitution below 1 where several contacts share bodies.
#include "response/response_plugin.h"

using namespace kolize;

namespace {

const std::vector<std::string> orders{"sequential", "symmetric"};

ResponsePlugin impulse_in(const std::string& order) { return ResponsePlugin("impulse", {{"order", order}}); }

// A heap of balls on a floor, each with contacts to its neighbours, that falls.
struct Heap {
    World world = empty_world();
    std::vector<Contact> contacts;

    Heap(Random& random, int side) : side_(side) {
        const std::uint32_t floor = add_obstacle(world);
        for (int i = 0; i < side * side * side; ++i) {
            const Vec3 place(2.0 * (i % side), 2.0 * (i / side % side), 2.0 * (i / side / side));
            add_ball(world, place + 0.01 * random.normal(), Vec3(0, 0, -1) + 0.1 * random.normal(),
                     random.uniform(0.5, 2));
        }
        for (int x = 0; x < side; ++x)
            for (int y = 0; y < side; ++y)
                for (int z = 0; z < side; ++z) {
                    const std::uint32_t ball = number(x, y, z);
                    if (z == 0)
                        contacts.push_back(
                            contact_at(world, floor, ball, world.position[ball] - Vec3::UnitZ(), Vec3::UnitZ()));
                    if (x + 1 < side) touch(ball, number(x + 1, y, z));
                    if (y + 1 < side) touch(ball, number(x, y + 1, z));
                    if (z + 1 < side) touch(ball, number(x, y, z + 1));
                }
        sort_canonically(contacts);
    }

private:
    std::uint32_t number(int x, int y, int z) const {
        return static_cast<std::uint32_t>(1 + (z * side_ + y) * side_ + x);
    }
    void touch(std::uint32_t a, std::uint32_t b) {
        const Vec3 between = world.position[b] - world.position[a];
        contacts.push_back(contact_at(world, a, b, world.position[a] + 0.5 * between, between.normalized()));
    }

    int side_;
};

// A unit cube that lands flat on its four lower corners.
struct FlatLanding {
    World world = empty_world();
    std::vector<Contact> contacts;

    FlatLanding() {
        const std::uint32_t floor = add_obstacle(world);
        BodyDescription body;
        body.position = Vec3(0, 0, 0.5);
        body.velocity = Vec3(0.5, 0, -2);
        const std::uint32_t cube = add_body(world, Vec3::Constant(1.0 / 6), body);
        for (const double x : {-0.5, 0.5})
            for (const double y : {-0.5, 0.5})
                contacts.push_back(contact_at(world, floor, cube, Vec3(x, y, 0), Vec3::UnitZ()));
    }
};

}  // namespace

TEST_CASE("At restitution 0 nothing approaches, and what parts has not been pushed", "[impulse][restitution]") {
    // These are the conditions of Karush, Kuhn and Tucker of the nearest state that is allowed: there is but one.
    Random random(61);
    for (const std::string& order : orders)
        for (int count = 1; count <= 32; ++count)
            for (const double spread : {1.0, 0.1, 0.01}) {
                CAPTURE(order, count, spread);
                World world = empty_world();
                world.materials[0].restitution = 0;
                add_random_body(world, random);
                add_random_body(world, random);
                std::vector<Contact> contacts = random_contacts(world, random, count, spread);
                const double speed = contact_speed(world, contacts);
                const Invariants before(world);
                ResponsePlugin impulse = impulse_in(order);
                impulse.respond(world, contacts);
                const Invariants after(world);
                REQUIRE(impulse.unresolved == 0);
                REQUIRE(fastest_approach(world, contacts) <= 1e-12 * speed);
                for (const Contact& c : contacts)
                    REQUIRE(c.impulse * normal_velocity(world, c) <= 1e-12 * before.energy);
                REQUIRE(std::abs(before.energy - after.energy - impulse.dissipated_J) <= 1e-14 * before.energy);
                REQUIRE((after.momentum - before.momentum).norm() <= 1e-14 * before.momentum_scale);
            }
}

TEST_CASE("Between 0 and 1 nothing approaches, no energy comes in, and the loss is exact", "[impulse][restitution]") {
    Random random(62);
    for (const std::string& order : orders)
        for (const double restitution : {0.01, 0.3, 0.5, 0.9, 0.99})
            for (int count = 1; count <= 32; ++count)
                for (const double spread : {1.0, 0.1, 0.01}) {
                    CAPTURE(order, restitution, count, spread);
                    World world = empty_world();
                    world.materials[0].restitution = restitution;
                    add_random_body(world, random);
                    add_random_body(world, random);
                    std::vector<Contact> contacts = random_contacts(world, random, count, spread);
                    const double speed = contact_speed(world, contacts);
                    const double before = Invariants(world).energy;
                    ResponsePlugin impulse = impulse_in(order);
                    impulse.respond(world, contacts);
                    REQUIRE(impulse.unresolved == 0);
                    REQUIRE(fastest_approach(world, contacts) <= 1e-12 * speed);
                    REQUIRE(impulse.dissipated_J >= 0);
                    REQUIRE(std::abs(before - Invariants(world).energy - impulse.dissipated_J) <= 1e-14 * before);
                }
}

TEST_CASE("A cube that lands flat jumps off flat in symmetric order, with Newton's speed", "[impulse][restitution]") {
    for (const double restitution : {0.0, 0.25, 0.5, 0.9, 1.0}) {
        CAPTURE(restitution);
        FlatLanding scene;
        scene.world.materials[0].restitution = restitution;
        ResponsePlugin impulse = impulse_in("symmetric");
        impulse.respond(scene.world, scene.contacts);
        CHECK((scene.world.velocity[1] - Vec3(0.5, 0, 2 * restitution)).norm() < 1e-14);
        CHECK(scene.world.angular_velocity[1].norm() < 1e-14);
        CHECK(impulse.unresolved == 0);
    }
}

TEST_CASE("A cube that lands flat at restitution 0 lies still in either order", "[impulse][restitution]") {
    for (const std::string& order : orders) {
        CAPTURE(order);
        FlatLanding scene;
        scene.world.materials[0].restitution = 0;
        ResponsePlugin impulse = impulse_in(order);
        impulse.respond(scene.world, scene.contacts);
        CHECK((scene.world.velocity[1] - Vec3(0.5, 0, 0)).norm() < 1e-14);
        CHECK(scene.world.angular_velocity[1].norm() < 1e-14);
        CHECK(impulse.dissipated_J == Approx(2).epsilon(1e-14));
    }
}

TEST_CASE("The limit of restitution 1 is the elastic outcome", "[impulse][restitution]") {
    for (const std::string& order : orders)
        for (unsigned seed = 63; seed < 83; ++seed) {
            CAPTURE(order, seed);
            Random random(seed);
            World elastic = empty_world();
            add_random_body(elastic, random);
            add_random_body(elastic, random);
            std::vector<Contact> contacts = random_contacts(elastic, random, 6, 0.3);
            World nearly = elastic;
            nearly.materials[0].restitution = std::nextafter(1.0, 0.0);
            ResponsePlugin impulse = impulse_in(order);
            impulse.respond(elastic, contacts);
            impulse.respond(nearly, contacts);
            for (int i : {0, 1}) {
                CHECK((elastic.velocity[i] - nearly.velocity[i]).norm() < 1e-12);
                CHECK((elastic.angular_velocity[i] - nearly.angular_velocity[i]).norm() < 1e-12);
            }
        }
}

TEST_CASE("Materials of different restitution meet in one impact without a gain of energy", "[impulse][restitution]") {
    Random random(64);
    for (const std::string& order : orders)
        for (int round = 0; round < 200; ++round) {
            CAPTURE(order, round);
            World world = empty_world();
            world.materials[0].restitution = 0;
            world.materials.push_back({"rubber", random.uniform(0, 1), 0, 1000});
            add_obstacle(world);
            for (int i : {1, 2, 3}) world.material[add_random_body(world, random)] = i == 2;
            std::vector<Contact> contacts;
            for (std::uint32_t i : {1, 2, 3})
                contacts.push_back(contact_at(world, 0, i, random.normal(), Vec3::UnitZ()));
            contacts.push_back(contact_at(world, 1, 2, random.normal(), random.direction()));
            contacts.push_back(contact_at(world, 2, 3, random.normal(), random.direction()));
            const double speed = contact_speed(world, contacts);
            const double before = Invariants(world).energy;
            ResponsePlugin impulse = impulse_in(order);
            impulse.respond(world, contacts);
            CHECK(impulse.unresolved == 0);
            CHECK(fastest_approach(world, contacts) <= 1e-12 * speed);
            CHECK(impulse.dissipated_J >= 0);
            CHECK(std::abs(before - Invariants(world).energy - impulse.dissipated_J) <= 1e-14 * before);
        }
}

TEST_CASE("A heap of 216 balls that falls comes to an end at any restitution", "[impulse][restitution]") {
    for (const std::string& order : orders)
        for (const double restitution : {0.0, 0.5, 0.9}) {
            CAPTURE(order, restitution);
            Random random(65);
            Heap heap(random, 6);
            heap.world.materials[0].restitution = restitution;
            const double speed = contact_speed(heap.world, heap.contacts);
            const double before = Invariants(heap.world).energy;
            ResponsePlugin impulse = impulse_in(order);
            impulse.respond(heap.world, heap.contacts);
            CHECK(impulse.unresolved == 0);
            CHECK(fastest_approach(heap.world, heap.contacts) <= 1e-12 * speed);
            CHECK(std::abs(before - Invariants(heap.world).energy - impulse.dissipated_J) <= 1e-13 * before);
        }
}

TEST_CASE("A ball jammed between two walls stops unless restitution is 1", "[impulse][restitution]") {
    for (const std::string& order : orders)
        for (const double restitution : {0.0, 0.5, 0.999}) {
            CAPTURE(order, restitution);
            World world = empty_world();
            world.materials[0].restitution = restitution;
            add_ball(world, Vec3::Zero(), Vec3(1, 2, 0));
            add_obstacle(world, Vec3(-2, 0, 0));
            add_obstacle(world, Vec3(2, 0, 0));
            std::vector<Contact> contacts{contact_at(world, 0, 1, Vec3(-1, 0, 0), -Vec3::UnitX()),
                                          contact_at(world, 0, 2, Vec3(1, 0, 0), Vec3::UnitX())};
            ResponsePlugin impulse = impulse_in(order);
            impulse.respond(world, contacts);
            CHECK(impulse.unresolved == 0);
            CHECK((world.velocity[0] - Vec3(0, 2, 0)).norm() < 1e-12);
            CHECK(impulse.dissipated_J == Approx(0.5).epsilon(1e-12));
        }
}
