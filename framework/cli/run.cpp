// kolize run: one scene through one pipeline.
#include "common.h"

#include <iostream>

namespace kolize::cli {
namespace {

struct RunOptions {
    std::string scene;
    std::string pipeline;
    std::vector<std::string> set;
    std::vector<std::string> plugin_path;
    RunLength length;
    int threads = all_cores();
    std::string json;
    std::string expect;
};

void print_stages(const RunResult& result) {
    Table table({"stage", "median us", "p95 us", "total s"});
    const auto row = [&](const char* name, const StageTime& time) {
        table.add({name, number(time.median_us), number(time.p95_us), number(time.total_s)});
    };
    row("integrate", result.integrate);
    row("broadphase", result.broadphase);
    row("narrowphase", result.narrowphase);
    row("response", result.response);
    row("step", result.step);
    table.print(std::cout);
}

void print_result(const RunResult& result) {
    std::cout << result.scene << ": " << result.bodies << " bodies, " << result.steps << " steps of " << result.dt
              << " s, " << result.threads << (result.threads == 1 ? " thread\n\n" : " threads\n\n");
    print_stages(result);
    std::cout << "\npairs " << result.pairs << ", contacts " << result.contacts << ", triangle tests "
              << result.triangle_tests << ", events " << result.events << ", unresolved " << result.unresolved
              << "\nenergy " << number(result.energy_initial_J, 6) << " J to " << number(result.energy_final_J, 6)
              << " J, drift of energy " << number(result.energy_drift) << ", momentum " << number(result.momentum_drift)
              << ", angular momentum " << number(result.angular_momentum_drift) << "\ndeepest penetration "
              << number(result.max_penetration_m) << " m, escaped " << result.escaped << ", stuck " << result.stuck
              << "\nstate hash " << hex(result.state_hash) << '\n';
}

int run_scene(const RunOptions& options, const PluginLibrary& plugins, Host& host) {
    const Scene scene =
        load_scene(options.scene, {options.pipeline, parse_settings(options.set), plugin_defaults()}, plugins);
    for (const std::string& warning : scene.warnings) host.warn(warning);
    const std::uint64_t steps = options.length.count(scene.pipeline.step.dt, scene.pipeline.step.time);
    Simulation simulation(scene, plugins, host, steps);
    {
        Progress progress("run", steps);
        for (std::uint64_t i = 0; i < steps; ++i, progress.advance()) simulation.step();
    }
    const RunResult result = simulation.result();
    if (options.json != "-") print_result(result);
    if (options.json.empty()) return 0;
    Json json = to_json(result, pipeline_json(simulation));
    json["host"] = host_block();
    json["command"] = command_line();
    write_json(json, options.json);
    return 0;
}

int run_expectations(const RunOptions& options, const PluginLibrary& plugins, Host& host) {
    Json entries = Json::array();
    bool all_hold = true;
    for (const Expectation& expectation : read_expectations(options.expect)) {
        const ExpectationOutcome outcome =
            run_expectation(expectation, options.scene, plugin_defaults(), plugins, host);
        const bool holds = outcome.failures.empty();
        all_hold = all_hold && holds;
        entries.push_back({{"what", outcome.what}, {"holds", holds}, {"failures", outcome.failures}});
        if (options.json == "-") continue;
        std::cout << (holds ? "holds   " : "broken  ") << outcome.what << '\n';
        for (const std::string& failure : outcome.failures) std::cout << "        " << failure << '\n';
    }
    if (!options.json.empty()) write_json({{"scene", options.scene}, {"expectations", entries}}, options.json);
    return all_hold ? 0 : 1;
}

int run(const RunOptions& options) {
    const PluginLibrary plugins = open_plugins(options.plugin_path, std::filesystem::path(options.scene).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    return options.expect.empty() ? run_scene(options, plugins, *host) : run_expectations(options, plugins, *host);
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<RunOptions>();
    CLI::App* command = app.add_subcommand("run", "Run a scene through its pipeline and measure it");
    command->add_option("scene", options->scene, "Scene file (TOML)")->required();
    CLI::Option* pipeline = command->add_option("--pipeline", options->pipeline, "Pipeline file: replaces its tables");
    add_set_option(*command, options->set);
    add_length_options(*command, options->length);
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    add_json_option(*command, options->json);
    CLI::Option* expect =
        command->add_option("--expect", options->expect, "Run the entries of this file and check their bounds instead");
    expect->excludes(pipeline)->excludes("--set")->excludes("--time")->excludes("--steps");
    command->footer("Example: kolize run scene.toml --pipeline fast.toml --set step.dt=0.002 --time 5 --json -");
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace kolize::cli
