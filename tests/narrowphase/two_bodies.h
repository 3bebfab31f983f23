// Two bodies and one narrowphase plugin: what most tests of contacts need.
#pragma once

#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

namespace kolize::test {

inline const PluginLibrary& library() {
    static const PluginLibrary plugins({KOLIZE_PLUGIN_DIR});
    return plugins;
}

struct Placed {
    Shape shape;
    Vec3 position = Vec3::Zero();  // of the model frame
    Quat orientation = Quat::Identity();
    bool is_static = false;
};

inline World world_of(const Placed& a, const Placed& b) {
    World world;
    world.materials.emplace_back();
    for (const Placed* placed : {&a, &b}) {
        BodyDescription body;
        body.shape = static_cast<std::uint32_t>(world.shapes.size());
        world.shapes.push_back(placed->shape);
        body.position = placed->position;
        body.orientation = placed->orientation;
        body.is_static = placed->is_static;
        body.mass = 1;
        world.add(body);
    }
    return world;
}

class NarrowphaseUnderTest {
public:
    explicit NarrowphaseUnderTest(const std::string& plugin, std::map<std::string, Value> settings = {})
        : host_(make_host(1)), stage_(library().make<Narrowphase>(config(plugin, settings), *host_)) {}

    // All contacts of the two bodies of the world.
    Contacts collide(const World& world, Detail detail = Detail::manifold) {
        stage_->prepare(world);
        const Pair pair{0, 1};
        Contacts contacts;
        stage_->find_contacts({world, {&pair, 1}, {&detail, 1}}, contacts);
        return contacts;
    }
    Contacts collide(const Placed& a, const Placed& b, Detail detail = Detail::manifold) {
        return collide(world_of(a, b), detail);
    }

private:
    static StageConfig config(const std::string& plugin, const std::map<std::string, Value>& settings) {
        StageConfig stage;
        stage.plugin = plugin;
        for (const auto& [key, value] : settings) stage.settings[key] = {value, {}};
        return stage;
    }

    std::unique_ptr<Host> host_;
    StagePtr<Narrowphase> stage_;
};

// Contact point in the world frame.
inline Vec3 point_of(const World& world, const Contact& contact) { return world.position[contact.a] + contact.arm_a; }

}  // namespace kolize::test
