#include <kolize/simulation.h>

#include "pipeline.h"
#include "stepping.h"

#include <bit>

namespace kolize {

struct Simulation::State {
    State(const Scene& scene, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps)
        : file(scene.file),
          config(scene.pipeline),
          host(host),
          pipeline(scene, plugins, host, expected_steps),
          stepping(make_stepping(config.step)) {}

    std::string file;
    PipelineConfig config;
    Host& host;
    Pipeline pipeline;
    std::unique_ptr<Stepping> stepping;
};

Simulation::Simulation(const Scene& scene, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps)
    : state_(std::make_unique<State>(scene, plugins, host, expected_steps)) {}

Simulation::~Simulation() = default;

void Simulation::step() {
    Pipeline& pipeline = state_->pipeline;
    const double dt = state_->config.step.dt;
    pipeline.begin_step();
    const auto start = StageClock::Clock::now();
    state_->stepping->step(pipeline, dt);
    pipeline.measure.clock.add(Phase::step, StageClock::Clock::now() - start);
    pipeline.end_step(dt);
}

const World& Simulation::world() const { return state_->pipeline.world; }
const std::vector<Pair>& Simulation::pairs() const { return state_->pipeline.pairs; }
const Contacts& Simulation::contacts() const { return state_->pipeline.contacts; }
const std::vector<Event>& Simulation::events() const { return state_->pipeline.events; }
const StepConfig& Simulation::step_config() const { return state_->config.step; }
std::string Simulation::walls() const { return to_string(state_->pipeline.walls); }

RunResult Simulation::result() const {
    RunResult result;
    result.scene = state_->file;
    result.dt = state_->config.step.dt;
    result.threads = state_->host.threads();
    state_->pipeline.measure.write(state_->pipeline.world, result);
    result.state_hash = state_hash();
    return result;
}

namespace {

class Fnv1a {
public:
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(std::uint64_t word) {
        for (int byte = 0; byte < 8; ++byte) hash_ = (hash_ ^ ((word >> (8 * byte)) & 0xff)) * 1099511628211ull;
    }
    template <class Vector>
    void add_all(const Vector& v) {
        for (Eigen::Index i = 0; i < v.size(); ++i) add(static_cast<double>(v[i]));
    }
    std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 14695981039346656037ull;
};

}  // namespace

std::uint64_t Simulation::state_hash() const {
    const World& world = state_->pipeline.world;
    Fnv1a hash;
    for (std::size_t body = 0; body < world.size(); ++body) {
        hash.add_all(world.position[body]);
        hash.add_all(world.orientation[body].coeffs());
        hash.add_all(world.velocity[body]);
        hash.add_all(world.angular_velocity[body]);
        hash.add(std::uint64_t(world.removed[body]));
    }
    return hash.value();
}

namespace {

EffectiveStage effective(const LoadedPlugin& plugin, const Stage& stage, const std::vector<std::string>& kinds) {
    std::string when;
    for (const std::string& kind : kinds) when += (when.empty() ? "" : ",") + kind;
    return {plugin.descriptor->name, when, effective_settings(plugin, stage)};
}

}  // namespace

EffectiveStage Simulation::broadphase() const {
    return effective(*state_->pipeline.broadphase_plugin, *state_->pipeline.broadphase, {});
}

EffectiveStage Simulation::narrowphase() const {
    return effective(*state_->pipeline.narrowphase_plugin, *state_->pipeline.narrowphase, {});
}

std::vector<EffectiveStage> Simulation::responses() const {
    std::vector<EffectiveStage> all;
    for (const Rule& rule : state_->pipeline.rules) all.push_back(effective(*rule.plugin, *rule.stage, rule.kinds));
    return all;
}

}  // namespace kolize
