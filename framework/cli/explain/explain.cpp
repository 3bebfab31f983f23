// kolize explain: what a pipeline models of a scene, what it leaves out, which fact decided it, and what that saves.
#include "explain/features.h"

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <numeric>
#include <random>

namespace kolize::cli {
namespace {

struct ExplainOptions {
    std::string scene, pipeline;
    std::vector<std::string> set, plugin_path;
    RunLength length;
    int repeat = 9;
    bool check_minimal = false;
    int threads = 1;
    std::string json;
};

constexpr double default_time = 1;  // s
constexpr unsigned order_seed = 20261123;

// Of a step, ms: what doing it the other way costs more, and whether the state is the same at the end.
struct Saving {
    double median = 0, low = 0, high = 0;
    bool same_bits = false;
    std::string failure;  // why it cannot be run the other way
};

class Bench {
public:
    Bench(const ExplainOptions& options, const PluginLibrary& plugins, Host& host)
        : options_(options),
          plugins_(plugins),
          host_(host),
          scene_(load({})),
          steps_(options.length.count(scene_.pipeline.step.dt, default_time)) {}

    const Scene& scene() const { return scene_; }
    std::uint64_t steps() const { return steps_; }

    Scene load(const Settings& settings) const {
        Settings all = parse_settings(options_.set);
        all.insert(all.end(), settings.begin(), settings.end());
        return load_scene(options_.scene, {options_.pipeline, all, plugin_defaults()}, plugins_);
    }

    // Interleaved with the pipeline as it is; the interval holds the median with at least 95 % confidence where there
    // are nine repeats or more (order statistics).
    std::vector<std::optional<Saving>> measure(const std::vector<Feature>& features) const {
        std::vector<std::optional<Saving>> savings(features.size());
        std::vector<std::size_t> open;
        std::vector<Scene> scenes(features.size(), scene_);
        const std::uint64_t hash = run(scene_).state_hash;
        for (std::size_t i = 0; i < features.size(); ++i) {
            if (features[i].other.empty()) continue;
            Saving& saving = savings[i].emplace();
            try {
                scenes[i] = load(features[i].other);
                saving.same_bits = run(scenes[i]).state_hash == hash;
                open.push_back(i);
            } catch (const std::exception& e) {
                saving.failure = e.what();
            }
        }
        std::vector<std::vector<double>> more(features.size());
        std::mt19937 random(order_seed);
        Progress progress("explain", static_cast<std::uint64_t>(options_.repeat) * open.size());
        for (int round = 0; round < options_.repeat; ++round) {
            std::shuffle(open.begin(), open.end(), random);
            for (const std::size_t i : open) {
                const bool other_first = random() % 2;
                const double first = ms_a_step(other_first ? scenes[i] : scene_),
                             second = ms_a_step(other_first ? scene_ : scenes[i]);
                more[i].push_back(other_first ? first - second : second - first);
                progress.advance();
            }
        }
        for (const std::size_t i : open) fill(*savings[i], std::move(more[i]));
        return savings;
    }

private:
    RunResult run(const Scene& scene) const {
        Simulation simulation(scene, plugins_, host_, steps_);
        for (std::uint64_t i = 0; i < steps_; ++i) simulation.step();
        return simulation.result();
    }
    double ms_a_step(const Scene& scene) const { return 1e3 * run(scene).step.total_s / static_cast<double>(steps_); }

    static void fill(Saving& saving, std::vector<double> more) {
        std::sort(more.begin(), more.end());
        // Of n values the (k+1)-th smallest and largest, k = n/2 - sqrt(n).
        const double n = static_cast<double>(more.size());
        const auto k = static_cast<std::size_t>(std::max(0.0, std::floor(0.5 * n - 0.98 * std::sqrt(n))));
        saving.low = more[k];
        saving.high = more[more.size() - 1 - k];
        saving.median = median(std::move(more));
    }

    const ExplainOptions& options_;
    const PluginLibrary& plugins_;
    Host& host_;
    Scene scene_;
    std::uint64_t steps_;
};

std::string saving_text(const Feature& feature, const std::optional<Saving>& saving) {
    if (!saving) return "not measurable: there is no other way";
    if (!saving->failure.empty()) return "not measurable: " + saving->failure;
    const std::string interval =
        number(saving->median) + " ms a step (" + number(saving->low) + " to " + number(saving->high) + ")";
    const std::string bits = saving->same_bits ? ", the same bits" : ", another trajectory";
    const std::string how = " with " + label(feature.other);
    if (saving->low <= 0 && saving->high >= 0) return "no difference shown: " + interval + how + bits;
    return (saving->median > 0 ? "saves " : "costs ") + number(std::abs(saving->median)) + " ms a step (" +
           number(std::abs(saving->median > 0 ? saving->low : saving->high)) + " to " +
           number(std::abs(saving->median > 0 ? saving->high : saving->low)) + ") beside" + how.substr(5) + bits;
}

void print(const ExplainOptions& options, const Bench& bench, const std::vector<Feature>& features,
           const std::vector<std::optional<Saving>>& savings) {
    std::cout << options.scene << ", " << bench.steps() << " steps of " << bench.scene().pipeline.step.dt
              << " s, median of " << options.repeat << " interleaved runs and 95 % interval\n";
    for (const bool modelled : {true, false}) {
        std::cout << (modelled ? "\nModelled\n" : "\nLeft out\n");
        for (std::size_t i = 0; i < features.size(); ++i) {
            const Feature& f = features[i];
            if (f.modelled != modelled) continue;
            std::cout << "  " << f.name << "\n      because  " << f.because << "\n      time     "
                      << saving_text(f, savings[i]) << '\n';
            if (!f.wrong_when.empty()) std::cout << "      wrong    when " << f.wrong_when << '\n';
        }
    }
    for (const std::string& warning : bench.scene().warnings) std::cout << "\nnote: " << warning << '\n';
}

Json to_json(const std::vector<Feature>& features, const std::vector<std::optional<Saving>>& savings) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < features.size(); ++i) {
        const Feature& f = features[i];
        Json other = Json::object();
        for (const auto& [key, value] : f.other) other[key] = value;
        Json row{{"feature", f.name},
                 {"modelled", f.modelled},
                 {"because", f.because},
                 {"wrong_when", f.wrong_when},
                 {"other", other}};
        if (savings[i] && savings[i]->failure.empty())
            row["saving_ms"] = {{"median", savings[i]->median},
                                {"low", savings[i]->low},
                                {"high", savings[i]->high},
                                {"same_bits", savings[i]->same_bits}};
        rows.push_back(row);
    }
    return rows;
}

