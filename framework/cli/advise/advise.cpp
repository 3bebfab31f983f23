// kolize advise: the cheapest pipeline for a scene that is accurate enough, or the most accurate that is cheap enough.
#include "advise/search.h"

#include <kolize/pipeline_file.h>

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>

namespace kolize::cli {
namespace {

struct AdviseOptions {
    std::string scene, pipeline;
    Limits limits;
    std::optional<std::uint64_t> missed, false_hits;
    std::vector<std::string> vary, set, plugin_path;
    std::optional<double> time;
    std::string judge = "exact";
    std::string output = "advised.toml";
    bool full = false;
    int threads = 1;
    std::string json;
};

constexpr double longest_default_time = 10;  // s
constexpr std::size_t most_rows = 12;        // of the table

// Narrowphase, stepping and length of the step, where the user varies none of these; the scene's own stay for the rest.
std::vector<Variation> variations(const AdviseOptions& options, const Scene& scene, const PluginLibrary& plugins) {
    std::vector<Variation> all = parse_variations(options.vary);
    const auto add = [&](const std::string& key, std::vector<std::string> values) {
        const auto same = [&](const Variation& v) { return v.key == key; };
        if (std::none_of(all.begin(), all.end(), same)) all.push_back({key, std::move(values)});
    };
    add("narrowphase.plugin", plugins.names(StageKind::narrowphase));
    add("step.mode", stepping_names());
    std::vector<std::string> steps;
    for (const double factor : {4.0, 2.0, 1.0, 0.5, 0.25, 0.125})
        steps.push_back(to_string(Value(factor * scene.pipeline.step.dt)));
    add("step.dt", steps);
    return all;
}

Question ask(const AdviseOptions& options, const PluginLibrary& plugins) {
    Question question;
    question.scene = options.scene;
    question.options = {options.pipeline, parse_settings(options.set), plugin_defaults()};
    question.limits = options.limits;
    const Scene scene = load_scene(options.scene, question.options, plugins);
    question.variations = variations(options, scene, plugins);
    question.time = options.time.value_or(std::min(scene.pipeline.step.time, longest_default_time));
    question.limits.missed = options.missed.value_or(0);
    question.limits.false_hits = options.false_hits.value_or(0);
    if (options.judge != "none") {
        plugins.require(StageKind::narrowphase, options.judge);
        question.judge = options.judge;
    }
    question.full = options.full;
    return question;
}

std::string limits_text(const Limits& limits) {
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (limits.budget_ms) add("at most " + number(*limits.budget_ms) + " ms");
    if (limits.drift) add("energy drift at most " + number(*limits.drift));
    if (limits.penetration) add("at most " + number(*limits.penetration) + " m deep");
    add("at most " + std::to_string(limits.missed) + " pairs missed and " + std::to_string(limits.false_hits) +
        " false hits");
    return text + ", nothing escaped or stuck";
}

// Those that keep the limits, the best first, then the cheapest of those that do not.
std::vector<std::size_t> rows_to_show(const Answer& answer, const Limits& limits) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < answer.candidates.size(); ++i)
        if (answer.candidates[i].known().failure.empty()) rows.push_back(i);
    const auto rank = [&](std::size_t i) {
        const Candidate& c = answer.candidates[i];
        return std::tuple(answer.chosen != i, !c.tried || !broken_limit(c.known(), limits).empty(), c.known().cost_ms);
    };
    std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    rows.resize(std::min(rows.size(), most_rows));
    if (answer.ten_times && std::find(rows.begin(), rows.end(), *answer.ten_times) == rows.end())
        rows.push_back(*answer.ten_times);
    return rows;
}

void print_candidates(const Question& question, const Answer& answer, double dt) {
    const bool judged = !question.judge.empty();
    Table table({"pipeline", "", "run", "ms per " + number(dt) + " s", "energy drift", "deepest m", "missed", "false",
                 "escaped", "stuck", "limits"});
    for (const std::size_t i : rows_to_show(answer, question.limits)) {
        const Candidate& candidate = answer.candidates[i];
        const Trial& trial = candidate.known();
        const std::string broken = broken_limit(trial, question.limits);
        table.add({label(candidate.settings),
                   answer.chosen == i      ? "*"
                   : answer.ten_times == i ? "x10"
                                           : "",
                   candidate.tried ? "whole" : "short", number(trial.cost_ms), number(trial.drift),
                   number(trial.penetration), judged ? std::to_string(trial.missed) : "-",
                   judged ? std::to_string(trial.false_hits) : "-", std::to_string(trial.escaped),
                   std::to_string(trial.stuck), broken.empty() ? "kept" : broken});
    }
    table.print(std::cout);
}

