// One scene run through one pipeline: the ring integrate -> broadphase -> narrowphase -> response, measured.
#pragma once

#include <kolize/input.h>
#include <kolize/integrator.h>
#include <kolize/mesh_narrowphase.h>
#include <kolize/scene.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kolize {

// Host with oneTBB threads and the spdlog log. threads >= 1.
KOLIZE_API std::unique_ptr<Host> make_host(int threads);

struct StageTime {
    double median_us = 0;  // per step
    double p95_us = 0;
    double total_s = 0;
};

// What a run gave: the numbers of `run --json`. Formulas in docs/accuracy.md.
struct RunResult {
    std::string scene;
    std::uint64_t bodies = 0;
    std::uint64_t steps = 0;
    double dt = 0;    // s
    double time = 0;  // simulated, s
    int threads = 1;
    StageTime integrate, broadphase, narrowphase, response, step;
    std::uint64_t pairs = 0, contacts = 0, triangle_tests = 0, events = 0, unresolved = 0, failures = 0;
    double energy_initial_J = 0, energy_final_J = 0, energy_drift = 0, momentum_drift = 0, angular_momentum_drift = 0;
    double max_penetration_m = 0;
    std::uint64_t escaped = 0, stuck = 0;
    std::uint64_t state_hash = 0;
};

// What can be read after every step at no cost.
struct Reading {
    double integrate_us = 0, broadphase_us = 0, narrowphase_us = 0, response_us = 0, step_us = 0;  // of the last step
    double energy_J = 0;
    double energy_drift = 0, momentum_drift = 0, angular_momentum_drift = 0;  // largest so far, as in RunResult
};

// A stage of the running pipeline as it is in force, for the echo in results.
struct EffectiveStage {
    std::string plugin;
    std::string when;  // response rules: "missile", "ball,ball", or "" for every contact
    std::vector<std::pair<std::string, Value>> settings;
    std::string report;  // see Stage::report
};

// What a stage did that it may not do: the first entry of the ledger that does not balance.
struct LedgerBreak {
    std::uint64_t step = 0;
    double time = 0;                    // simulated, s, at which the step began
    std::string stage;                  // "integrator", "broadphase", "narrowphase", "response", "stepping"
    std::string plugin;                 // or the integrator's or the stepping's name
    std::vector<std::uint32_t> bodies;  // a body, or the pair
    std::string quantity;               // "energy", "momentum", "position", ...
    std::string unit;
    double value = 0;  // by how much it is off
    double limit = 0;
};

// One sentence with all of it.
KOLIZE_API std::string to_string(const LedgerBreak& broken, const World& world);

class Observer;

class KOLIZE_API Simulation {
public:
    // Makes the stages and negotiates: throws Error, before any step, in a sentence that names a plugin that would do,
    // if a response needs more than the narrowphase gives or a shape is not taken. `expected_steps` sizes the sample
    // buffers. Plugins and host have to outlive the simulation.
    Simulation(const Scene& scene, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps);
    ~Simulation();

    // Advances by one dt. A failing stage throws std::runtime_error that names stage, plugin, step and the pair.
    void step();

    // Between two steps. Throws std::invalid_argument for a body that is not there or is static, or for what is not
    // finite, and what the constructor throws for a pipeline; the simulation then goes on as if nothing had been asked.
    void apply(const Input& input);
    // Shows everything from the next step on, also in another pipeline that is put in. It has to outlive the
    // simulation.
    void watch(Observer& observer);
    // Of the step that comes next, from the beginning of the run; a capsule's run begins later.
    std::uint64_t step_number() const;

    // The ledger's first complaint so far; none where [ledger] is off. The run goes on after it.
    const std::optional<LedgerBreak>& first_break() const;
    // From now on the state at the beginning of each step is kept for capture_failure(). A ledger does so by itself.
    void keep_steps();
    // The scene as it stands, for capsule_text: a simulation made from it goes on to the same bits.
    Scene capture() const;
    // The same for the beginning of the step with the first break, or else of the last step, failed or not.
    Scene capture_failure() const;

    const World& world() const;
    const std::vector<Pair>& pairs() const;    // of the last step, canonical order, body ids
    const Contacts& contacts() const;          // of the last step (bisection, continuous: of its last impact)
    const std::vector<Event>& events() const;  // of the last step
    RunResult result() const;
    Reading reading() const;
    std::uint64_t state_hash() const;  // FNV-1a over the bits of all bodies' state
    EffectiveStage broadphase() const;
    EffectiveStage narrowphase() const;
    std::vector<EffectiveStage> responses() const;
    const StepConfig& step_config() const;
    PipelineConfig pipeline() const;  // with all parameters in force
    std::string walls() const;        // what rooms were made of: half_space, box or mesh

    // For whoever looks on; nothing is computed for these unless they are called. Nothing where the plugin has no such
    // capability.
    void outline(Outline& outline) const;  // of the broadphase, for the boxes of the last step
    void find_crossings(std::vector<CrossingLine>& crossings) const;  // of the last step's pairs, at the present poses

private:
    void use(const PipelineConfig& pipeline);

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kolize
