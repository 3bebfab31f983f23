#include "bench.h"

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>

namespace kolize::cli {

bool names_plugin(const BenchOptions& options, StageKind stage) {
    const std::string key = std::string(to_string(stage)) + ".plugin";
    const auto names = [&](const std::string& argument) { return argument.starts_with(key + "="); };
    return std::any_of(options.vary.begin(), options.vary.end(), names) ||
           std::any_of(options.set.begin(), options.set.end(), names);
}

std::vector<PlannedVariant> plan_variants(const BenchOptions& options, StageKind stage,
                                          const std::string& default_plugin, const PluginLibrary& library) {
    const Settings fixed = parse_settings(options.set);
    const std::string word = to_string(stage);
    std::vector<Variation> variations = parse_variations(options.vary);
    if (!names_plugin(options, stage)) {
        variations.insert(variations.begin(), {word + ".plugin", library.names(stage)});
        if (variations.front().values.empty())
            throw Error("no " + word + " plugin was found (see kolize plugins list)");
    }
    std::vector<PlannedVariant> variants;
    for (const Settings& varied : combinations(variations)) {
        Settings all = fixed;
        all.insert(all.end(), varied.begin(), varied.end());
        const StageConfig config = stage_config(stage, all, default_plugin);
        variants.push_back({varied, config, &library.require(stage, config.plugin, config.where)});
    }
    return variants;
}

bool is_maker(const StageConfig& maker, const LoadedPlugin& plugin, const Stage& stage) {
    if (maker.plugin != plugin.descriptor->name) return false;
    const auto settings = effective_settings(plugin, stage);
    return std::all_of(settings.begin(), settings.end(), [&](const auto& setting) {
        const auto made = maker.settings.find(setting.first);
        return made != maker.settings.end() &&
               plugin.parameters.find(setting.first)->coerce(made->second.value) == setting.second;
    });
}

Json bench_json(const BenchOptions& options, StageKind stage) {
    return {{"stage", to_string(stage)},  {"workload", options.workload}, {"repeat", options.repeat},
            {"threads", options.threads}, {"host", host_block()},         {"command", command_line()}};
}

Json stage_json(const LoadedPlugin& plugin, const Stage& stage) {
    Json json{{"plugin", plugin.descriptor->name}};
    for (const auto& [name, value] : effective_settings(plugin, stage)) json[name] = to_json(value);
    return json;
}

namespace {

// A subcommand for one stage; the options of all are the same.
void add_stage(CLI::App& bench, StageKind stage, const std::string& what, const std::string& workload,
               int (*run)(const BenchOptions&), const std::string& footer, int& exit_code) {
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* command = bench.add_subcommand(to_string(stage), what);
    command->add_option("workload", options->workload, workload)->required();
    command->add_option("--vary", options->vary, "Values to compare (KEY=V1,V2,...; repeatable)")
        ->allow_extra_args(false);
    command->add_option("--repeat", options->repeat, "Timed rounds over the whole workload")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    add_set_option(*command, options->set);
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    add_json_option(*command, options->json);
    command->footer(footer);
    command->callback([options, run, &exit_code] { exit_code = run(*options); });
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
    CLI::App* bench = app.add_subcommand("bench", "Measure one stage alone on a recorded input");
    bench->require_subcommand(1);
    bench->footer("Example: kolize bench broadphase boxes.csv");
    add_stage(*bench, StageKind::broadphase, "Find the overlapping pairs of moving boxes",
              "CSV (frame,min_x,min_y,min_z,max_x,max_y,max_z; a row per box) or .npy [frames, boxes, 6]",
              bench_broadphase,
              "Without a choice of broadphase.plugin all that are found are compared.\n"
              "Example: kolize bench broadphase boxes.csv --vary broadphase.plugin=grid,bsp --json -",
              exit_code);
    add_stage(*bench, StageKind::narrowphase, "Find the contacts of a run, or test pairs of triangles",
              "Folder of run --save-workload, or CSV (a0x,a0y,a0z,a1x,...,b2z, and hit, 0 or 1, if the true answer is "
              "known; a row per pair)",
              bench_narrowphase,
              "Without a choice of narrowphase.plugin all that can take the workload are compared.\n"
              "Example: kolize bench narrowphase pairs.csv --vary narrowphase.plugin=moller,angle_sum --json -\n"
              "Example: kolize bench narrowphase folder --vary narrowphase.plugin=moller,fcl",
              exit_code);
    add_stage(*bench, StageKind::response, "Answer the contacts of a run", "Folder of kolize run --save-workload",
              bench_response,
              "Without a choice of response.plugin all that can take the workload are compared.\n"
              "Example: kolize bench response folder --vary response.plugin=impulse,solver --json -",
              exit_code);
}

}  // namespace kolize::cli
