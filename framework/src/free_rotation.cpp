// Preprocessed discrete Moser-Veselov algorithm of order 4: E. Hairer, G. Vilmart, "Preprocessed discrete Moser-Veselov
// algorithm for the full dynamics of a rigid body", J. Phys. A 39 (2006) 13225. The discrete system of Moser and
// Veselov is integrable like the continuous one and keeps energy and angular momentum; it is made to follow the true
// motion to order 4 by giving it slightly different moments of inertia, constant along a trajectory.
#include "free_rotation.h"

#include <algorithm>

namespace kolize {
namespace {

constexpr double max_angle_per_substep = 0.5;  // rad; keeps the fixed point below a strong contraction
constexpr double max_resolved_angle = 500;     // rad per call; bounds the work of a call

// The inverse moments that the discrete system has to be given: Hairer & Vilmart 2006, the terms of order h^2.
Vec3 preprocessed_inverse_inertia(const Vec3& momentum, const Vec3& inverse_inertia, double h) {
    const double energy = 0.5 * momentum.dot(momentum.cwiseProduct(inverse_inertia));
    const double casimir = 0.5 * momentum.squaredNorm();
    const double inverse_product = inverse_inertia.prod();
    const double sum_over_product = inverse_inertia.cwiseInverse().sum() * inverse_product / 6;
    const double s = casimir * sum_over_product - energy * inverse_inertia.sum() / 3;
    const double d = energy * sum_over_product - casimir * inverse_product / 3;
    return (1 + h * h * s) * inverse_inertia + Vec3::Constant(h * h * d);
}

// The axis times the tangent of half the angle by which the body turns in h, in body axes. Solves
// I e + e x (I e) = (h / 2) (1 + e.e) y by fixed-point iteration until it no longer improves: energy is kept as exactly
// as this equation is solved.
Vec3 half_turn(const Vec3& momentum, const Vec3& inverse_inertia, double h) {
    const Vec3 inertia = inverse_inertia.cwiseInverse();
    const Vec3 impulse = (0.5 * h) * momentum;
    Vec3 e = impulse.cwiseProduct(inverse_inertia);
    for (double change = infinity;;) {
        const Vec3 sum = (1 + e.squaredNorm()) * impulse - e.cross(inertia.cwiseProduct(e));
        const Vec3 next = sum.cwiseProduct(inverse_inertia);
        const double next_change = (next - e).squaredNorm();
        if (!(next_change < change)) return e;
        e = next;
        change = next_change;
    }
}

// A quaternion whose length is 1 but for rounding, brought to 1. Dividing by the length cannot see errors below an ulp,
// and those left over have a sign: they made energy drift by 1e-10 in an hour. The defect is formed without
// cancellation, and what it leaves averages out.
Quat polished(Quat q) {
    const double defect = (1 - q.w()) * (1 + q.w()) - q.vec().squaredNorm();
    q.coeffs() += 0.5 * defect * q.coeffs();
    return q;
}

// One step of size h for the body-frame angular momentum.
void moser_veselov_step(Quat& orientation, Vec3& momentum, const Vec3& inverse_inertia, double h) {
    const Vec3 e = half_turn(momentum, preprocessed_inverse_inertia(momentum, inverse_inertia, h), h);
    const Quat turn = polished(Quat(1, e.x(), e.y(), e.z()).normalized());
    orientation = polished(orientation * turn);
    momentum = turn.conjugate() * momentum;
}
}  // namespace

Quat turned(const Quat& orientation, const Vec3& angle) {
    const double half = 0.5 * angle.stableNorm();
    const double sine_ratio = half > 0 ? 0.5 * std::sin(half) / half : 0.5;
    const Vec3 axis = sine_ratio * angle;
    return polished(Quat(std::cos(half), axis.x(), axis.y(), axis.z()) * orientation);
}

void rotate_freely(Quat& orientation, Vec3& angular_velocity, const Vec3& inverse_inertia, double dt) {
    const double angle = angular_velocity.stableNorm() * dt;
    if (angle == 0) return;
    const bool spherical = (inverse_inertia.array() == inverse_inertia.x()).all();
    if (spherical || !(angle <= max_resolved_angle)) {
        orientation = turned(orientation, dt * angular_velocity);
        return;
    }
    const int steps = std::max(1, static_cast<int>(std::ceil(angle / max_angle_per_substep)));
    const InertiaAt start{orientation.toRotationMatrix(), inverse_inertia};
    const Vec3 momentum = start.momentum(angular_velocity);
    Vec3 body_momentum = start.rotation.transpose() * momentum;
    for (int i = 0; i < steps; ++i) moser_veselov_step(orientation, body_momentum, inverse_inertia, dt / steps);

    // The momentum in world axes has not changed. Going there and back is not quite the identity, with an error that
    // has a sign; one step of iterative refinement takes it out.
    const InertiaAt end{orientation.toRotationMatrix(), inverse_inertia};
    angular_velocity = end.velocity(momentum);
    angular_velocity += end.velocity(momentum - end.momentum(angular_velocity));
}

}  // namespace kolize
