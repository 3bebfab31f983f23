// Small scenes made in code, for tests of the whole ring.
#pragma once

#include <kolize/simulation.h>

#include <random>

namespace kolize::test {

inline const PluginLibrary& plugins() {
    static const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    return library;
}

inline StageConfig stage(const std::string& plugin, const std::map<std::string, Value>& settings = {}) {
    StageConfig config{plugin, {"scene.toml", 3, 10}, {}};
    for (const auto& [key, value] : settings) config.settings[key] = {value, {"scene.toml", 4, 1}};
    return config;
}

inline Scene empty_scene() {
    Scene scene;
    scene.file = "scene.toml";
    scene.world.materials.emplace_back();
    scene.pipeline.broadphase = stage("brute_force");
    scene.pipeline.narrowphase = stage("moller");
    scene.pipeline.responses = {{stage("impulse"), {}}};
    return scene;
}

inline std::uint32_t add_shape(Scene& scene, const Shape& shape) {
    scene.world.shapes.push_back(shape);
    return static_cast<std::uint32_t>(scene.world.shapes.size() - 1);
}

inline BodyDescription& give(BodyDescription& body, std::uint32_t shape, const Vec3& position, const Vec3& velocity) {
    body.shape = shape;
    body.mass = 1;
    body.position = position;
    body.velocity = velocity;
    return body;
}

inline Room room_of(double half) {
    Room room;
    room.min = Vec3::Constant(-half);
    room.max = Vec3::Constant(half);
    room.thickness = 1;
    return room;
}

// n^3 bodies of one shape on a lattice in a closed room, with random velocities and spins.
inline Scene gas(const Shape& shape, int n, double spacing, unsigned seed) {
    Scene scene = empty_scene();
    const std::uint32_t id = add_shape(scene, shape);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> speed(-3, 3);
    const auto vector = [&] { return Vec3(speed(random), speed(random), speed(random)); };
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < n; ++z) {
                BodyDescription body;
                give(body, id, spacing * (Vec3(x, y, z) - Vec3::Constant(0.5 * (n - 1))), vector());
                body.angular_velocity = vector();
                scene.world.add(body);
            }
    scene.rooms.push_back(room_of(0.5 * spacing * n + 0.2));
    return scene;
}

inline RunResult run(const Scene& scene, std::uint64_t steps, int threads = 1) {
    const auto host = make_host(threads);
    Simulation simulation(scene, plugins(), *host, steps);
    for (std::uint64_t i = 0; i < steps; ++i) simulation.step();
    return simulation.result();
}

}  // namespace kolize::test
