// A simulation with all that is put into it: every input goes through here, so that it can be recorded and played
// again.
#pragma once

#include "common.h"

#include <kolize/recording.h>

namespace kolize::cli {

// Of --record and --replay.
struct RecordOptions {
    std::string record;  // file, or ""
    std::string replay;
};
void add_record_options(CLI::App& command, RecordOptions& options);

// What is run: a scene, or the one that a recording began with.
struct Subject {
    Scene scene;
    std::optional<Recording> recording;
    bool own_pipeline = false;  // not the recorded one
};

// Throws Error for files that cannot be read, or if neither or both of `scene` and the recording are given.
Subject load_subject(const std::string& scene, const RecordOptions& record, const SceneOptions& options,
                     const PluginLibrary& plugins);
// Steps to take; of a recording all, if not told otherwise. Throws Error for more than it has.
std::uint64_t count_steps(const Subject& subject, const RunLength& length);

// Where a run left the one that it repeats.
struct Parting {
    std::uint64_t step = 0;  // the first one that ends in another state
};

class Session {
public:
    // `expected_steps` as for Simulation. Throws what its constructor throws. Where the subject is a recording its
    // inputs are put in before their steps, and the states compared with its own; with a pipeline of the user's own,
    // that one stays where the recording switches.
    Session(Subject subject, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps);

    Simulation& simulation() { return simulation_; }
    const Simulation& simulation() const { return simulation_; }
    const Scene& scene() const { return subject_.scene; }
    bool replays() const { return subject_.recording.has_value(); }

    // From now on inputs and states are kept for write_recording. To be called before the first step.
    void record();

    // Before the next step. Throws what Simulation::apply throws.
    void put_in(const Input& input);
    void step();

    // Writes the file or nothing. Throws Error.
    void write_recording(const std::filesystem::path& file) const;
    // Of a replay: nothing as long as the states are the same.
    const std::optional<Parting>& parting() const { return parting_; }
    std::uint64_t compared() const { return compared_; }  // steps of the replay so far

private:
    void put_in_recorded();
    void compare();

    Subject subject_;
    Simulation simulation_;
    std::optional<Recording> kept_;
    std::size_t next_input_ = 0;
    std::uint64_t compared_ = 0;
    std::optional<Parting> parting_;
};

// "replay: the same bits in all 240 steps", or where the two part.
std::string replay_text(const Session& session);

}  // namespace kolize::cli
