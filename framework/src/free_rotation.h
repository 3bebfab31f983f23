// Torque-free rotation of one rigid body.
#pragma once

#include <kolize/math.h>

namespace kolize {

// Between angular momentum and angular velocity, both in world axes, of a body with the given attitude.
struct InertiaAt {
    Mat3 rotation;  // body to world
    Vec3 inverse;   // principal, 1/(kg m^2)

    Vec3 momentum(const Vec3& velocity) const {
        return rotation * (rotation.transpose() * velocity).cwiseQuotient(inverse);
    }
    Vec3 velocity(const Vec3& momentum) const {
        return rotation * (rotation.transpose() * momentum).cwiseProduct(inverse);
    }
};

// Turns by the constant world-frame rotation vector `angle` (rad): exact for any size.
Quat turned(const Quat& orientation, const Vec3& angle);

// Moves orientation and angular velocity (world axes, rad/s) by dt seconds of free motion. Kinetic energy and angular
// momentum are kept to rounding at every step, the attitude has order 4 in dt; a body with three equal moments turns
// exactly and keeps its angular velocity bit for bit. A body that turns by more than half a radian takes several
// sub-steps; beyond 500 radians nothing resolves the motion any more, and it turns about its present axis.
void rotate_freely(Quat& orientation, Vec3& angular_velocity, const Vec3& inverse_inertia, double dt);

}  // namespace kolize
