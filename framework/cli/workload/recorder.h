// Keeps the real inputs of the stages of a run, for `kolize bench`.
#pragma once

#include "calls.h"
#include "npy_writer.h"

#include "common.h"

#include <kolize/observer.h>

#include <fstream>
#include <sstream>

namespace kolize::cli {

// FROM:TO:EVERY, of steps; each part may be left out.
struct StepRange {
    std::uint64_t from = 0;
    std::uint64_t to = ~std::uint64_t(0);  // not taken any more
    std::uint64_t every = 1;

    bool has(std::uint64_t step) const { return step >= from && step < to && (step - from) % every == 0; }
};
StepRange parse_step_range(const std::string& text);  // throws Error

// Of --save-workload and --workload-steps.
struct WorkloadOptions {
    std::string folder;  // or ""
    std::string steps;
};
void add_workload_options(CLI::App& command, WorkloadOptions& options);

class WorkloadRecorder final : public Observer {
public:
    // Makes the folder, which has to be empty, and writes the world as it stands. Throws Error. The simulation has to
    // outlive the recorder, and keep its pipeline.
    WorkloadRecorder(const WorkloadOptions& options, const Simulation& simulation);

    void step_begins(std::uint64_t step, const World& world) override;
    void broadphase_found(const BroadphaseInput& input, std::span<const Pair> pairs) override;
    void narrowphase_found(const NarrowphaseInput& input, bool touching, const Contacts& contacts) override;
    void response_begins(std::size_t rule, const ResponseInput& input, const World& world) override;
    void response_ended(std::size_t rule, const ResponseInput& input, const World& world) override;

    // Completes the files. Throws Error where the disk is full.
    void finish();
    // What was kept, in a sentence.
    std::string summary() const;
    Json json() const;  // the same, of the key "workload"

private:
    using Numbers = std::array<double, 13>;
    struct Kept {
        Numbers numbers;
        std::uint8_t removed, asleep;
        bool operator==(const Kept& other) const;
    };
    static Kept kept(const World& world, std::uint32_t body);
    void write_changes(const World& world);
    void write_pending();
    template <class... Words>
    void line(const Words&... words);

    std::filesystem::path folder_;
    StepRange range_;
    const Simulation& simulation_;
    std::ofstream calls_;
    std::ostringstream pending_;            // of a call that has not ended
    std::vector<Kept> written_;             // by body
    std::vector<std::uint8_t> has_memory_;  // by rule: whether anything was written of it
    bool records_ = false;                  // this step
    std::optional<NpyWriter> boxes_;
    std::uint64_t generation_ = 0;
    std::uint64_t box_frames_ = 0, box_files_ = 0, narrowphase_calls_ = 0, touching_calls_ = 0, response_calls_ = 0;
};

}  // namespace kolize::cli