void print_broadphases(const Answer& answer) {
    Table table({"broadphase", "ms", ""});
    for (const BroadphaseTime& b : answer.broadphases)
        table.add({b.plugin, b.failure.empty() ? number(b.cost_ms) : "-", b.failure});
    table.print(std::cout);
}

// What the next factor of ten of accuracy costs.
std::string ten_times_text(const Answer& answer) {
    const Trial& chosen = answer.candidates[*answer.chosen].known();
    if (answer.by_penetration && chosen.penetration == 0)
        return "Its energy drift, " + number(chosen.drift) +
               ", is rounding and nothing overlaps: there is nothing more to buy.";
    const std::string rounding =
        answer.by_penetration ? "Its energy drift, " + number(chosen.drift) + ", is rounding. " : "";
    const std::string error = answer.by_penetration ? "deepest penetration" : "energy drift";
    if (!answer.ten_times) return rounding + "None of the pipelines tried has a tenth of its " + error + ".";
    const Candidate& better = answer.candidates[*answer.ten_times];
    const Trial& known = better.known();
    return rounding + "A tenth of its " + error + ", or less (" +
           (answer.by_penetration ? number(known.penetration) + " m" : number(known.drift)) + "), costs " +
           number(known.cost_ms / chosen.cost_ms) + " times as much: " + label(better.settings);
}

std::string full_text(const Answer& answer) {
    const Candidate& best = answer.candidates[*answer.best_of_full];
    const std::string of = "Of all " + std::to_string(answer.candidates.size()) + ", each run over the whole time, ";
    if (answer.best_of_full == answer.chosen) return of + "it is the best.";
    return of + "the best is " + label(best.settings) + " (drift " + number(best.tried->drift) +
           "); the one chosen takes " + number(answer.times_best) + " times as long, interleaved.";
}

void print_answer(const AdviseOptions& options, const Question& question, const Answer& answer, double dt) {
    std::cout << options.scene << ": " << answer.candidates.size() << " pipelines over " << question.time
              << " s; wanted: " << limits_text(question.limits) << "\n\n";
    print_candidates(question, answer, dt);
    if (!answer.chosen) {
        std::cout << "\nNone of them keeps the limits.\n";
        return;
    }
    std::cout << "\nIts broadphase is a matter of time alone (the whole step, medians of interleaved short runs):\n\n";
    print_broadphases(answer);
    std::cout << "\nChosen: " << label(answer.candidates[*answer.chosen].settings)
              << " broadphase.plugin=" << answer.pipeline.broadphase.plugin << "\n"
              << ten_times_text(answer) << '\n';
    if (answer.best_of_full) std::cout << full_text(answer) << '\n';
    std::cout << "Written to " << options.output << ": kolize run " << options.scene << " --pipeline " << options.output
              << '\n';
}

Json trial_json(const std::optional<Trial>& trial, bool judged) {
    if (!trial) return nullptr;
    if (!trial->failure.empty()) return {{"failure", trial->failure}};
    Json json{{"cost_ms", trial->cost_ms},
              {"energy_drift", trial->drift},
              {"escaped", trial->escaped},
              {"stuck", trial->stuck},
              {"state_hash", hex(trial->hash)}};
    json["max_penetration_m"] = trial->penetration;
    if (judged) json["missed"] = trial->missed, json["false_hits"] = trial->false_hits;
    return json;
}

