// A run in the Chrome trace format, for Perfetto and chrome://tracing: kolize run --trace.
#pragma once

#include <kolize/observer.h>
#include <kolize/simulation.h>

#include <filesystem>
#include <fstream>

namespace kolize::cli {

// Every call of a stage as an event within its step, what the step found and how far energy has drifted as counters,
// and explosions and removals as instants. Written as it comes: a long run takes no memory. What a run that failed has
// left is kept too.
class Trace final : public Observer {
public:
    // Writes to a file beside `file`, which takes its name at the end. Throws Error if it cannot be made.
    Trace(std::filesystem::path file, const Simulation& simulation);
    ~Trace() override;

    // The file is whole from here on. Throws Error if it could not be written.
    void finish();

    void ended(const Span& span) override;
    void broadphase_found(const BroadphaseInput& input, std::span<const Pair> pairs) override;
    void narrowphase_found(const NarrowphaseInput& input, bool touching, const Contacts& contacts) override;
    void step_ended(std::uint64_t step, const World& world) override;

private:
    void write_event(const char* phase, const char* name, Span::Clock::time_point time);
    void write_counter(const char* name, double value);

    std::filesystem::path file_, part_;
    std::ofstream out_;
    const Simulation& simulation_;
    Span::Clock::time_point start_, step_end_;
    bool is_finished_ = false;
    std::uint64_t pairs_ = 0, contacts_ = 0, triangle_tests_ = 0;  // of the step
};

}  // namespace kolize::cli
