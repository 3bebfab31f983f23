#include <kolize/integrator.h>

#include "free_rotation.h"

#include <stdexcept>

namespace kolize {
namespace {

constexpr std::size_t bodies_per_chunk = 512;

bool moves(const World& world, std::size_t body) { return !world.is_static[body] && !world.removed[body]; }

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
    const double z = drag * time;
    const double phi1 = z > 0 ? -std::expm1(-z) / z : 1;
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

void kick_angular_velocity(World& world, std::uint32_t body, const Damping& damping) {
    if (!is_turned_by_forces(world, body)) return;
    const Vec3 angular_acceleration = world.world_inverse_inertia(body) * world.constant_torque[body];
    world.angular_velocity[body] =
        damping.decay * world.angular_velocity[body] + damping.velocity_gain * angular_acceleration;
}

void move_center_by_euler(World& world, std::size_t body, double dt, const Damping& damping) {
    const Vec3 drive = acceleration(world, body) + world.forces.drag * world.forces.wind;
    world.velocity[body] = damping.decay * world.velocity[body] + damping.velocity_gain * drive;
    world.position[body] += dt * world.velocity[body];
}

class SemiImplicitEuler final : public Integrator {
    void advance_bodies(World& world, std::size_t begin, std::size_t end, double dt) const override {
        const Damping damping = euler_damping(world.forces.drag, dt);
        for (std::size_t i = begin; i < end; ++i) {
            if (!moves(world, i)) continue;
            move_center_by_euler(world, i, dt, damping);
            kick_angular_velocity(world, static_cast<std::uint32_t>(i), damping);
            world.orientation[i] = turned(world.orientation[i], dt * world.angular_velocity[i]);
        }
    }
};

// The orientation goes along the tangent at the start of the step, out of the unit sphere and back. The new angular
// velocity is larger than the old one as soon as the two differ in direction: energy only ever grows.
class MomentumEuler final : public Integrator {
    void advance_bodies(World& world, std::size_t begin, std::size_t end, double dt) const override {
        const Damping damping = euler_damping(world.forces.drag, dt);
        for (std::size_t i = begin; i < end; ++i) {
            if (!moves(world, i)) continue;
            const std::uint32_t body = static_cast<std::uint32_t>(i);
            move_center_by_euler(world, i, dt, damping);
            kick_angular_velocity(world, body, damping);
            const Vec3 momentum = world.angular_momentum(body);
            const Vec3 half_angle = 0.5 * dt * world.angular_velocity[i];
            const Quat tangent(1, half_angle.x(), half_angle.y(), half_angle.z());
            world.orientation[i] = (tangent * world.orientation[i]).normalized();
            world.angular_velocity[i] = world.world_inverse_inertia(body) * momentum;
        }
    }
};

// Torque and angular drag act as half kicks before and after the free rotation (Strang splitting: order 2 with a
// torque); the path of the centre of mass is exact.
class Pdmv4 final : public Integrator {
    void advance_bodies(World& world, std::size_t begin, std::size_t end, double dt) const override {
        const Damping damping = exact_damping(world.forces.drag, dt);
        const Damping half = exact_damping(world.forces.drag, 0.5 * dt);
        for (std::size_t i = begin; i < end; ++i) {
            if (!moves(world, i)) continue;
            const std::uint32_t body = static_cast<std::uint32_t>(i);
            const Vec3 drive = acceleration(world, i) + world.forces.drag * world.forces.wind;
            world.position[i] += damping.velocity_gain * world.velocity[i] + damping.path_gain * drive;
            world.velocity[i] = damping.decay * world.velocity[i] + damping.velocity_gain * drive;
            kick_angular_velocity(world, body, half);
            rotate_freely(world.orientation[i], world.angular_velocity[i], world.inverse_inertia[i], dt);
            kick_angular_velocity(world, body, half);
        }
    }
};

}  // namespace

void Integrator::advance(World& world, double dt, Host& host) const {
    host.parallel_for(world.size(), bodies_per_chunk,
                      [&](std::size_t, std::size_t begin, std::size_t end) { advance_bodies(world, begin, end, dt); });
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
