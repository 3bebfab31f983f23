#include "event_stepping.h"

namespace kolize {

namespace {

class Bisection final : public EventStepping {
public:
    Bisection(double tolerance, int max_impacts) : EventStepping(max_impacts), tolerance_(tolerance) {}

private:
    void find_impacts(Pipeline& pipeline, std::span<const std::size_t> candidates, double from, double until,
                      std::span<double> times) override {
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            if (!approaches(pipeline, candidates[i], until)) continue;
            double before = from, after = until;
            while (after - before > tolerance_ * until) {
                const double middle = 0.5 * (before + after);
                (approaches(pipeline, candidates[i], middle) ? after : before) = middle;
            }
            times[i] = after;
        }
    }

    bool approaches(Pipeline& pipeline, std::size_t candidate, double time) {
        const Pair& pair = pipeline.candidates()[candidate];
        for (const std::uint32_t body : {pair.a, pair.b}) pipeline.world.set_state(body, flow().state(body, time));
        pipeline.contacts.clear();
        return pipeline.add_contacts(candidate, false) && pipeline.approaching();
    }

    bool add_contacts(Pipeline& pipeline, std::size_t candidate, bool, double) override {
        return pipeline.add_contacts(candidate, false);
    }

    bool keeps_apart() const override { return false; }

    // What overlaps at the end is answered as in discrete stepping, if it approaches at all.
    void finish(Pipeline& pipeline, double dt) override {
        pipeline.detect();
        pipeline.respond(dt);
    }

    double tolerance_;
};

}  // namespace

std::unique_ptr<Stepping> make_bisection(const StepConfig& config) {
    return std::make_unique<Bisection>(config.tolerance, config.max_impacts);
}

}  // namespace kolize
