// The flow of one step: every body moves freely from where it was last changed.
#pragma once

#include <kolize/integrator.h>

namespace kolize {

class StepFlow final : public Flow {
public:
    // All bodies from the world's state, at time 0, until dt. World and integrator have to outlive the step.
    void begin_step(const World& world, const Integrator& integrator, double dt);
    // The body goes on from a state at a time. Throws std::runtime_error where it turns too fast to be followed.
    void begin(std::uint32_t body, double time, const BodyState& state);
    // The body stands where it is until the end of the step; its velocity it keeps for afterwards.
    void hold(std::uint32_t body, double time);

    BodyState at(std::uint32_t body, double time) const override;
    MotionBound bound(std::uint32_t body) const override { return segments_[body].bound; }

    double begin_of(std::uint32_t body) const { return segments_[body].begin; }
    bool is_held(std::uint32_t body) const { return segments_[body].held; }
    // As at(), with the velocity that a body has which is held.
    BodyState state(std::uint32_t body, double time) const;
    const BodyState& start(std::uint32_t body) const { return segments_[body].knots.front(); }

private:
    // The integrator splits a motion that turns far into parts, and where it does depends on the length of the motion:
    // not continuous in time. So the parts are laid out here, and every time lies on one of them.
    struct Segment {
        double begin = 0, spacing = 0;  // s
        std::size_t stride = 1;         // parts from one knot to the next
        std::vector<BodyState> knots;   // at begin, begin + stride * spacing, ...
        bool held = false;
        MotionBound bound;
    };

    void lay_out(Segment& segment, std::uint32_t body, std::size_t parts);
    BodyState moving_at(const Segment& segment, std::uint32_t body, double time) const;

    const World* world_ = nullptr;
    const Integrator* integrator_ = nullptr;
    double end_ = 0;
    std::vector<Segment> segments_;
};

}  // namespace kolize
