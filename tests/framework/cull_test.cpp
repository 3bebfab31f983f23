// A cull takes pairs from the narrowphase that would have given no contact: the run is the same, bit for bit.
#include "framework/scene_folder.h"
#include "framework/scenes.h"
#include "narrowphase/solids.h"

#include <kolize/capsule.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

const std::vector<std::string> culls{"auto", "sphere", "aabb", "obb", "kdop18", "kdop26"};

TriangleSoup scaled(TriangleSoup soup, double factor) {
    for (Vec3& vertex : soup.vertices) vertex *= factor;
    return soup;
}

// Balls, boxes and meshes in turn, so that mixed pairs of volumes occur.
Scene mixed_gas() {
    Scene scene = gas(make_sphere("ball", 0.4), 4, 1.9, 20261110);
    const std::uint32_t others[] = {0, add_shape(scene, make_box("box", Vec3(0.6, 0.3, 0.4))),
                                    add_shape(scene, make_mesh("u", scaled(u_bar(), 0.5))),
                                    add_shape(scene, make_mesh("spike", scaled(spike(), 0.6)))};
    World crowd = scene.world;
    Scene mixed = empty_scene();
    mixed.world.shapes = crowd.shapes;
    for (std::uint32_t body = 0; body < crowd.size(); ++body) {
        BodyDescription description;
        give(description, others[body % 4], crowd.position[body], crowd.velocity[body]);
        description.angular_velocity = crowd.angular_velocity[body];
        mixed.world.add(description);
    }
    mixed.rooms = scene.rooms;
    return mixed;
}

}  // namespace

TEST_CASE("A run with a cull is the run without, in every stepping and with boxes or half-spaces for walls", "[cull]") {
    const std::string mode = GENERATE("discrete", "rollback", "bisection", "continuous");
    const std::string walls = GENERATE("half_space", "box");
    CAPTURE(mode, walls);
    Scene scene = mixed_gas();
    scene.pipeline.step.mode = mode;
    scene.pipeline.step.dt = 0.01;
    scene.pipeline.walls = walls;
    const std::uint64_t steps = mode == "discrete" ? 60 : 6;
    const RunResult without = run(scene, steps);
    if (mode == "discrete") CHECK(without.contacts > 50);
    for (const std::string& cull : culls) {
        CAPTURE(cull);
        scene.pipeline.cull = cull;
        const RunResult with = run(scene, steps, 2);
        CHECK(with.state_hash == without.state_hash);
        CHECK(with.contacts == without.contacts);
        CHECK(with.pairs == without.pairs);
        CHECK(with.triangle_tests <= without.triangle_tests);
    }
}

TEST_CASE("The cull is read, refused by name and written into capsules", "[cull][scene]") {
    const std::string text = ball + "[[body]]\nshape = \"ball\"\n";
    CHECK(SceneFolder().write("scene.toml", text).load().pipeline.cull == "none");
    const Scene scene = SceneFolder().write("scene.toml", text + "[narrowphase]\ncull = \"kdop18\"\n").load();
    CHECK(scene.pipeline.cull == "kdop18");
    CHECK(capsule_text(scene, "a test").find("cull = \"kdop18\"") != std::string::npos);
    CHECK(complaint(text + "[narrowphase]\ncull = \"ball\"\n") ==
          "scene.toml:8:8: there is no cull 'ball'; there are none, auto, sphere, aabb, obb, kdop18, kdop26");
}
