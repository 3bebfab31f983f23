#include "engine.h"

#include <chrono>

namespace bench {
namespace {

using kolize::Error;
using kolize::Scene;
using kolize::World;

class KolizeEngine final : public Engine {
public:
    KolizeEngine(const Scene& scene, const Workshop& workshop, std::uint64_t steps)
        : simulation_(scene, workshop.plugins, workshop.host, steps) {}

    void step() override {
        const auto start = Clock::now();
        simulation_.step();
        spent_ += Clock::now() - start;
    }
    kolize::BodyState state(std::uint32_t body) const override { return simulation_.world().state(body); }
    void add_touching(std::vector<kolize::Pair>& pairs) const override {
        for (const kolize::Contact& contact : simulation_.contacts().rows) pairs.push_back({contact.a, contact.b});
    }
    // Without the sums over all bodies that measure drifts after each step: the others have none.
    double share() const override {
        return simulation_.result().step.total_s / std::chrono::duration<double>(spent_).count();
    }

private:
    using Clock = std::chrono::steady_clock;

    kolize::Simulation simulation_;
    Clock::duration spent_{};
};

}  // namespace

World world_with_walls(const Scene& scene, const Workshop& workshop) {
    return kolize::Simulation(scene, workshop.plugins, workshop.host, 1).world();
}

const kolize::Material& common_material(const World& world) {
    const auto differs = [&](const kolize::Material& one, const kolize::Material& other) {
        return one.restitution != other.restitution || one.friction != other.friction;
    };
    if (world.size() == 0) throw Error("a scene without bodies has nothing to compare");
    const kolize::Material& first = world.materials[world.material[0]];
    for (const std::uint32_t material : world.material)
        if (differs(first, world.materials[material]))
            throw Error("materials '" + first.name + "' and '" + world.materials[material].name +
                        "' differ in restitution or friction, which every engine combines in its own way; one "
                        "material for all bodies and rooms can be compared");
    return first;
}

namespace {

using Maker = std::unique_ptr<Engine> (*)(const World&, double dt);

const std::vector<std::pair<std::string, Maker>> rivals{
    {"bullet", [](const World& world, double dt) { return make_bullet(world, dt, {}); }},
    {"bullet_elastic", [](const World& world, double dt) { return make_bullet(world, dt, {.elastic = true}); }},
    {"bullet_swept", [](const World& world, double dt) { return make_bullet(world, dt, {.swept = true}); }},
    {"ode", [](const World& world, double dt) { return make_ode(world, dt, {}); }},
    {"ode_8", [](const World& world, double dt) { return make_ode(world, dt, {.contacts_per_pair = 8}); }},
    {"ode_elastic", [](const World& world, double dt) { return make_ode(world, dt, {.push = 0.01}); }}};

}  // namespace

const std::vector<std::string>& rival_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const auto& [name, make] : rivals) all.push_back(name);
        return all;
    }();
    return names;
}

std::string rival_versions() { return bullet_version() + ", " + ode_version(); }

std::unique_ptr<Engine> make_engine(const std::string& name, const Scene& scene, const Workshop& workshop,
                                    std::uint64_t steps) {
    for (const auto& [rival, make] : rivals)
        if (rival == name) return make(world_with_walls(scene, workshop), scene.pipeline.step.dt);
    return std::make_unique<KolizeEngine>(scene, workshop, steps);
}

}  // namespace bench
