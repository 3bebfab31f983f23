#include "event_stepping.h"

namespace kolize {

namespace {

class Continuous final : public EventStepping {
public:
    using EventStepping::EventStepping;

private:
    void find_impacts(Pipeline& pipeline, std::span<const std::size_t> candidates, double from, double until,
                      std::span<double> times) override {
        pairs_.clear();
        for (const std::size_t candidate : candidates) pairs_.push_back(pipeline.candidates()[candidate]);
        pipeline.find_impacts(pairs_, flow(), from, until, times);
    }

    // Bodies that overlap from the start have no touching points: they are parted as in discrete stepping.
    bool add_contacts(Pipeline& pipeline, std::size_t candidate, bool known, double reach) override {
        return pipeline.add_contacts(candidate, true, reach) || (known && pipeline.add_contacts(candidate, false));
    }

    bool keeps_apart() const override { return true; }

    std::vector<Pair> pairs_;
};

}  // namespace

std::unique_ptr<Stepping> make_continuous(const StepConfig& config) {
    return std::make_unique<Continuous>(config.max_impacts);
}

}  // namespace kolize
