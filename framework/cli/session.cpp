#include "session.h"

#include <CLI/CLI.hpp>

namespace kolize::cli {

void add_record_options(CLI::App& command, RecordOptions& options) {
    command.add_option("--record", options.record, "Keep all that is put in, and a hash of each step, in this file");
    command.add_option("--replay", options.replay, "Repeat a recording and compare the state after each step");
}

Subject load_subject(const std::string& scene, const RecordOptions& record, const SceneOptions& options,
                     const PluginLibrary& plugins) {
    if (scene.empty() && record.replay.empty()) throw Error("a scene file is wanted, or --replay with a recording");
    if (!scene.empty() && !record.replay.empty())
        throw Error("--replay has a scene of its own; leave " + scene + " out");
    if (record.replay.empty()) return {load_scene(scene, options, plugins), {}};
    Subject subject;
    subject.recording = load_recording(record.replay, options, plugins);
    subject.scene = subject.recording->start;
    subject.own_pipeline = !options.pipeline.empty() || !options.set.empty();
    return subject;
}

std::uint64_t count_steps(const Subject& subject, const RunLength& length) {
    const StepConfig& step = subject.scene.pipeline.step;
    if (!subject.recording) return length.count(step.dt, step.time);
    const std::uint64_t recorded = subject.recording->hashes.size();
    const std::uint64_t wanted = length.steps || length.time ? length.count(step.dt, 0) : recorded;
    if (wanted > recorded)
        throw Error("the recording has " + std::to_string(recorded) + " steps; asked for are " +
                    std::to_string(wanted));
    return wanted;
}

Session::Session(Subject subject, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps)
    : subject_(std::move(subject)), simulation_(subject_.scene, plugins, host, expected_steps) {}

void Session::record() {
    kept_.emplace();
    kept_->start = subject_.scene;
    kept_->start.pipeline = simulation_.pipeline();
}

void Session::put_in(const Input& input) {
    simulation_.apply(input);
    if (kept_) kept_->inputs.push_back({simulation_.step_number(), input});
}

void Session::step() {
    if (subject_.recording) put_in_recorded();
    simulation_.step();
    if (kept_) kept_->hashes.push_back(simulation_.state_hash());
    if (subject_.recording) compare();
}

void Session::put_in_recorded() {
    const std::vector<TimedInput>& inputs = subject_.recording->inputs;
    for (; next_input_ < inputs.size() && inputs[next_input_].step <= simulation_.step_number(); ++next_input_) {
        const Input& input = inputs[next_input_].input;
        if (!(subject_.own_pipeline && std::holds_alternative<PipelineInput>(input))) put_in(input);
    }
}

void Session::compare() {
    const std::vector<std::uint64_t>& hashes = subject_.recording->hashes;
    if (compared_ >= hashes.size()) return;
    const std::uint64_t recorded = hashes[compared_++];
    if (!parting_ && simulation_.state_hash() != recorded) parting_ = {simulation_.step_number() - 1};
}

void Session::write_recording(const std::filesystem::path& file) const { write_text(recording_text(*kept_), file); }

std::string replay_text(const Session& session) {
    if (const auto& parting = session.parting()) {
        const double dt = session.simulation().step_config().dt;
        return "replay: the two part at step " + std::to_string(parting->step) + " (" +
               number(static_cast<double>(parting->step) * dt, 6) + " s)";
    }
    return "replay: the same bits in all " + std::to_string(session.compared()) + " steps";
}

}  // namespace kolize::cli
