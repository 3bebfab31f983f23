// Scenes with something of everything, and capsules of them.
#pragma once

#include "framework/liars.h"
#include "framework/mesh_files.h"
#include "framework/solids.h"
#include "narrowphase/solids.h"

#include <kolize/capsule.h>

namespace kolize::test {

inline Scene read_capsule(const std::string& text) {
    const ScratchFolder folder;
    folder.write("capsule.toml", text);
    return load_scene(folder.path() / "capsule.toml", {{}, {}, {"grid", "moller", "impulse"}}, liars());
}

inline void advance(Simulation& simulation, int steps) {
    for (int i = 0; i < steps; ++i) simulation.step();
}

// Some bodies of every shape with several rules: missiles that go when they hit, balls that only bounce (one of them a
// mesh, which its bounding sphere stands for), and bodies that turn.
inline Scene mixed_crowd() {
    Scene scene = gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 2, 2, 11);
    Scene bars =
        gas(make_mesh("bar", moved(u_bar(), Quat(0.6, 0, 0.8, 0).toRotationMatrix(), Vec3(5, 6, 7))), 1, 4, 12);
    scene.world.materials.push_back({"dull \"rubber\"", 0.3, 0.1, 700});
    const std::uint32_t bar = add_shape(scene, bars.world.shapes[0]), ball = add_shape(scene, make_sphere("ball", 0.3));
    const std::uint32_t floor = add_shape(scene, make_half_space("floor", Vec3(0.1, 1, 0.2), -2));
    const auto add = [&](std::uint32_t shape, const char* kind, const Vec3& position, const Vec3& velocity) {
        BodyDescription body;
        give(body, shape, position, velocity).kind = kind;
        body.name = std::string(kind) + " on the way";
        body.orientation = Quat(0.5, 0.5, -0.5, 0.5);
        body.material = 1;
        body.is_static = shape == floor;
        scene.world.add(body);
    };
    add(floor, "ground", Vec3::Zero(), Vec3::Zero());
    for (const double x : {-3.0, 3.0}) {
        add(ball, "missile", Vec3(x, 2.5, 0.1), Vec3(-2 * x, -1, 0));
        add(bar, "marble", Vec3(-5, x, -4), Vec3(3, 1, 4));
        add(ball, "marble", Vec3(5, x, 4), Vec3(-3, 1, -4));
        add(bar, "body", Vec3(4, x, -4), Vec3(-3, 1, 2));
    }
    scene.rooms[0] = room_of(7);
    scene.rooms[0].open[3] = true;
    scene.world.forces = {Vec3(0.1, -3, 0), Vec3(1, 0, 0), 0.01};
    scene.world.constant_force[1] = Vec3(0.25, 1, 0);
    scene.world.constant_torque[2] = Vec3(0, 0.1, 0);
    scene.pipeline.responses = {{stage("simple_bounce"), {"marble"}},
                                {stage("explode"), {"missile"}},
                                {stage("impulse", {{"max_impulses", std::int64_t(50)}}), {}}};
    scene.pipeline.broadphase = stage("grid", {{"cell_size", 1.7}});
    return scene;
}

}  // namespace kolize::test
