// kolize compare: what each of several pipelines costs in time and gives in accuracy on one scene.
#include "compare/report.h"

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <set>

namespace kolize::cli {
namespace {

constexpr double longest_default_time = 10;  // s

std::string label_of(const std::string& pipeline, const Settings& vary) {
    const std::string settings = label(vary);
    const std::string both = pipeline + (pipeline.empty() || settings.empty() ? "" : " ") + settings;
    return both.empty() ? "the scene's own" : both;
}

Variant make_variant(const CompareOptions& options, const std::string& scene, const std::string& pipeline,
                     const Settings& vary, const PluginLibrary& plugins) {
    Variant variant;
    variant.method = variant.label = label_of(pipeline, vary);
    if (options.scenes.size() > 1) variant.label = scene + ": " + variant.method;
    variant.scene_file = scene;
    variant.pipeline = pipeline;
    variant.vary = vary;
    Settings set = parse_settings(options.set);
    set.insert(set.end(), vary.begin(), vary.end());
    variant.scene = load_scene(scene, {pipeline, set, plugin_defaults()}, plugins);
    const StepConfig& step = variant.scene.pipeline.step;
    const double time = std::min(step.time, longest_default_time);
    variant.steps = options.length.count(step.dt, time);
    variant.time =
        options.length.steps ? static_cast<double>(variant.steps) * step.dt : options.length.time.value_or(time);
    return variant;
}

std::vector<Variant> make_variants(const CompareOptions& options, const PluginLibrary& plugins) {
    std::vector<std::string> pipelines = options.pipelines;
    if (pipelines.empty()) pipelines.emplace_back();
    std::vector<Variant> variants;
    for (const std::string& scene : options.scenes)
        for (const std::string& pipeline : pipelines)
            for (const Settings& vary : combinations(parse_variations(options.vary)))
                variants.push_back(make_variant(options, scene, pipeline, vary, plugins));
    return variants;
}

// A label, or a number from 1 on. Throws Error.
std::size_t find_baseline(const std::vector<Variant>& variants, const std::string& wanted) {
    if (wanted.empty()) return 0;
    for (std::size_t i = 0; i < variants.size(); ++i)
        if (wanted == variants[i].label || wanted == std::to_string(i + 1)) return i;
    std::string labels;
    for (const Variant& variant : variants) labels += (labels.empty() ? "'" : ", '") + variant.label + "'";
    throw Error("--baseline '" + wanted + "': there is no such row; there are " + labels);
}

Variant same_again(const Variant& baseline) {
    Variant again = baseline;
    again.label = "A/A: " + baseline.label + ", again";
    again.again = true;
    return again;
}

void write_report(const std::filesystem::path& folder, const Comparison& comparison) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error("folder '" + folder.string() + "' cannot be made: " + error.message());
    const Json json = comparison_json(comparison);
    write_text(comparison_text(comparison), folder / "compare.txt");
    write_text(comparison_csv(comparison), folder / "compare.csv");
    write_json(json, folder / "compare.json");
    write_text(comparison_html(comparison, json), folder / "compare.html");
}

Comparison measure(const CompareOptions& options) {
    const PluginLibrary plugins =
        open_plugins(options.plugin_path, std::filesystem::path(options.scenes.front()).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    Comparison comparison;
    comparison.options = options;
    comparison.variants = make_variants(options, plugins);
    comparison.baseline = find_baseline(comparison.variants, options.baseline);
    comparison.judge = options.judge.empty() && options.gates.missed ? "exact" : options.judge;
    if (!comparison.judge.empty()) plugins.require(StageKind::narrowphase, comparison.judge, {"--judge"});
    std::vector<Variant>& variants = comparison.variants;
    std::set<std::string> warnings;
    for (const Variant& variant : variants)
        warnings.insert(variant.scene.warnings.begin(), variant.scene.warnings.end());
    for (const std::string& warning : warnings) host->warn(warning);
    measure_errors(variants, comparison.judge, options.reference, plugins, *host);
    variants.push_back(same_again(variants[comparison.baseline]));
    comparison.plugins = plugin_files(variants, plugins);
    comparison.warnings = machine_warnings();
    comparison.warm_up_rounds = run_rounds(variants, options.repeat, plugins, *host);
    draw_conclusions(variants, comparison.baseline, options.gates);
    return comparison;
}

bool keeps_gates(const Comparison& comparison) {
    return std::all_of(comparison.variants.begin(), comparison.variants.end(),
                       [](const Variant& v) { return v.repeatable && (v.again || v.breaks.empty()); });
}

int compare(const CompareOptions& options) {
    if (options.scenes.empty()) throw Error("a scene file is wanted, or --rerun with a report");
    const Comparison comparison = measure(options);
    if (options.json != "-") std::cout << comparison_text(comparison);
    if (!options.json.empty()) write_json(comparison_json(comparison), options.json);
    if (!options.report.empty()) write_report(options.report, comparison);
    return keeps_gates(comparison) ? 0 : 1;
}

// The comparison of a report again: what no clock has to do with has to be the same bit for bit, and no ratio may lie
// outside of what both intervals allow.
int rerun(const std::filesystem::path& file) {
    const Json report = read_report(file);
    const Comparison again = measure(options_from(report, file));
    const std::vector<std::string> differences = compare_reports(report, comparison_json(again));
    std::cout << comparison_text(again) << '\n';
    for (const std::string& difference : differences) std::cout << "differs: " << difference << '\n';
    if (differences.empty())
        std::cout << "the same accuracy, bit for bit, and ratios within both intervals: " << file.string()
                  << " holds\n";
    return differences.empty() ? 0 : 1;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "Run a scene through several pipelines: time against accuracy");
    CLI::Option* scene =
        command->add_option("scene", options->scenes, "Scene files (TOML); of several each is compared by itself");
    command->add_option("--pipeline", options->pipelines, "Pipeline file, one variant each (repeatable)")
        ->allow_extra_args(false);
    command->add_option("--vary", options->vary, "KEY=V1,V2,...: all combinations are compared (repeatable)")
        ->allow_extra_args(false);
    add_set_option(*command, options->set);
    add_length_options(*command, options->length);
    command->add_option("--repeat", options->repeat, "Timed runs of each variant; 0: two seconds of each, 7 to 31 runs")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    command->add_option("--baseline", options->baseline, "Row that the others are held against: its label or number");
    command->add_option("--judge", options->judge, "Narrowphase that says what each narrowphase missed or made up");
    command
        ->add_option("--reference", options->reference,
                     "Path errors, against the first row with steps so many times shorter; 0: none")
        ->check(CLI::Range(0, 10000))
        ->capture_default_str();
    command->add_option("--budget-ms", options->gates.budget_ms, "Gate: median step in ms")->check(CLI::PositiveNumber);
    command->add_option("--max-drift", options->gates.drift, "Gate: drift of energy")->check(CLI::NonNegativeNumber);
    command->add_option("--max-missed", options->gates.missed, "Gate: overlapping pairs missed, by the judge (exact)");
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    command->add_option("--report", options->report,
                        "Write compare.html, compare.txt, compare.csv and compare.json to this folder");
    add_json_option(*command, options->json);
    const auto report = std::make_shared<std::string>();
    command->add_option("--rerun", *report, "Repeat the comparison of this compare.json: does it hold?")
        ->excludes(scene);
    command->footer(
        "Exit code 1 if a row breaks a gate, or does not give the same results in every run.\n"
        "Example: kolize compare scene.toml --vary broadphase.plugin=grid,brute_force --vary "
        "step.dt=0.004,0.002 --report out");
    command->callback(
        [options, report, &exit_code] { exit_code = report->empty() ? compare(*options) : rerun(*report); });
}

}  // namespace kolize::cli
