// Whoever looks on while a simulation runs: told of every call of a stage, with what went in and what came out. A
// trace, a judge or a recorder of inputs is one of these. It changes nothing: a run ends in the same state with and
// without.
#pragma once

#include <kolize/broadphase.h>
#include <kolize/narrowphase.h>
#include <kolize/response.h>

#include <chrono>

namespace kolize {

// A stretch of work that has ended. Spans nest strictly: calls of stages, which do not overlap, within a step.
struct Span {
    using Clock = std::chrono::steady_clock;
    const char* stage = "";   // integrate, broadphase, narrowphase, response, step
    const char* plugin = "";  // or the integrator's or the stepping's name
    Clock::time_point begin, end;
};

// All that it is given is on loan for the call. What it throws ends the run. Its own time is left out of the time of
// the step, but lies within the step's span.
class KOLIZE_API Observer {
public:
    virtual ~Observer() = default;

    virtual void step_begins(std::uint64_t step, const World& world);
    // After the last stage of a step.
    virtual void step_ended(std::uint64_t step, const World& world);
    virtual void ended(const Span& span);

    virtual void broadphase_found(const BroadphaseInput& input, std::span<const Pair> pairs);
    // Of find_contacts, and of find_touching where `touching`. Contacts carry the rule, not yet the impulse.
    virtual void narrowphase_found(const NarrowphaseInput& input, bool touching, const Contacts& contacts);
    virtual void narrowphase_timed(const ImpactInput& input, std::span<const double> times);
    // `rule` counts the pipeline's response rules. The world is as it stands before and after.
    virtual void response_begins(std::size_t rule, const ResponseInput& input, const World& world);
    virtual void response_ended(std::size_t rule, const ResponseInput& input, const World& world);
};

}  // namespace kolize
