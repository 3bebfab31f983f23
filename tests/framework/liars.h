// Plugins that break their contract, beside those that keep it.
#pragma once

#include "framework/plugin_folder.h"
#include "framework/scenes.h"

namespace kolize::test {

inline const PluginLibrary& liars() {
    static PluginFolder folder;
    static const PluginLibrary library(
        {KOLIZE_PLUGIN_DIR, folder.link("liar_broadphase").link("liar_narrowphase").link("liar_response").path()});
    return library;
}

// Three balls of 2, 1 and 1 kg on the x axis: the first flies at the second, which it meets after about 0.2 s; the
// third stays apart.
inline Scene three_balls() {
    Scene scene = empty_scene();
    const std::uint32_t ball = add_shape(scene, make_sphere("ball", 0.5));
    for (const auto& [x, speed, mass] : {std::array{0.0, 5.0, 2.0}, {2.0, 0.0, 1.0}, {50.0, 0.0, 1.0}}) {
        BodyDescription body;
        give(body, ball, Vec3(x, 0, 0), Vec3(speed, 0, 0)).mass = mass;
        body.angular_velocity = Vec3(0, 0, x < 1 ? 4 : 0);
        scene.world.add(body);
    }
    scene.pipeline.step.dt = 1.0 / 64;
    return scene;
}

}  // namespace kolize::test
