#include <kolize/simulation.h>

#include "pipeline.h"
#include "stepping.h"

#include <bit>

namespace kolize {

namespace {

// What a step changes, as it was when the step began.
struct StepStart {
    std::uint64_t step = 0;
    std::vector<Vec3> position, velocity, angular_velocity;
    std::vector<Quat> orientation;
    std::vector<std::uint8_t> removed, asleep;
    std::vector<ResponseMemory> memory;

    void take(const Pipeline& pipeline) {
        const World& world = pipeline.world;
        step = pipeline.step_number();
        position = world.position;  // assignment re-uses the buffers
        velocity = world.velocity;
        angular_velocity = world.angular_velocity;
        orientation = world.orientation;
        removed = world.removed;
        asleep = world.asleep;
        pipeline.save_memory(memory);
    }
    void give(World& world) const {
        world.position = position;
        world.velocity = velocity;
        world.angular_velocity = angular_velocity;
        world.orientation = orientation;
        world.removed = removed;
        world.asleep = asleep;
    }
};

}  // namespace

struct Simulation::State {
    State(const Scene& scene, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps)
        : scene(scene),
          plugins(plugins),
          host(host),
          expected_steps(expected_steps),
          pipeline(scene, plugins, host, expected_steps),
          stepping(make_stepping(scene.pipeline.step)),
          keeps_steps(scene.pipeline.ledger.check) {
        start.take(pipeline);
    }

    const PipelineConfig& config() const { return scene.pipeline; }

    Scene scene;  // as it was given, with the pipeline in force
    const PluginLibrary& plugins;
    Host& host;
    std::uint64_t expected_steps;
    Pipeline pipeline;
    std::unique_ptr<Stepping> stepping;
    bool keeps_steps;
    StepStart start;
};

Simulation::Simulation(const Scene& scene, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps)
    : state_(std::make_unique<State>(scene, plugins, host, expected_steps)) {}

Simulation::~Simulation() = default;

void Simulation::step() {
    Pipeline& pipeline = state_->pipeline;
    const double dt = state_->config().step.dt;
    if (state_->keeps_steps && !first_break()) state_->start.take(pipeline);
    const std::uint64_t step = pipeline.step_number();
    pipeline.begin_step(dt);
    if (!pipeline.observers.empty()) pipeline.show([&](Observer& o) { o.step_begins(step, pipeline.world); });
    pipeline.take_time_shown();
    const auto start = StageClock::Clock::now();
    const int parts = state_->config().step.substeps;
    for (int part = 0; part < parts; ++part) state_->stepping->step(pipeline, dt / parts);
    const auto end = StageClock::Clock::now();
    pipeline.measure.clock.add(Phase::step, end - start - pipeline.take_time_shown());
    pipeline.end_step(dt);
    if (pipeline.observers.empty()) return;
    pipeline.show([&](Observer& o) {
        o.ended({"step", state_->config().step.mode.c_str(), start, end});
        o.step_ended(step, pipeline.world);
    });
}

void Simulation::apply(const Input& input) {
    if (const auto* other = std::get_if<PipelineInput>(&input)) return use(other->pipeline);
    std::visit(
        [&]<class T>(const T& one) {
            if constexpr (!std::is_same_v<T, PipelineInput>) state_->pipeline.put_in(one);
        },
        input);
}

void Simulation::use(const PipelineConfig& pipeline) {
    Scene scene = state_->scene;
    scene.pipeline = pipeline;
    scene.memory.clear();
    auto next = std::make_unique<State>(scene, state_->plugins, state_->host, state_->expected_steps);
    next->pipeline.take_over(state_->pipeline);
    next->keeps_steps |= state_->keeps_steps;
    next->pipeline.observers = state_->pipeline.observers;
    next->start.take(next->pipeline);
    state_ = std::move(next);
}

void Simulation::watch(Observer& observer) { state_->pipeline.observers.push_back(&observer); }

std::uint64_t Simulation::step_number() const { return state_->pipeline.step_number(); }

void Simulation::outline(Outline& outline) const { state_->pipeline.outline(outline); }

void Simulation::find_crossings(std::vector<CrossingLine>& crossings) const {
    state_->pipeline.find_crossings(crossings);
}

const World& Simulation::world() const { return state_->pipeline.world; }
const std::vector<Pair>& Simulation::pairs() const { return state_->pipeline.pairs; }
const Contacts& Simulation::contacts() const { return state_->pipeline.contacts; }
const std::vector<Event>& Simulation::events() const { return state_->pipeline.events; }
const StepConfig& Simulation::step_config() const { return state_->config().step; }
std::string Simulation::walls() const { return to_string(state_->pipeline.walls); }

RunResult Simulation::result() const {
    RunResult result;
    result.scene = state_->scene.file;
    result.dt = state_->config().step.dt;
    result.threads = state_->host.threads();
    state_->pipeline.measure.write(state_->pipeline.world, result);
    result.state_hash = state_hash();
    return result;
}

Reading Simulation::reading() const { return state_->pipeline.measure.reading(); }

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
        if (world.asleep[body]) hash.add(std::uint64_t(1));
        hash.add(std::uint64_t(world.removed[body]));
    }
    return hash.value();
}

namespace {

EffectiveStage effective(const LoadedPlugin& plugin, const Stage& stage, const std::vector<std::string>& kinds) {
    std::string when;
    for (const std::string& kind : kinds) when += (when.empty() ? "" : ",") + kind;
    return {plugin.descriptor->name, when, effective_settings(plugin, stage), stage.report()};
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

const std::optional<LedgerBreak>& Simulation::first_break() const {
    static const std::optional<LedgerBreak> none;
    return state_->pipeline.ledger ? state_->pipeline.ledger->first_break() : none;
}

void Simulation::keep_steps() { state_->keeps_steps = true; }

namespace {

StageConfig in_force(const EffectiveStage& stage) {
    StageConfig config{stage.plugin, {}, {}};
    for (const auto& [name, value] : stage.settings) config.settings[name] = {value, {}};
    return config;
}

}  // namespace

PipelineConfig Simulation::pipeline() const {
    PipelineConfig config = state_->config();
    config.broadphase = in_force(broadphase());
    config.narrowphase = in_force(narrowphase());
    const std::vector<EffectiveStage> stages = responses();
    for (std::size_t i = 0; i < stages.size(); ++i) config.responses[i].stage = in_force(stages[i]);
    return config;
}

Scene Simulation::capture() const {
    Scene scene;
    scene.file = state_->scene.file;
    scene.world = world();
    scene.rooms = state_->scene.rooms;
    scene.pipeline = pipeline();
    if (!scene.rooms.empty()) scene.pipeline.walls = walls();
    scene.capsule_step = step_number();
    scene.render = state_->scene.render;
    state_->pipeline.save_memory(scene.memory);
    return scene;
}

Scene Simulation::capture_failure() const {
    Scene scene = capture();
    state_->start.give(scene.world);
    scene.capsule_step = state_->start.step;
    scene.memory = state_->start.memory;
    return scene;
}

}  // namespace kolize
