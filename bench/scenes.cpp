// bench_scenes: one scene in kolize, Bullet and ODE from the same states, one thread each: time per step, energy,
// escapes. How each is set up: docs/rivals.md.
#include "common.h"
#include "gauge.h"

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <time.h>

#include <algorithm>
#include <iostream>

namespace {

using bench::Engine;
using bench::Reading;
using kolize::Scene;
using kolize::cli::Json;
using kolize::cli::number;
using kolize::cli::Settings;

struct Options {
    std::string scene;
    std::string pipeline;
    std::vector<std::string> set, vary, plugin_path;
    std::vector<std::string> rivals{"bullet", "bullet_elastic", "ode", "ode_8", "ode_elastic"};
    double time = 10;  // simulated, s
    int repeat = 3;
    std::string json;
};

// An engine with a variant of the scene. Variants of the same problem are compared with each other.
struct Contestant {
    std::string engine;
    std::string label;
    Settings problem;
    Scene scene;
    std::uint64_t steps = 0;
    std::vector<double> milliseconds = {};  // per step, one a round
    Reading reading = {};

    double median_ms() const { return kolize::cli::median(milliseconds); }
};

// What of a variant is the same for every engine; the rest is kolize's way of computing it.
Settings problem_of(const Settings& vary) {
    Settings problem;
    for (const auto& entry : vary)
        if (entry.first == "step.dt" || entry.first == "narrowphase.walls" || entry.first.starts_with("world."))
            problem.push_back(entry);
    return problem;
}

Contestant make_contestant(const Options& options, const std::string& engine, const Settings& vary,
                           const kolize::PluginLibrary& plugins) {
    Settings set = kolize::cli::parse_settings(options.set);
    set.insert(set.end(), vary.begin(), vary.end());
    Scene scene = kolize::load_scene(options.scene, {options.pipeline, set, kolize::cli::plugin_defaults()}, plugins);
    const std::uint64_t steps = kolize::steps_in(options.time, scene.pipeline.step.dt);
    const std::string detail = kolize::cli::label(vary);
    return {engine, engine + (detail.empty() ? "" : " " + detail), problem_of(vary), std::move(scene), steps};
}

// Problem by problem in the order of --vary; of each problem kolize's variants first.
std::vector<Contestant> enter(const Options& options, const kolize::PluginLibrary& plugins) {
    const auto variants = kolize::cli::combinations(kolize::cli::parse_variations(options.vary));
    std::vector<Settings> problems;
    for (const Settings& vary : variants)
        if (std::find(problems.begin(), problems.end(), problem_of(vary)) == problems.end())
            problems.push_back(problem_of(vary));
    std::vector<Contestant> contestants;
    for (const Settings& problem : problems) {
        for (const Settings& vary : variants)
            if (problem_of(vary) == problem) contestants.push_back(make_contestant(options, "kolize", vary, plugins));
        for (const std::string& rival : options.rivals)
            contestants.push_back(make_contestant(options, rival, problem, plugins));
    }
    return contestants;
}

// Of this thread: on a machine that others use too, the time on a wall clock says more about them.
double cpu_seconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// One run from the start. Only the steps are timed; the bodies are looked at after each of them.
void run(Contestant& contestant, const bench::Workshop& workshop) {
    const double dt = contestant.scene.pipeline.step.dt;
    const auto engine = bench::make_engine(contestant.engine, contestant.scene, workshop, contestant.steps);
    bench::Gauge gauge(bench::world_with_walls(contestant.scene, workshop), contestant.scene.rooms);
    double seconds = 0;
    for (std::uint64_t i = 0; i < contestant.steps; ++i) {
        const double start = cpu_seconds();
        engine->step();
        seconds += cpu_seconds() - start;
        gauge.look(*engine, dt);
    }
    contestant.milliseconds.push_back(1e3 * seconds * engine->share() / static_cast<double>(contestant.steps));
    contestant.reading = gauge.reading();
}

// Of the first variant of kolize in the same problem.
double base_ms(const std::vector<Contestant>& contestants, const Contestant& contestant) {
    for (const Contestant& other : contestants)
        if (other.problem == contestant.problem && other.engine == "kolize") return other.median_ms();
    return 0;
}

void print_table(const std::vector<Contestant>& contestants) {
    std::cout << bench::rival_versions() << "\n\n";
    kolize::cli::Table table({"engine", "ms/step", "times kolize's", "energy error", "worst", "escaped", "stuck"});
    for (const Contestant& c : contestants)
        table.add({c.label, number(c.median_ms()), number(c.median_ms() / base_ms(contestants, c)),
                   number(c.reading.energy_error), number(c.reading.worst_energy_error),
                   std::to_string(c.reading.escaped), std::to_string(c.reading.stuck)});
    table.print(std::cout);
}

Json to_json(const std::vector<Contestant>& contestants, const Options& options) {
    Json rows = Json::array();
    for (const Contestant& c : contestants)
        rows.push_back({{"engine", c.engine},
                        {"label", c.label},
                        {"dt", c.scene.pipeline.step.dt},
                        {"steps", c.steps},
                        {"ms_per_step", c.median_ms()},
                        {"times_kolize", c.median_ms() / base_ms(contestants, c)},
                        {"energy_error", c.reading.energy_error},
                        {"worst_energy_error", c.reading.worst_energy_error},
                        {"escaped", c.reading.escaped},
                        {"stuck", c.reading.stuck}});
    return {{"scene", options.scene}, {"repeat", options.repeat},          {"rivals", bench::rival_versions()},
            {"rows", rows},           {"host", kolize::cli::host_block()}, {"command", kolize::cli::command_line()}};
}

void compare(const Options& options) {
    const auto plugins =
        kolize::cli::open_plugins(options.plugin_path, std::filesystem::path(options.scene).parent_path());
    const auto host = kolize::make_host(1);
    std::vector<Contestant> contestants = enter(options, plugins);
    kolize::cli::Progress progress("bench_scenes", contestants.size() * static_cast<std::size_t>(options.repeat));
    for (int round = 0; round < options.repeat; ++round)
        for (Contestant& contestant : contestants) {
            run(contestant, {plugins, *host});
            progress.advance();
        }
    if (options.json != "-") print_table(contestants);
    if (!options.json.empty()) kolize::cli::write_json(to_json(contestants, options), options.json);
}

void declare(CLI::App& app, Options& options) {
    app.add_option("scene", options.scene, "Scene file (TOML)")->required();
    app.add_option("--pipeline", options.pipeline, "Pipeline file: replaces the scene's tables");
    app.add_option("--vary", options.vary, "KEY=V1,V2,...: all combinations are run (repeatable)")
        ->allow_extra_args(false);
    kolize::cli::add_set_option(app, options.set);
    app.add_option("--rivals", options.rivals, "Other engines")
        ->delimiter(',')
        ->check(CLI::IsMember(bench::rival_names()))
        ->capture_default_str();
    app.add_option("--time", options.time, "Simulated time in s")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("--repeat", options.repeat, "Rounds of all engines in turn; times are medians over them")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    kolize::cli::add_plugin_path_option(app, options.plugin_path);
    kolize::cli::add_json_option(app, options.json);
    app.footer("Example: bench_scenes bench/scenes/cubes.toml --vary step.mode=discrete,bisection --repeat 5");
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("A scene in kolize, Bullet and ODE from the same states, one thread each.");
    Options options;
    declare(app, options);
    CLI11_PARSE(app, argc, argv);
    try {
        compare(options);
    } catch (const std::exception& error) {
        std::cerr << "bench_scenes: " << error.what() << '\n';
        return 2;
    }
}
