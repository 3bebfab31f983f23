#include <kolize/integrator.h>

#include "free_rotation.h"

#include <algorithm>
#include <stdexcept>

namespace kolize {
namespace {

constexpr std::size_t bodies_per_chunk = 512;

bool moves(const World& world, std::size_t body) {
    return !world.is_static[body] && !world.removed[body] && !world.asleep[body];
}

bool is_turned_by_forces(const World& world, std::size_t body) {
    return world.forces.drag != 0 || !world.constant_torque[body].isZero(0);
}

Vec3 acceleration(const World& world, std::size_t body) {
    return world.forces.gravity + world.inverse_mass[body] * world.constant_force[body];
}

// What linear drag makes of velocities and accelerations in a time t: v(t) = decay v + velocity_gain a and
// x(t) = x + velocity_gain v + path_gain a. Without drag these are 1, t and t^2 / 2.
struct Damping {
    double decay;
    double velocity_gain;  // s
    double path_gain;      // s^2
};

// The exact solution of dv/dt = a - drag v.
Damping exact_damping(double drag, double time) {
    if (drag == 0) return {1, time, 0.5 * time * time};
    const double z = drag * time;
    const double phi1 = z > 0 ? -std::expm1(-z) / z : 1;  // z may underflow to 0
    // (z - 1 + exp(-z)) / z^2 cancels where z is small; its Taylor series there, in Horner form: 1/2 - z/6 + z^2/24 ...
    double series = 1;
    for (int k = 20; k > 2; --k) series = 1 - z / k * series;
    const double phi2 = z < 1 ? series / 2 : (1 - phi1) / z;
    return {std::exp(-z), phi1 * time, phi2 * time * time};
}

// Implicit Euler: first order, stable for any drag.
Damping euler_damping(double drag, double time) {
    const double decay = 1 / (1 + drag * time);
    return {decay, decay * time, 0};
}

void kick_angular_velocity(const World& world, std::uint32_t body, const Damping& damping, BodyState& state) {
    if (!is_turned_by_forces(world, body)) return;
    const Vec3 angular_acceleration =
        InertiaAt{state.orientation.toRotationMatrix(), world.inverse_inertia[body]}.velocity(
            world.constant_torque[body]);
    state.angular_velocity = damping.decay * state.angular_velocity + damping.velocity_gain * angular_acceleration;
}

// What drives the centre of mass: the velocity that drag leads to, times drag, and the acceleration by forces.
Vec3 drive(const World& world, std::uint32_t body) {
    return acceleration(world, body) + world.forces.drag * world.forces.wind;
}

void move_center_by_euler(const World& world, std::uint32_t body, double dt, const Damping& damping, BodyState& state) {
    state.velocity = damping.decay * state.velocity + damping.velocity_gain * drive(world, body);
    state.position += dt * state.velocity;
}

// The velocity at the end of a call is not the derivative of the path there.
void set_euler_errors(double call, MotionBound& bound) {
    bound.velocity_error = call * (bound.acceleration.norm() + bound.further_acceleration);
    bound.angular_velocity_error = call * bound.angular_acceleration;
}

class SemiImplicitEuler final : public Integrator {
    void advance_body(const World& world, std::uint32_t body, double dt, BodyState& state) const override {
        const Damping damping = euler_damping(world.forces.drag, dt);
        move_center_by_euler(world, body, dt, damping, state);
        kick_angular_velocity(world, body, damping, state);
        state.orientation = turned(state.orientation, dt * state.angular_velocity);
    }

    void set_errors(const World&, std::uint32_t, double call, MotionBound& bound) const override {
        set_euler_errors(call, bound);
    }
};

// The orientation goes along the tangent at the start of the step, out of the unit sphere and back. The new angular
// velocity is larger than the old one as soon as the two differ in direction: energy only ever grows.
class MomentumEuler final : public Integrator {
    void advance_body(const World& world, std::uint32_t body, double dt, BodyState& state) const override {
        const Damping damping = euler_damping(world.forces.drag, dt);
        move_center_by_euler(world, body, dt, damping, state);
        kick_angular_velocity(world, body, damping, state);
        const auto inertia = [&] {
            return InertiaAt{state.orientation.toRotationMatrix(), world.inverse_inertia[body]};
        };
        const Vec3 momentum = inertia().momentum(state.angular_velocity);
        const Vec3 half_angle = 0.5 * dt * state.angular_velocity;
        const Quat tangent(1, half_angle.x(), half_angle.y(), half_angle.z());
        state.orientation = (tangent * state.orientation).normalized();
        state.angular_velocity = inertia().velocity(momentum);
    }

