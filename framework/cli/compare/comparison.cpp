#include "compare/comparison.h"

#include <kolize/capsule.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <tuple>

namespace kolize::cli {
namespace {

constexpr std::size_t moments = 200;  // of a course
constexpr double seconds_each = 2;
constexpr int fewest_rounds = 7, most_rounds = 31, most_warm_up = 5;
constexpr double steady = 0.02;

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

// Of the scene as it begins, without the pipeline, and of how long it runs.
std::uint64_t question_of(const Variant& variant) {
    Scene scene = variant.scene;
    scene.pipeline = {};
    scene.capsule_step = 0;
    scene.memory.clear();
    std::uint64_t hash = 14695981039346656037ull;
    const auto add = [&](const std::string& text) {
        for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    };
    add(capsule_text(scene, ""));
    add(number(variant.time, 12));
    return hash;
}

// The places of all bodies at some moments.
struct Path {
    std::vector<double> time;
    std::vector<std::vector<Vec3>> places;
};

RunResult run(const Variant& variant, const PluginLibrary& plugins, Host& host) {
    Simulation simulation(variant.scene, plugins, host, variant.steps);
    for (std::uint64_t i = 0; i < variant.steps; ++i) simulation.step();
    return simulation.result();
}

bool is_moment(std::uint64_t step, std::uint64_t steps) {
    const std::uint64_t count = std::min<std::uint64_t>(moments, steps);
    return step * count / steps != (step - 1) * count / steps;
}

std::vector<Vec3> places_of(const World& world, std::size_t bodies) {
    std::vector<Vec3> places;
    for (std::uint32_t body = 0; body < bodies; ++body) places.push_back(world.position[body]);
    return places;
}

// Of all variants, in order.
std::vector<double> moments_of(const std::vector<const Variant*>& variants) {
    std::vector<double> times;
    for (const Variant* v : variants)
        for (std::uint64_t i = 1; i <= v->steps; ++i)
            if (is_moment(i, v->steps)) times.push_back(static_cast<double>(i) * v->scene.pipeline.step.dt);
    std::sort(times.begin(), times.end());
    return times;
}

// Of the scene's first variant with shorter steps; followed to every time of impact if its narrowphase can do that.
// Moments that lie between its steps are left out.
Path reference_path(const std::vector<const Variant*>& variants, int finer, const PluginLibrary& plugins, Host& host) {
    Scene scene = variants.front()->scene;
    StepConfig& step = scene.pipeline.step;
    const std::string& narrowphase = scene.pipeline.narrowphase.plugin;
    if (plugins.require(StageKind::narrowphase, narrowphase).descriptor->capabilities.time_of_impact)
        step.mode = "continuous";
    step.dt /= finer;
    const std::vector<double> wanted = moments_of(variants);
    const auto steps = static_cast<std::uint64_t>(std::llround(wanted.back() / step.dt));
    Simulation simulation(scene, plugins, host, steps);
    Path path;
    std::size_t next = 0;
    for (std::uint64_t i = 1; i <= steps; ++i) {
        simulation.step();
        const double time = static_cast<double>(i) * step.dt, near = 1e-6 * step.dt;
        while (next < wanted.size() && wanted[next] < time - near) ++next;
        if (next == wanted.size() || wanted[next] > time + near) continue;
        path.time.push_back(time);
        path.places.push_back(places_of(simulation.world(), scene.world.size()));
    }
    return path;
}

// Median radius of the bodies that move.
double body_size(const World& world) {
    std::vector<double> radii;
    for (std::uint32_t body = 0; body < world.size(); ++body)
        if (!world.is_static[body]) radii.push_back(world.shape_of(body).radius);
    return median(std::move(radii));
}

// Root of the mean square distance of the moving bodies, over the size of a body.
double distance(const World& world, const std::vector<Vec3>& a, const std::vector<Vec3>& b, double size) {
    double sum = 0, count = 0;
    for (std::uint32_t body = 0; body < a.size(); ++body)
        if (!world.is_static[body]) sum += (a[body] - b[body]).squaredNorm(), ++count;
    return count > 0 && size > 0 ? std::sqrt(sum / count) / size : 0;
}

void follow(Variant& variant, const Path* reference, const std::string& judge, const PluginLibrary& plugins,
            Host& host) {
    const World& world = variant.scene.world;
    const double size = body_size(world);
    Simulation simulation(variant.scene, plugins, host, variant.steps);
    variant.effective = pipeline_json(simulation);
    std::optional<Judges> judges;
    if (!judge.empty())
        simulation.watch(judges.emplace(JudgeOptions{.plugins = {judge}, .disagreements = {}}, variant.scene.pipeline,
                                        plugins, host));
    Course& course = variant.course;
    for (std::uint64_t i = 1; i <= variant.steps; ++i) {
        simulation.step();
        if (!is_moment(i, variant.steps)) continue;
        const double time = static_cast<double>(i) * variant.scene.pipeline.step.dt;
        course.time.push_back(time);
        course.energy_error.push_back(simulation.reading().energy_drift);
        if (!reference) continue;
        const auto at = std::min_element(reference->time.begin(), reference->time.end(),
                                         [&](double a, double b) { return std::abs(a - time) < std::abs(b - time); });
        if (std::abs(*at - time) <= 1e-9 * time)
            course.path_error.push_back(
                distance(world, places_of(simulation.world(), world.size()),
                         reference->places[static_cast<std::size_t>(at - reference->time.begin())], size));
        else
            course.path_error.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    course.energy_slope = theil_sen_slope(course.time, course.energy_error);
    if (judges) variant.judged = judges->verdicts().front();
}

std::vector<double> costs(const Variant& variant) {
    std::vector<double> all = variant.step_us();
    for (double& time : all) time /= variant.scene.pipeline.step.dt;
    return all;
}

// Faster is what a verdict calls so; with too few rounds for one, what is faster by more than the noise.
bool is_faster(const Variant& a, const Variant& b) {
    const Estimate ratio = paired_ratio(costs(a), costs(b));
    return std::isinf(ratio.high) ? a.cost_ms() < b.cost_ms() * (1 - time_noise) : ratio.high < 1;
}

bool beats(const Variant& winner, const Variant& loser) {
    if (winner.question != loser.question) return false;
    const auto drift = [](const Variant& v) { return std::max(v.summary.energy_drift, drift_floor); };
    return (is_faster(winner, loser) && drift(winner) <= drift(loser)) ||
           (!is_faster(loser, winner) && drift(winner) < drift(loser));
}

template <class TakesPart>
bool on_front(const std::vector<Variant>& variants, const Variant& variant, TakesPart&& takes_part) {
    return takes_part(variant) && std::none_of(variants.begin(), variants.end(), [&](const Variant& other) {
               return takes_part(other) && beats(other, variant);
           });
}

const Variant& baseline_of(const std::vector<Variant>& variants, const Variant& variant, const Variant& chosen) {
    return *std::find_if(variants.begin(), variants.end(), [&](const Variant& other) {
        return other.scene_file == variant.scene_file && other.method == chosen.method;
    });
}

std::vector<std::string> broken_gates(const Variant& variant, const Gates& gates) {
    std::vector<std::string> broken;
    const double ms = 1e-3 * variant.summary.step.median_us;
    if (gates.budget_ms && !(ms <= *gates.budget_ms))
        broken.push_back(number(ms) + " ms a step, above " + number(*gates.budget_ms));
    if (gates.drift && !(variant.summary.energy_drift <= *gates.drift))
        broken.push_back("energy drift " + number(variant.summary.energy_drift) + ", above " + number(*gates.drift));
    if (gates.missed && variant.judged && variant.judged->misses.count > *gates.missed)
        broken.push_back(std::to_string(variant.judged->misses.count) + " pairs missed, more than " +
                         std::to_string(*gates.missed));
    return broken;
}

}  // namespace

bool is_safe(const Variant& variant) {
    const RunResult& result = variant.summary;
    return variant.repeatable && result.escaped == 0 && result.stuck == 0 && std::isfinite(result.energy_drift) &&
           !(variant.judged && variant.judged->misses.count > 0);
}

std::vector<double> Variant::step_us() const {
    std::vector<double> times;
    for (const RunResult& run : runs) times.push_back(run.step.median_us);
    return times;
}

void measure_errors(std::vector<Variant>& variants, const std::string& judge, int finer, const PluginLibrary& plugins,
                    Host& host) {
    for (const Variant& variant : variants) Simulation(variant.scene, plugins, host, 1);
    Progress progress("compare: errors", variants.size());
    std::map<std::string, Path> references;  // by scene
    for (Variant& variant : variants) {
        if (finer > 0 && !references.contains(variant.scene_file)) {
            std::vector<const Variant*> same_scene;
            for (const Variant& other : variants)
                if (other.scene_file == variant.scene_file) same_scene.push_back(&other);
            references[variant.scene_file] = reference_path(same_scene, finer, plugins, host);
        }
        variant.question = question_of(variant);
        follow(variant, finer > 0 ? &references[variant.scene_file] : nullptr, judge, plugins, host);
        progress.advance();
    }
}

int run_rounds(std::vector<Variant>& variants, int repeat, const PluginLibrary& plugins, Host& host) {
    const auto time_once = [&](const Variant& variant) { return run(variant, plugins, host); };
    std::vector<double> warm;
    const auto is_steady = [&] {
        if (warm.size() < 3) return false;
        const auto [low, high] = std::minmax_element(warm.end() - 3, warm.end());
        return *high <= *low * (1 + steady);
    };
    double longest_s = 0;
    while (warm.size() < std::size_t(most_warm_up) && !is_steady()) {
        for (Variant& variant : variants) {
            const RunResult result = time_once(variant);
            longest_s = std::max(longest_s, result.step.total_s);
            if (&variant == &variants.front()) warm.push_back(result.step.median_us);
        }
    }
    if (repeat == 0)
        repeat = std::clamp(static_cast<int>(seconds_each / std::max(longest_s, 1e-3)), fewest_rounds, most_rounds);
    std::vector<std::size_t> order(variants.size());
    std::iota(order.begin(), order.end(), 0u);
    std::mt19937 random(order_seed);
    Progress progress("compare", variants.size() * static_cast<std::size_t>(repeat));
    for (int round = 0; round < repeat; ++round) {
        std::shuffle(order.begin(), order.end(), random);
        for (const std::size_t i : order) {
            variants[i].runs.push_back(time_once(variants[i]));
            progress.advance();
        }
    }
    for (Variant& variant : variants) {
        variant.summary = summarize(variant.runs);
        variant.repeatable = same_outcome(variant.runs);
        variant.step = median_estimate(variant.step_us());
    }
    return static_cast<int>(warm.size());
}

void draw_conclusions(std::vector<Variant>& variants, std::size_t baseline, const Gates& gates) {
    for (Variant& variant : variants) {
        const Variant& base = baseline_of(variants, variant, variants[baseline]);
        variant.ranked = variant.question == base.question;
        variant.ratio = paired_ratio(costs(variant), costs(base));
        variant.verdict = &variant == &base     ? "baseline"
                          : !variant.ranked     ? "not ranked: another question"
                          : !variant.repeatable ? "not ranked: results differ from run to run"
                                                : verdict(variant.ratio);
        variant.breaks = broken_gates(variant, gates);
    }
    const auto ranked = [](const Variant& v) { return v.ranked && v.repeatable && !v.again; };
    const auto safe = [&](const Variant& v) { return ranked(v) && is_safe(v); };
    for (Variant& variant : variants) {
        variant.front = on_front(variants, variant, ranked);
        variant.safe_front = on_front(variants, variant, safe);
    }
    for (Variant& variant : variants) {
        if (!ranked(variant) || variant.front || variant.safe_front) continue;
        // By one that is not beaten itself, where there is one: with noise, beating is not quite transitive.
        const Variant* by = nullptr;
        for (const Variant& other : variants)
            if (ranked(other) && (is_safe(other) || !is_safe(variant)) && beats(other, variant) &&
                (!by || (other.safe_front && !by->safe_front)))
                by = &other;
        if (by) variant.dominated_by = by->label;
    }
}

}  // namespace kolize::cli
