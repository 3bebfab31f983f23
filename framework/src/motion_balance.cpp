#include "motion_balance.h"

#include <algorithm>

namespace kolize {
namespace {

constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();

// One body over one motion, with what the checks share.
struct Motion {
    Motion(const World& w, std::uint32_t id, const BodyState& start, const BodyState& end, double seconds)
        : world(w),
          body(id),
          before(start),
          after(end),
          time(seconds),
          mass(1 / w.inverse_mass[id]),
          force(w.forces.gravity * mass + w.constant_force[id]),
          torque(w.constant_torque[id]),
          drag(w.forces.drag),
          path(end.position - start.position) {}

    const World& world;
    std::uint32_t body;
    const BodyState &before, &after;
    double time, mass;
    Vec3 force, torque;  // N, N m
    double drag;         // 1/s
    Vec3 path;           // m
};

// dy/dt = f - drag y keeps y on the line from its first to its last value, so the mean of y over the time lies between
// them: y1 - y0 = f t - drag t (y0 + s (y1 - y0)) for an s from 0 to 1. Returns what is missing at the best s.
double exchange_error(const Vec3& first, const Vec3& last, const Vec3& driven, double drag_time) {
    const Vec3 change = last - first, rest = change - driven + drag_time * first, slope = drag_time * change;
    const double square = slope.squaredNorm();
    const double s = square > 0 ? std::clamp(-rest.dot(slope) / square, 0.0, 1.0) : 0;
    return (rest + s * slope).norm();
}

Balance momentum_balance(const Motion& m, double tolerance) {
    const Vec3 first = m.mass * m.before.velocity, last = m.mass * m.after.velocity;
    const Vec3 driven = m.time * (m.force + m.drag * m.mass * m.world.forces.wind);
    const double scale = first.norm() + last.norm() + driven.norm();
    return {exchange_error(first, last, driven, m.drag * m.time), tolerance * scale};
}

// The spin's part, and that of the path. A force that does not change moves a body along its mean momentum; what drag
// does to the path has no such form, and is left out.
Balance angular_balance(const Motion& m, double tolerance) {
    const Vec3 first = m.world.angular_momentum(m.body, m.before), last = m.world.angular_momentum(m.body, m.after);
    const Vec3 driven = m.time * m.torque;
    Balance balance{exchange_error(first, last, driven, m.drag * m.time), 0};
    double scale = angular_scale(m.world, m.body, m.before) + angular_scale(m.world, m.body, m.after) + driven.norm();
    double limit = 0;
    if (m.drag == 0) {
        const Vec3 mean = m.mass * m.after.velocity - 0.5 * m.time * m.force;
        balance.off += m.path.cross(mean).norm();
        scale += m.path.norm() * mean.norm();
        limit += rounding * (m.before.position.norm() + m.after.position.norm()) * mean.norm();
    }
    balance.limit = limit + tolerance * scale;
    return balance;
}

double spin_energy(const Motion& m, const BodyState& state) {
    return 0.5 * state.angular_velocity.dot(m.world.angular_momentum(m.body, state));
}

struct Span {
    double low = 0, high = 0;
};

// What drag and torque may do at most (J): they depend on the way, and the way on the integrator.
Span work_of_losses(const Motion& m) {
    const double speed = std::max(m.before.velocity.norm(), m.after.velocity.norm());
    const double spin = std::max(spin_energy(m, m.before), spin_energy(m, m.after));
    const double largest_inverse = m.world.inverse_inertia[m.body].maxCoeff(), torque = m.torque.norm();
    const double turn = m.time * (std::sqrt(2 * spin * largest_inverse) + torque * largest_inverse * m.time);
    const double wind = m.drag * m.time * m.mass * m.world.forces.wind.norm() * speed;
    const double resistance = m.drag * m.time * (m.mass * speed * speed + 2 * spin);
    return {-(resistance + wind + torque * turn), wind + torque * turn};
}

Balance energy_balance(const Motion& m, double tolerance) {
    const double first = m.world.kinetic_energy(m.body, m.before), last = m.world.kinetic_energy(m.body, m.after);
    const double error = last - first - m.force.dot(m.path);
    const Span allowed = work_of_losses(m);
    const double ends = m.before.position.norm() + m.after.position.norm();
    const double scale = first + last + m.force.norm() * m.path.norm() + allowed.high - allowed.low;
    return {error - std::min(std::max(error, allowed.low), allowed.high),
            tolerance * scale + rounding * m.force.norm() * ends + energy_rounding(m.world, m.body, m.before) +
                energy_rounding(m.world, m.body, m.after)};
}

}  // namespace

double energy_rounding(const World& world, std::uint32_t body, const BodyState& state) {
    return rounding * world.angular_momentum(body, state).norm() * state.angular_velocity.norm();
}

double angular_scale(const World& world, std::uint32_t body, const BodyState& state) {
    return state.angular_velocity.norm() / world.inverse_inertia[body].minCoeff();
}

MotionBalance balance_of_motion(const World& world, std::uint32_t body, const BodyState& before, const BodyState& after,
                                double time, const LedgerConfig& tolerance) {
    const Motion motion(world, body, before, after, time);
    return {energy_balance(motion, tolerance.energy), momentum_balance(motion, tolerance.momentum),
            angular_balance(motion, tolerance.angular_momentum)};
}

}  // namespace kolize
