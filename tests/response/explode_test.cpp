#include "oracle/allocation_counter.h"
#include "response/response_plugin.h"

using namespace kolize;

namespace {

struct Strike {
    World world = empty_world();
    std::uint32_t wall = add_obstacle(world, Vec3(0, -1, 0));
    std::uint32_t missile = add_ball(world, Vec3(0, 1, 0), Vec3(0, -1, 0));
    std::uint32_t target = add_ball(world, Vec3(2, 1, 0), Vec3::Zero());
    std::vector<Contact> contacts{contact_at(world, wall, missile, Vec3(0, 0, 0), Vec3::UnitY()),
                                  contact_at(world, missile, target, Vec3(1, 1, 0), Vec3::UnitX())};
};

}  // namespace

TEST_CASE("A missile with two contacts explodes once, at the first, and what it hit stays", "[explode]") {
    Strike scene;
    const World before = scene.world;
    ResponsePlugin explode("explode");
    explode.respond(scene.world, scene.contacts, {2, 1});
    REQUIRE(explode.events.size() == 2);
    CHECK(explode.events[0].kind == EventKind::explosion);
    CHECK(explode.events[0].body == scene.missile);
    CHECK(explode.events[0].position.isZero(0));
    CHECK(explode.events[1].kind == EventKind::removal);
    CHECK(explode.events[1].body == scene.missile);
    CHECK(scene.world.velocity == before.velocity);
    CHECK(scene.world.removed == before.removed);
}

TEST_CASE("Both bodies of a contact explode where both fit the rule, but nothing static does", "[explode]") {
    Strike scene;
    ResponsePlugin explode("explode");
    explode.respond(scene.world, scene.contacts, {3, 3});
    std::vector<std::uint32_t> removed;
    for (const Event& event : explode.events)
        if (event.kind == EventKind::removal) removed.push_back(event.body);
    CHECK(removed == std::vector<std::uint32_t>{scene.missile, scene.target});
}

TEST_CASE("Where only the overlap is known a body explodes at its centre", "[explode]") {
    Strike scene;
    Contact overlap;
    overlap.a = scene.wall;
    overlap.b = scene.missile;
    std::vector<Contact> contacts{overlap};
    ResponsePlugin explode("explode");
    explode.respond(scene.world, contacts, {2});
    REQUIRE(explode.events.size() == 2);
    CHECK(explode.events[0].position == scene.world.position[scene.missile]);
}

TEST_CASE("Nothing explodes that the rule is not about, and one step knows nothing of the last", "[explode]") {
    Strike scene;
    ResponsePlugin explode("explode");
    explode.respond(scene.world, scene.contacts, {1, 0});
    CHECK(explode.events.empty());
    explode.respond(scene.world, scene.contacts, {2, 0});
    CHECK(explode.events.size() == 2);
    explode.respond(scene.world, scene.contacts, {2, 0});
    CHECK(explode.events.size() == 2);
}

TEST_CASE("A warm explode response allocates nothing", "[explode][allocation]") {
    if (!AllocationCounter::available()) WARN("allocations cannot be counted under a sanitizer");
    Strike scene;
    const std::vector<std::uint8_t> hit{2, 1};
    ResponsePlugin explode("explode");
    explode.run({scene.contacts, hit, 0.01}, scene.world);
    const AllocationCounter allocations;
    explode.run({scene.contacts, hit, 0.01}, scene.world);
    CHECK(allocations.count() == 0);
    CHECK(explode.events.size() == 2);
}
