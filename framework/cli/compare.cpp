// kolize compare: what each of several pipelines costs in time and gives in accuracy on one scene.
#include "comparison.h"

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <set>
#include <sstream>

namespace kolize::cli {
namespace {

struct CompareOptions {
    std::string scene;
    std::vector<std::string> pipelines;
    std::vector<std::string> vary;
    std::vector<std::string> set;
    std::vector<std::string> plugin_path;
    RunLength length;
    int repeat = 3;
    int threads = 1;
    std::string report;
    std::string json;
};

constexpr double longest_default_time = 10;  // s

std::string label_of(const std::string& pipeline, const Settings& vary) {
    const std::string settings = label(vary);
    const std::string both = pipeline + (pipeline.empty() || settings.empty() ? "" : " ") + settings;
    return both.empty() ? "the scene's own" : both;
}

Variant make_variant(const CompareOptions& options, const std::string& pipeline, const Settings& vary,
                     const PluginLibrary& plugins) {
    Variant variant;
    variant.label = label_of(pipeline, vary);
    variant.pipeline = pipeline;
    variant.vary = vary;
    Settings set = parse_settings(options.set);
    set.insert(set.end(), vary.begin(), vary.end());
    variant.scene = load_scene(options.scene, {pipeline, set, plugin_defaults()}, plugins);
    const StepConfig& step = variant.scene.pipeline.step;
    variant.steps = options.length.count(step.dt, std::min(step.time, longest_default_time));
    return variant;
}

std::vector<Variant> make_variants(const CompareOptions& options, const PluginLibrary& plugins) {
    std::vector<std::string> pipelines = options.pipelines;
    if (pipelines.empty()) pipelines.emplace_back();
    std::vector<Variant> variants;
    for (const std::string& pipeline : pipelines)
        for (const Settings& vary : combinations(parse_variations(options.vary)))
            variants.push_back(make_variant(options, pipeline, vary, plugins));
    return variants;
}

void print_table(const std::vector<Variant>& variants, std::ostream& out) {
    Table table({"pipeline", "", "step us", "p95 us", "broad us", "narrow us", "resp us", "pairs", "contacts",
                 "energy drift", "mom. drift", "deepest m", "escaped", "stuck", "hash"});
    for (const Variant& variant : variants) {
        const RunResult& r = variant.summary;
        table.add({variant.label, variant.front ? "*" : "", number(r.step.median_us), number(r.step.p95_us),
                   number(r.broadphase.median_us), number(r.narrowphase.median_us), number(r.response.median_us),
                   std::to_string(r.pairs), std::to_string(r.contacts), number(r.energy_drift),
                   number(r.momentum_drift), number(r.max_penetration_m), std::to_string(r.escaped),
                   std::to_string(r.stuck), variant.repeatable ? hex(r.state_hash) : "DIFFERS"});
    }
    table.print(out);
}

void print_notes(const std::vector<Variant>& variants, std::ostream& out) {
    out << "\n* no other row is both faster (by more than " << 100 * time_noise
        << " % of a median step) and at least as accurate, or as fast and more accurate\n  (energy drift, equal below "
        << drift_floor
        << ").  Rows with escaped bodies or stuck pairs take no part. Times are medians over the repeats.\n";
    for (const Variant& variant : variants)
        if (!variant.repeatable)
            out << "\nNOT REPEATABLE: " << variant.label
                << " gave different results for the same input; none of its numbers can be trusted.\n";
}

std::string text_report(const std::vector<Variant>& variants, const CompareOptions& options) {
    std::ostringstream out;
    out << options.scene << ": " << variants.size() << " pipelines, " << options.repeat
        << " runs of each, interleaved with seed " << order_seed << ", " << options.threads
        << (options.threads == 1 ? " thread\n\n" : " threads\n\n");
    print_table(variants, out);
    print_notes(variants, out);
    return out.str();
}

Json variant_json(const Variant& variant) {
    Json vary = Json::object();
    for (const auto& [key, value] : variant.vary) vary[key] = value;
    Json json{{"label", variant.label}, {"pipeline_file", variant.pipeline}, {"vary", vary}};
    json.update(to_json(variant.summary, variant.effective));
    json["repeatable"] = variant.repeatable;
    json["front"] = variant.front;
    return json;
}

Json comparison_json(const std::vector<Variant>& variants, const CompareOptions& options) {
    Json rows = Json::array();
    for (const Variant& variant : variants) rows.push_back(variant_json(variant));
    return {{"scene", options.scene}, {"repeat", options.repeat}, {"order_seed", order_seed},
            {"variants", rows},       {"host", host_block()},     {"command", command_line()}};
}

std::string quoted(const std::string& text) {
    std::string cell = "\"";
    for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
    return cell + "\"";
}

// One row a variant, full precision.
std::string csv_report(const std::vector<Variant>& variants) {
    std::ostringstream out;
    out.precision(17);
    out << "pipeline,bodies,steps,dt,step_median_us,step_p95_us,integrate_median_us,broadphase_median_us,"
           "narrowphase_median_us,response_median_us,pairs,contacts,triangle_tests,energy_drift,momentum_drift,"
           "angular_momentum_drift,max_penetration_m,escaped,stuck,state_hash,repeatable,front\n";
    for (const Variant& variant : variants) {
        const RunResult& r = variant.summary;
        out << quoted(variant.label) << ',' << r.bodies << ',' << r.steps << ',' << r.dt << ',' << r.step.median_us
            << ',' << r.step.p95_us << ',' << r.integrate.median_us << ',' << r.broadphase.median_us << ','
            << r.narrowphase.median_us << ',' << r.response.median_us << ',' << r.pairs << ',' << r.contacts << ','
            << r.triangle_tests << ',' << r.energy_drift << ',' << r.momentum_drift << ',' << r.angular_momentum_drift
            << ',' << r.max_penetration_m << ',' << r.escaped << ',' << r.stuck << ',' << hex(r.state_hash) << ','
            << variant.repeatable << ',' << variant.front << '\n';
    }
    return out.str();
}

void write_report(const std::filesystem::path& folder, const std::string& text, const std::string& csv,
                  const Json& json) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error("folder '" + folder.string() + "' cannot be made: " + error.message());
    write_text(text, folder / "compare.txt");
    write_text(csv, folder / "compare.csv");
    write_json(json, folder / "compare.json");
}

int compare(const CompareOptions& options) {
    const PluginLibrary plugins = open_plugins(options.plugin_path, std::filesystem::path(options.scene).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    std::vector<Variant> variants = make_variants(options, plugins);
    std::set<std::string> warnings;
    for (const Variant& variant : variants)
        warnings.insert(variant.scene.warnings.begin(), variant.scene.warnings.end());
    for (const std::string& warning : warnings) host->warn(warning);
    warm_up(variants, plugins, *host);
    run_rounds(variants, options.repeat, plugins, *host);
    mark_front(variants);

    const std::string text = text_report(variants, options);
    const Json json = comparison_json(variants, options);
    if (options.json != "-") std::cout << text;
    if (!options.json.empty()) write_json(json, options.json);
    if (!options.report.empty()) write_report(options.report, text, csv_report(variants), json);
    return std::all_of(variants.begin(), variants.end(), [](const Variant& v) { return v.repeatable; }) ? 0 : 1;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "Run a scene through several pipelines: time against accuracy");
    command->add_option("scene", options->scene, "Scene file (TOML)")->required();
    command->add_option("--pipeline", options->pipelines, "Pipeline file, one variant each (repeatable)")
        ->allow_extra_args(false);
    command->add_option("--vary", options->vary, "KEY=V1,V2,...: all combinations are compared (repeatable)")
        ->allow_extra_args(false);
    add_set_option(*command, options->set);
    add_length_options(*command, options->length);
    command->add_option("--repeat", options->repeat, "Runs of each variant")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    command->add_option("--report", options->report, "Write compare.txt, compare.csv and compare.json to this folder");
    add_json_option(*command, options->json);
    command->footer(
        "Example: kolize compare scene.toml --vary broadphase.plugin=grid,brute_force --vary "
        "step.dt=0.004,0.002 --repeat 5 --report out");
    command->callback([options, &exit_code] { exit_code = compare(*options); });
}

}  // namespace kolize::cli