Json answer_json(const AdviseOptions& options, const Question& question, const Answer& answer, double dt) {
    const bool judged = !question.judge.empty();
    Json rows = Json::array();
    for (const Candidate& candidate : answer.candidates) {
        Json settings = Json::object();
        for (const auto& [key, value] : candidate.settings) settings[key] = value;
        const std::string broken = broken_limit(candidate.known(), question.limits);
        rows.push_back({{"settings", settings},
                        {"screened", trial_json(candidate.screened, judged)},
                        {"tried", trial_json(candidate.tried, judged)},
                        {"breaks", broken.empty() ? Json() : Json(broken)}});
    }
    Json broadphases = Json::array();
    for (const BroadphaseTime& b : answer.broadphases)
        broadphases.push_back({{"plugin", b.plugin},
                               {"cost_ms", b.failure.empty() ? Json(b.cost_ms) : Json()},
                               {"failure", b.failure.empty() ? Json() : Json(b.failure)}});
    const auto index = [](const std::optional<std::size_t>& i) { return i ? Json(*i) : Json(); };
    const auto value = [](const auto& limit) { return limit ? Json(*limit) : Json(); };
    return {{"scene", options.scene},
            {"time", question.time},
            {"dt_of_cost", dt},
            {"limits",
             {{"budget_ms", value(question.limits.budget_ms)},
              {"max_drift", value(question.limits.drift)},
              {"max_penetration_m", value(question.limits.penetration)},
              {"max_missed", question.limits.missed},
              {"max_false_hits", question.limits.false_hits},
              {"judge", question.judge}}},
            {"candidates", rows},
            {"chosen", index(answer.chosen)},
            {"ten_times", index(answer.ten_times)},
            {"best_of_full", index(answer.best_of_full)},
            {"times_best", answer.best_of_full ? Json(answer.times_best) : Json()},
            {"broadphases", broadphases},
            {"output", answer.chosen ? Json(options.output) : Json()},
            {"host", host_block()},
            {"command", command_line()}};
}

std::string file_text(const Question& question, const Answer& answer, double dt) {
    const Trial& trial = answer.candidates[*answer.chosen].known();
    return "# " + command_line() + "\n# " + limits_text(question.limits) + "\n# measured over " +
           number(question.time) + " s: " + number(answer.chosen_cost_ms) + " ms for " + number(dt) +
           " s of simulated time, energy drift " + number(trial.drift) + "\n" + pipeline_text(answer.pipeline);
}

int advise(const AdviseOptions& options) {
    const Limits& limits = options.limits;
    if (!limits.budget_ms && !limits.drift && !limits.penetration && !options.missed)
        throw Error("advise wants to know what is wanted: --budget-ms, --max-drift, --max-penetration or --max-missed");
    const PluginLibrary plugins = open_plugins(options.plugin_path, std::filesystem::path(options.scene).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    const Question question = ask(options, plugins);
    const double dt = load_scene(options.scene, question.options, plugins).pipeline.step.dt;
    const Answer answer = search(question, plugins, *host);
    if (answer.chosen) write_text(file_text(question, answer, dt), options.output);
    if (options.json != "-") print_answer(options, question, answer, dt);
    if (!options.json.empty()) write_json(answer_json(options, question, answer, dt), options.json);
    return answer.chosen ? 0 : 1;
}

}  // namespace

void add_advise(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<AdviseOptions>();
    CLI::App* command = app.add_subcommand("advise", "Find the pipeline for a scene: cheap, accurate, or both");
    command->add_option("scene", options->scene, "Scene file (TOML)")->required();
    command->add_option("--pipeline", options->pipeline, "Pipeline file to begin with: replaces the scene's tables");
    command
        ->add_option("--budget-ms", options->limits.budget_ms,
                     "Most time for as much simulated time as the scene's step; the most accurate within it wins")
        ->check(CLI::PositiveNumber);
    command->add_option("--max-drift", options->limits.drift, "Largest drift of energy; the cheapest below it wins")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--max-penetration", options->limits.penetration, "Deepest penetration in m")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--max-missed", options->missed,
                        "Most overlapping pairs that the narrowphase may miss, by the judge; 0 if not given");
    command->add_option("--max-false", options->false_hits,
                        "Most pairs that it may report though they do not overlap; 0 if not given");
    command->add_option("--judge", options->judge, "Narrowphase that decides what overlaps, or none")
        ->capture_default_str();
    command
        ->add_option("--vary", options->vary,
                     "KEY=V1,V2,...: search these values too, or in place of the usual ones (repeatable)")
        ->allow_extra_args(false);
    add_set_option(*command, options->set);
    command->add_option("--time", options->time, "Simulated time in s")->check(CLI::PositiveNumber);
    command->add_flag("--full", options->full,
                      "Run every pipeline over the whole time, and compare the choice with that");
    command->add_option("--output", options->output, "Pipeline file to write")->capture_default_str();
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    add_json_option(*command, options->json);
    command->footer(
        "Searched are all narrowphases, all steppings and steps of 4 to 1/8 times the scene's; the broadphase is "
        "chosen last.\n"
        "Exit code 1 if no pipeline keeps the limits.\n"
        "Example: kolize advise scene.toml --max-drift 1e-6 --output cheap.toml");
    command->callback([options, &exit_code] { exit_code = advise(*options); });
}

}  // namespace kolize::cli
