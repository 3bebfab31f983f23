#include "framework/plugin_folder.h"
#include "framework/scenes.h"
#include "framework/solids.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

Scene two_balls() {
    Scene scene = empty_scene();
    const std::uint32_t ball = add_shape(scene, make_sphere("ball", 1));
    BodyDescription a, b;
    scene.world.add(give(a, ball, Vec3(-0.9, 0, 0), Vec3::Zero()));
    scene.world.add(give(b, ball, Vec3(0.9, 0, 0), Vec3::Zero()));
    return scene;
}

const PluginLibrary& liars() {
    static PluginFolder folder;
    static const PluginLibrary library(
        {KOLIZE_PLUGIN_DIR, folder.link("liar_broadphase").link("liar_narrowphase").path()});
    return library;
}

std::string refusal(const Scene& scene, const PluginLibrary& library) {
    const auto host = make_host(1);
    try {
        Simulation simulation(scene, library, *host, 1);
        simulation.step();
    } catch (const std::exception& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a broadphase that reports rows that do not exist is found out, with step and pair", "[negotiation]") {
    Scene scene = two_balls();
    scene.pipeline.broadphase = stage("liar");
    CHECK(refusal(scene, liars()) ==
          "broadphase 'liar' failed at step 0: it reported the pair 0 and 2 of 2 rows; a pair is two rows, the lower "
          "one first");
}

TEST_CASE("a narrowphase that gives less than it claims is found out, with step and pair", "[negotiation]") {
    Scene scene = two_balls();
    const std::string who = "narrowphase 'liar' failed at step 0: its contact of the bodies 0 and 1 has ";
    scene.pipeline.narrowphase = stage("liar");
    CHECK(refusal(scene, liars()) == who + "a normal of length 0.000000, not 1");
    scene.pipeline.narrowphase = stage("liar", {{"normal", std::string("nan")}});
    CHECK(refusal(scene, liars()) == who + "a value that is not finite");
}

TEST_CASE("a response that needs more than the narrowphase gives is refused, naming plugins that would do",
          "[negotiation]") {
    PluginFolder folder;
    const PluginLibrary library({KOLIZE_PLUGIN_DIR, folder.link("overlap_only").path()});
    Scene scene = two_balls();
    scene.pipeline.narrowphase = stage("overlap_only");
    CHECK(refusal(scene, library) ==
          "scene.toml:3:10: response 'impulse' needs normal, but narrowphase 'overlap_only' as configured gives only "
          "overlap; "
          "these would do: angle_sum, bounding_volume, embree, exact, fcl, gjk_epa, guigue_devillers, moller, sat");
    scene.pipeline.responses = {{stage("explode"), {}}};
    CHECK(refusal(scene, library).empty());
}

TEST_CASE("a shape that the narrowphase does not take is refused, naming plugins that would do", "[negotiation]") {
    PluginFolder folder;
    const PluginLibrary library({KOLIZE_PLUGIN_DIR, folder.link("overlap_only").path()});
    Scene scene = two_balls();
    scene.pipeline.narrowphase = stage("overlap_only");
    scene.pipeline.responses = {{stage("explode"), {}}};
    BodyDescription box;
    give(box, add_shape(scene, make_box("box", Vec3(1, 1, 1))), Vec3(5, 0, 0), Vec3::Zero()).name = "crate";
    scene.world.add(box);
    CHECK(refusal(scene, library) ==
          "scene.toml:3:10: narrowphase 'overlap_only' does not take shapes of kind box (body 'crate'); "
          "these would do: angle_sum, bounding_volume, embree, exact, fcl, gjk_epa, guigue_devillers, moller, sat");
}

TEST_CASE("a wall shape that the narrowphase does not take is refused by name", "[negotiation]") {
    Scene scene = two_balls();
    scene.rooms.push_back(room_of(3));
    for (const char* walls : {"half_space", "box", "mesh"}) {
        scene.pipeline.walls = walls;
        CHECK(refusal(scene, plugins()).empty());
        const auto host = make_host(1);
        CHECK(Simulation(scene, plugins(), *host, 1).walls() == walls);
    }
}

TEST_CASE("walls that are left to choose are half-spaces around one room, and boxes around several", "[negotiation]") {
    Scene scene = two_balls();
    const auto host = make_host(1);
    scene.rooms.push_back(room_of(3));
    CHECK(Simulation(scene, plugins(), *host, 1).walls() == "half_space");
    scene.rooms.push_back(room_of(2));
    CHECK(Simulation(scene, plugins(), *host, 1).walls() == "box");
}