    // The tangent turns by 2 atan(a / 2) instead of a.
    void set_errors(const World&, std::uint32_t, double call, MotionBound& bound) const override {
        set_euler_errors(call, bound);
        const double angle = bound.angular_speed * call;
        bound.angular_velocity_error += bound.angular_speed * std::min(1.0, 0.25 * angle * angle);
    }
};

// Torque and angular drag act as half kicks before and after the free rotation (Strang splitting: order 2 with a
// torque); the path of the centre of mass is exact.
class Pdmv4 final : public Integrator {
    void advance_body(const World& world, std::uint32_t body, double dt, BodyState& state) const override {
        const Damping damping = exact_damping(world.forces.drag, dt);
        const Vec3 driven = drive(world, body);
        state.position += damping.velocity_gain * state.velocity + damping.path_gain * driven;
        state.velocity = damping.decay * state.velocity + damping.velocity_gain * driven;
        const Damping half = exact_damping(world.forces.drag, 0.5 * dt);
        kick_angular_velocity(world, body, half, state);
        rotate_freely(state.orientation, state.angular_velocity, world.inverse_inertia[body], dt);
        kick_angular_velocity(world, body, half, state);
    }

    // Of order 4 in the angle of a call, with a factor well above what slender bodies show; torques of order 1.
    void set_errors(const World& world, std::uint32_t body, double call, MotionBound& bound) const override {
        const double angle = bound.angular_speed * call;
        if (is_turned_by_forces(world, body))
            bound.angular_velocity_error = bound.angular_acceleration * call;
        else if (bound.angular_acceleration > 0)
            bound.angular_velocity_error = 0.05 * bound.angular_speed * std::min(1.0, std::pow(angle, 4));
    }
};

}  // namespace

void Integrator::advance(World& world, double dt, Host& host) const {
    host.parallel_for(world.size(), bodies_per_chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (auto body = static_cast<std::uint32_t>(begin); body < end; ++body) {
            if (!moves(world, body)) continue;
            BodyState state = world.state(body);
            advance_body(world, body, dt, state);
            world.set_state(body, state);
        }
    });
}

MotionBound Integrator::bound(const World& world, std::uint32_t body, const BodyState& state, double time,
                              double call) const {
    const double drag = world.forces.drag;
    const Vec3 &inverse = world.inverse_inertia[body], inertia = inverse.cwiseInverse();
    const InertiaAt at{state.orientation.toRotationMatrix(), inverse};
    const Vec3 momentum = at.momentum(state.angular_velocity);
    const double torque_turn = world.constant_torque[body].norm() * inverse.maxCoeff();  // rad/s^2
    MotionBound bound;
    bound.acceleration = acceleration(world, body);
    bound.further_acceleration =
        drag * ((state.velocity - world.forces.wind).norm() + bound.acceleration.norm() * time);
    // Twice the rotational energy is at least w^2 times the least moment, and free motion keeps it.
    bound.angular_speed =
        std::sqrt(std::max(0.0, momentum.dot(state.angular_velocity)) * inverse.maxCoeff()) + torque_turn * time;
    // Euler's equation: I dw/dt = (I w) x w.
    const double asymmetry = (inertia.maxCoeff() - inertia.minCoeff()) * inverse.maxCoeff();
    bound.angular_acceleration =
        asymmetry * bound.angular_speed * bound.angular_speed + torque_turn + drag * bound.angular_speed;
    set_errors(world, body, call, bound);
    return bound;
}

std::unique_ptr<Integrator> make_integrator(const std::string& name) {
    if (name == "semi_implicit_euler") return std::make_unique<SemiImplicitEuler>();
    if (name == "momentum_euler") return std::make_unique<MomentumEuler>();
    if (name == "pdmv4") return std::make_unique<Pdmv4>();
    std::string known;
    for (const std::string& candidate : integrator_names()) known += (known.empty() ? "" : ", ") + candidate;
    throw std::invalid_argument("there is no integrator '" + name + "'; the integrators are " + known);
}

const std::vector<std::string>& integrator_names() {
    static const std::vector<std::string> names{"semi_implicit_euler", "momentum_euler", "pdmv4"};
    return names;
}

}  // namespace kolize
