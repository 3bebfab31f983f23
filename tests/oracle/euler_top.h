// Reference for a rigid body that turns about its centre of mass: classical Runge-Kutta in long double.
#pragma once

#include <kolize/math.h>

// Euler's equations d(I w)/dt + w x (I w) = tau in body axes with dq/dt = q w / 2; tau is constant in world axes.
class EulerTop {
public:
    using Vec = Eigen::Matrix<long double, 3, 1>;
    using Quaternion = Eigen::Quaternion<long double>;

    // Principal moments, attitude, angular velocity and torque in world axes.
    EulerTop(const kolize::Vec3& moments, const kolize::Quat& attitude, const kolize::Vec3& angular_velocity,
             const kolize::Vec3& torque = kolize::Vec3::Zero())
        : inertia_(moments.cast<long double>()),
          torque_(torque.cast<long double>()),
          q_(attitude.cast<long double>()),
          w_(q_.conjugate() * angular_velocity.cast<long double>()) {}

    void advance(long double time, int steps) {
        const long double h = time / steps;
        for (int i = 0; i < steps; ++i) step(h);
    }
    kolize::Quat attitude() const { return kolize::Quat(q_.cast<double>()); }
    kolize::Vec3 angular_velocity() const { return (q_ * w_).cast<double>(); }

private:
    struct Rate {
        Eigen::Matrix<long double, 4, 1> q;
        Vec w;
    };

    Rate rate(const Quaternion& q, const Vec& w) const {
        const Quaternion qw = q * Quaternion(0, w.x(), w.y(), w.z());
        const Vec momentum = inertia_.cwiseProduct(w);
        return {qw.coeffs() / 2, (momentum.cross(w) + q.conjugate() * torque_).cwiseQuotient(inertia_)};
    }
    Rate rate_after(const Rate& r, long double h) const {
        return rate(Quaternion(q_.coeffs() + h * r.q), w_ + h * r.w);
    }
    void step(long double h) {
        const Rate k1 = rate(q_, w_);
        const Rate k2 = rate_after(k1, h / 2);
        const Rate k3 = rate_after(k2, h / 2);
        const Rate k4 = rate_after(k3, h);
        q_.coeffs() += h / 6 * (k1.q + 2 * k2.q + 2 * k3.q + k4.q);
        w_ += h / 6 * (k1.w + 2 * k2.w + 2 * k3.w + k4.w);
        q_.normalize();
    }

    Vec inertia_;
    Vec torque_;
    Quaternion q_;
    Vec w_;
};

// Angle between two attitudes, rad.
inline double attitude_error(const kolize::Quat& a, const kolize::Quat& b) {
    return 2 * std::asin(std::min(1.0, (a.conjugate() * b).vec().norm()));
}
