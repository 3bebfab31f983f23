// kolize run: one scene through one pipeline.
#include "common.h"
#include "explain/features.h"
#include "explain/thickness.h"
#include "film/film.h"
#include "judge/judges.h"
#include "session.h"
#include "trace.h"
#include "workload/recorder.h"

#include <kolize/capsule.h>

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

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
    bool ledger = false, force_all = false;
    std::string capsule;
    std::optional<std::uint64_t> capsule_at;
    std::string trace;
    FilmOptions film;
    RecordOptions record;
    JudgeOptions judge;
    WorkloadOptions workload;
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

// What the stages chose or found out.
void print_reports(const Simulation& simulation) {
    std::vector<EffectiveStage> stages = simulation.responses();
    stages.insert(stages.begin(), {simulation.broadphase(), simulation.narrowphase()});
    for (const EffectiveStage& stage : stages)
        if (!stage.report.empty()) std::cout << stage.plugin << ": " << stage.report << '\n';
}

SceneOptions scene_options(const RunOptions& options) {
    Settings settings = parse_settings(options.set);
    if (options.ledger) settings.emplace_back("ledger.check", "true");
    if (options.force_all) {
        const Settings all = all_modelled();
        settings.insert(settings.end(), all.begin(), all.end());
    }
    return {options.pipeline, settings, plugin_defaults()};
}

// Returns the file: in the working directory and named after scene and step, where the user gave no name.
std::string write_capsule(const RunOptions& options, const Scene& capsule, const std::string& reason) {
    const std::string scene =
        std::filesystem::path(options.scene.empty() ? options.record.replay : options.scene).filename().string();
    const std::string file = !options.capsule.empty() ? options.capsule
                                                      : scene.substr(0, scene.find('.')) + ".step" +
                                                            std::to_string(*capsule.capsule_step) + ".capsule.toml";
    write_text(capsule_text(capsule, reason), file);
    return file;
}

// The sentence, and where the failed step was kept. The step that a capsule is of needs no second one.
std::string with_capsule(const std::string& sentence, const RunOptions& options, const Scene& scene,
                         const Simulation& simulation) {
    const Scene failed = simulation.capture_failure();
    const bool wanted =
        !options.capsule.empty() || (scene.pipeline.ledger.check && failed.capsule_step != scene.capsule_step);
    if (options.capsule_at || !wanted) return sentence;
    return sentence + "; capsule: " + write_capsule(options, failed, sentence);
}

void require_step(std::uint64_t wanted, std::uint64_t first, std::uint64_t count) {
    if (wanted < first || wanted - first >= count)
        throw Error("--capsule-at " + std::to_string(wanted) + ": there is no such step; the run has " +
                    std::to_string(count) + ", from step " + std::to_string(first));
}

// Tells once when a body begins to move so far in a step that it may pass through another unseen.
class LeapWarning {
public:
    explicit LeapWarning(Host& host) : host_(host) {}

    void look(const Simulation& simulation) {
        const StepConfig& step = simulation.step_config();
        if (has_warned_ || step.mode == "continuous") return;
        const double dt = step.dt / step.substeps;
        const World& world = simulation.world();
        if (!watch_ || !watch_->fits(world, dt)) watch_.emplace(world, dt);
        const Leap leap = watch_->largest(world);
        if (!(leap.share() > 1)) return;
        has_warned_ = true;
        host_.warn("from step " + std::to_string(simulation.step_number()) + " on body '" + world.name[leap.body] +
                   "' may pass through another one between two steps: they close " + number(leap.travel) +
                   " m in a step and are " + number(leap.room) + " m thick together; step.mode=" + step.mode +
                   " does not see that, step.mode=continuous does");
    }

private:
    Host& host_;
    std::optional<LeapWatch> watch_;
    bool has_warned_ = false;
};

// Returns what the ledger complains of, or "".
std::string advance(const RunOptions& options, Session& session, std::uint64_t count, std::optional<Film>& film,
                    Host& host) {
    const Scene& scene = session.scene();
    const Simulation& simulation = session.simulation();
    const std::uint64_t first = scene.capsule_step.value_or(0);
    if (options.capsule_at) require_step(*options.capsule_at, first, count);
    std::string complaint;
    Progress progress("run", count);
    if (film) film->look(simulation);
    LeapWarning leaps(host);
    leaps.look(simulation);
    for (std::uint64_t step = first; step < first + count; ++step, progress.advance()) {
        if (options.capsule_at == step) write_capsule(options, simulation.capture(), "asked for by --capsule-at");
        try {
            session.step();
        } catch (const std::exception& failure) {
            throw std::runtime_error(complaint.empty() ? with_capsule(failure.what(), options, scene, simulation)
                                                       : complaint + "; then " + failure.what());
        }
        leaps.look(simulation);
        if (film) film->look(simulation);
        if (complaint.empty() && simulation.first_break())
            complaint =
                with_capsule(to_string(*simulation.first_break(), simulation.world()), options, scene, simulation);
    }
    return complaint;
}

Json ledger_json(const Simulation& simulation) {
    const std::optional<LedgerBreak>& first = simulation.first_break();
    if (!first) return {{"broken", false}};
    return {{"broken", true},
            {"step", first->step},
            {"time", first->time},
            {"stage", first->stage},
            {"plugin", first->plugin},
            {"bodies", first->bodies},
            {"quantity", first->quantity},
            {"unit", first->unit},
            {"value", first->value},
            {"limit", first->limit},
            {"sentence", to_string(*first, simulation.world())}};
}