// Both side by side: is what is left out really of no consequence?
struct MinimalCheck {
    std::optional<std::uint64_t> parts_at;
    double minimal_s = 0, all_s = 0;
    std::vector<std::string> culprits;  // settings that alone change the trajectory
};

std::optional<std::uint64_t> first_difference(const Scene& a, const Scene& b, std::uint64_t steps,
                                              const PluginLibrary& plugins, Host& host, double& seconds_a,
                                              double& seconds_b) {
    Simulation one(a, plugins, host, steps), other(b, plugins, host, steps);
    std::optional<std::uint64_t> parts;
    Progress progress("check-minimal", steps);
    for (std::uint64_t i = 0; i < steps; ++i, progress.advance()) {
        one.step();
        other.step();
        if (!parts && one.state_hash() != other.state_hash()) parts = i;
    }
    seconds_a = one.result().step.total_s;
    seconds_b = other.result().step.total_s;
    return parts;
}

MinimalCheck check(const Bench& bench, const PluginLibrary& plugins, Host& host) {
    MinimalCheck result;
    result.parts_at = first_difference(bench.scene(), bench.load(all_modelled()), bench.steps(), plugins, host,
                                       result.minimal_s, result.all_s);
    if (!result.parts_at) return result;
    for (const auto& setting : all_modelled()) {
        double unused = 0;
        if (first_difference(bench.scene(), bench.load({setting}), bench.steps(), plugins, host, unused, unused))
            result.culprits.push_back(label({setting}));
    }
    return result;
}

int check_minimal(const ExplainOptions& options, const Bench& bench, const PluginLibrary& plugins, Host& host) {
    const MinimalCheck result = check(bench, plugins, host);
    const double dt = bench.scene().pipeline.step.dt;
    if (options.json != "-") {
        std::cout << options.scene << ", " << bench.steps() << " steps beside the same with " << label(all_modelled())
                  << '\n';
        if (!result.parts_at) {
            std::cout << "the same bits in all steps";
        } else {
            std::cout << "the two part in step " << *result.parts_at << " ("
                      << number(static_cast<double>(*result.parts_at) * dt) << " s)";
            for (const std::string& culprit : result.culprits) std::cout << "; so they do with " << culprit << " alone";
        }
        std::cout << "\ntime of all steps: " << number(result.minimal_s) << " s, with everything modelled "
                  << number(result.all_s) << " s\n";
    }
    if (!options.json.empty())
        write_json({{"scene", options.scene},
                    {"steps", bench.steps()},
                    {"same", !result.parts_at},
                    {"parts_at_step", result.parts_at ? Json(*result.parts_at) : Json()},
                    {"alone", result.culprits},
                    {"minimal_s", result.minimal_s},
                    {"all_s", result.all_s},
                    {"host", host_block()},
                    {"command", command_line()}},
                   options.json);
    return result.parts_at ? 1 : 0;
}

int explain(const ExplainOptions& options) {
    const PluginLibrary plugins = open_plugins(options.plugin_path, std::filesystem::path(options.scene).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    const Bench bench(options, plugins, *host);
    if (options.check_minimal) return check_minimal(options, bench, plugins, *host);
    Simulation simulation(bench.scene(), plugins, *host, bench.steps());
    for (std::uint64_t i = 0; i < bench.steps(); ++i) simulation.step();
    const std::vector<Feature> features = features_of(bench.scene(), simulation, plugins);
    const std::vector<std::optional<Saving>> savings = bench.measure(features);
    if (options.json != "-") print(options, bench, features, savings);
    if (!options.json.empty())
        write_json({{"scene", options.scene},
                    {"steps", bench.steps()},
                    {"repeat", options.repeat},
                    {"features", to_json(features, savings)},
                    {"warnings", bench.scene().warnings},
                    {"host", host_block()},
                    {"command", command_line()}},
                   options.json);
    return 0;
}

}  // namespace

void add_explain(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<ExplainOptions>();
    CLI::App* command =
        app.add_subcommand("explain", "Say what a pipeline models of a scene, what it leaves out, and what that saves");
    command->add_option("scene", options->scene, "Scene file (TOML)")->required();
    command->add_option("--pipeline", options->pipeline, "Pipeline file: replaces its tables");
    add_set_option(*command, options->set);
    add_length_options(*command, options->length);
    command->add_option("--repeat", options->repeat, "Runs each way")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_flag("--check-minimal", options->check_minimal,
                      "Run beside it the same with everything modelled, and compare the states after each step");
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    add_json_option(*command, options->json);
    command->footer(
        "Exit code 1 if --check-minimal finds a difference.\n"
        "Example: kolize explain scene.toml --time 2");
    command->callback([options, &exit_code] { exit_code = explain(*options); });
}

}  // namespace kolize::cli
