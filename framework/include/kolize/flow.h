// The motion of bodies within one step, for whoever has to know where a body is at any time of it.
#pragma once

#include <kolize/world.h>

namespace kolize {

// What can be said of a body's motion until the end of the step.
struct MotionBound {
    Vec3 acceleration = Vec3::Zero();   // m/s^2, of the centre of mass, world axes: of the forces that do not change
    double further_acceleration = 0;    // m/s^2: at most so much comes to it (drag)
    double angular_speed = 0;           // rad/s, at most
    double angular_acceleration = 0;    // rad/s^2, at most
    double velocity_error = 0;          // m/s: by how much the path's derivative may differ from BodyState::velocity
    double angular_velocity_error = 0;  // rad/s, likewise
};

// The motion of all bodies over the rest of a step, by the integrator in force. Times in s since the step began.
class KOLIZE_API Flow {
public:
    virtual ~Flow() = default;
    // Several threads may ask at once.
    virtual BodyState at(std::uint32_t body, double time) const = 0;
    virtual MotionBound bound(std::uint32_t body) const = 0;
};

}  // namespace kolize