Json replay_json(const Session& session) {
    Json json = {{"steps", session.compared()}, {"same", !session.parting()}};
    if (session.parting()) json["parts_at_step"] = session.parting()->step;
    return json;
}

// Whoever looks on, where the user asked for it.
struct Onlookers {
    std::optional<Judges> judges;
    std::optional<WorkloadRecorder> workload;
    std::optional<Trace> trace;
};

void write_result(const RunOptions& options, const Session& session, const Onlookers& onlookers) {
    const Simulation& simulation = session.simulation();
    const RunResult result = simulation.result();
    if (options.json != "-") {
        print_result(result);
        print_reports(simulation);
        if (session.replays()) std::cout << replay_text(session) << '\n';
        if (onlookers.judges) onlookers.judges->print(std::cout << '\n');
        if (onlookers.workload) std::cout << onlookers.workload->summary() << '\n';
    }
    if (options.json.empty()) return;
    Json json = to_json(result, pipeline_json(simulation));
    if (session.scene().pipeline.ledger.check) json["ledger"] = ledger_json(simulation);
    if (session.replays()) json["replay"] = replay_json(session);
    if (onlookers.judges) json["judges"] = onlookers.judges->json();
    if (onlookers.workload) json["workload"] = onlookers.workload->json();
    json["host"] = host_block();
    json["command"] = command_line();
    write_json(json, options.json);
}

void watch(const RunOptions& options, Simulation& simulation, const PluginLibrary& plugins, Host& host,
           Onlookers& onlookers) {
    if (options.judge.wanted())
        simulation.watch(onlookers.judges.emplace(options.judge, simulation.pipeline(), plugins, host));
    if (!options.workload.folder.empty()) simulation.watch(onlookers.workload.emplace(options.workload, simulation));
    if (!options.trace.empty()) simulation.watch(onlookers.trace.emplace(options.trace, simulation));
}

int run_scene(const RunOptions& options, const PluginLibrary& plugins, Host& host) {
    Subject subject = load_subject(options.scene, options.record, scene_options(options), plugins);
    for (const std::string& warning : subject.scene.warnings) host.warn(warning);
    const std::uint64_t steps = count_steps(subject, options.length);
    const bool has_to_agree = subject.recording && !subject.own_pipeline;
    Session session(std::move(subject), plugins, host, steps);
    if (!options.record.record.empty()) session.record();
    if (!options.capsule.empty()) session.simulation().keep_steps();
    Onlookers onlookers;
    watch(options, session.simulation(), plugins, host, onlookers);
    std::optional<Film> film;
    if (options.film.wanted()) film.emplace(options.film, session.scene(), session.simulation(), plugins, host, steps);
    const std::string complaint = advance(options, session, steps, film, host);
    if (film) film->finish();
    if (onlookers.trace) onlookers.trace->finish();
    if (onlookers.workload) onlookers.workload->finish();
    if (!options.record.record.empty()) session.write_recording(options.record.record);
    write_result(options, session, onlookers);
    if (!complaint.empty()) std::cerr << "kolize: " << complaint << '\n';
    return complaint.empty() && !(has_to_agree && session.parting()) ? 0 : 1;
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
    command->add_option("scene", options->scene, "Scene file or capsule (TOML)");
    CLI::Option* pipeline = command->add_option("--pipeline", options->pipeline, "Pipeline file: replaces its tables");
    add_set_option(*command, options->set);
    add_length_options(*command, options->length);
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    add_json_option(*command, options->json);
    CLI::Option* expect =
        command->add_option("--expect", options->expect, "Run the entries of this file and check their bounds instead");
    CLI::Option* ledger =
        command->add_flag("--ledger", options->ledger,
                          "Check after every stage what it changed; the first break is told, and its step kept");
    CLI::Option* all = command->add_flag("--force-all", options->force_all,
                                         "Model everything that the pipeline leaves out: see kolize explain");
    CLI::Option* capsule = command->add_option("--capsule", options->capsule,
                                               "File to keep the first step in that fails or breaks the ledger");
    CLI::Option* capsule_at =
        command->add_option("--capsule-at", options->capsule_at, "Write the capsule of this step instead, and go on");
    CLI::Option* trace = command->add_option(
        "--trace", options->trace, "Write the calls of all stages as a Chrome trace (JSON): opens in Perfetto");
    add_film_options(*command, options->film);
    add_record_options(*command, options->record);
    add_judge_options(*command, options->judge);
    add_workload_options(*command, options->workload);
    command->get_option("--save-workload")->excludes("--replay");  // what is put in is no part of a workload
    expect->excludes("--save-workload")->excludes("--judge")->excludes("--disagreements");
    expect->excludes("--record")->excludes("--replay");
    expect->excludes(trace);
    expect->excludes("--frames")->excludes("--video");
    expect->excludes(pipeline)->excludes("--set")->excludes("--time")->excludes("--steps");
    expect->excludes(ledger)->excludes(all)->excludes(capsule)->excludes(capsule_at);
    command->footer("Example: kolize run scene.toml --pipeline fast.toml --set step.dt=0.002 --time 5 --json -");
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace kolize::cli
