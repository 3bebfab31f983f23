// A motion to judge times of impact by.
#pragma once

#include <kolize/flow.h>

namespace kolize {

// Constant velocities and angular velocities: known in closed form at any time.
class SteadyFlow final : public Flow {
public:
    explicit SteadyFlow(const World& world) : world_(world) {}

    BodyState at(std::uint32_t body, double time) const override {
        BodyState state = world_.state(body);
        state.position += time * state.velocity;
        const double angle = state.angular_velocity.norm() * time;
        if (angle != 0)
            state.orientation = Quat(Eigen::AngleAxisd(angle, state.angular_velocity.normalized())) * state.orientation;
        return state;
    }
    MotionBound bound(std::uint32_t body) const override {
        MotionBound bound;
        bound.angular_speed = world_.angular_velocity[body].norm();
        return bound;
    }

private:
    const World& world_;
};

}  // namespace kolize
