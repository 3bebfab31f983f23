#include "comparison.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <tuple>

namespace kolize::cli {
namespace {

constexpr std::uint64_t warm_up_steps = 5;

StageTime median_time(const std::vector<RunResult>& runs, StageTime RunResult::*stage) {
    const auto of = [&](double StageTime::*quantity) {
        std::vector<double> values;
        for (const RunResult& run : runs) values.push_back(run.*stage.*quantity);
        return median(std::move(values));
    };
    return {of(&StageTime::median_us), of(&StageTime::p95_us), of(&StageTime::total_s)};
}

RunResult summarize(const std::vector<RunResult>& runs) {
    RunResult summary = runs.front();
    for (StageTime RunResult::*stage : {&RunResult::integrate, &RunResult::broadphase, &RunResult::narrowphase,
                                        &RunResult::response, &RunResult::step})
        summary.*stage = median_time(runs, stage);
    return summary;
}

// All that a run gave and that no clock has to do with. Bits, so that NaN equals itself.
auto outcome(const RunResult& run) {
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
    return std::tuple(run.pairs, run.contacts, run.triangle_tests, run.events, run.unresolved, bits(run.energy_drift),
                      bits(run.momentum_drift), bits(run.angular_momentum_drift), bits(run.max_penetration_m),
                      run.escaped, run.stuck, run.state_hash);
}

bool same_outcome(const std::vector<RunResult>& runs) {
    return std::all_of(runs.begin(), runs.end(),
                       [&](const RunResult& run) { return outcome(run) == outcome(runs.front()); });
}

bool can_be_ranked(const Variant& variant) {
    const RunResult& result = variant.summary;
    return variant.repeatable && result.escaped == 0 && result.stuck == 0 && std::isfinite(result.energy_drift);
}

bool beats(const Variant& winner, const Variant& loser) {
    const double fast = winner.summary.step.median_us, slow = loser.summary.step.median_us;
    const auto drift = [](const Variant& v) { return std::max(v.summary.energy_drift, drift_floor); };
    return (fast < slow * (1 - time_noise) && drift(winner) <= drift(loser)) ||
           (fast <= slow && drift(winner) < drift(loser));
}

RunResult run_once(const Variant& variant, const PluginLibrary& plugins, Host& host) {
    Simulation simulation(variant.scene, plugins, host, variant.steps);
    for (std::uint64_t i = 0; i < variant.steps; ++i) simulation.step();
    return simulation.result();
}

}  // namespace

void warm_up(std::vector<Variant>& variants, const PluginLibrary& plugins, Host& host) {
    for (Variant& variant : variants) {
        Simulation simulation(variant.scene, plugins, host, warm_up_steps);
        variant.effective = pipeline_json(simulation);
    }
    for (const Variant& variant : variants) {
        Simulation simulation(variant.scene, plugins, host, warm_up_steps);
        for (std::uint64_t i = 0; i < std::min(variant.steps, warm_up_steps); ++i) simulation.step();
    }
}

void run_rounds(std::vector<Variant>& variants, int repeat, const PluginLibrary& plugins, Host& host) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < variants.size(); ++i) order.push_back(i);
    std::mt19937 random(order_seed);
    Progress progress("compare", variants.size() * static_cast<std::size_t>(repeat));
    for (int round = 0; round < repeat; ++round) {
        std::shuffle(order.begin(), order.end(), random);
        for (const std::size_t i : order) {
            variants[i].runs.push_back(run_once(variants[i], plugins, host));
            progress.advance();
        }
    }
    for (Variant& variant : variants) {
        variant.summary = summarize(variant.runs);
        variant.repeatable = same_outcome(variant.runs);
    }
}

void mark_front(std::vector<Variant>& variants) {
    for (Variant& variant : variants)
        variant.front = can_be_ranked(variant) && std::none_of(variants.begin(), variants.end(), [&](const Variant& v) {
                            return can_be_ranked(v) && beats(v, variant);
                        });
}

}  // namespace kolize::cli
