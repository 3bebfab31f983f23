#include <kolize/mass_properties.h>

#include <span>

namespace kolize {

namespace {

// Integrals over the tetrahedra that the triangles span with a reference point, as multiples of their common factor.
struct Moments {
    double volume = 0;           // 6 V
    Vec3 first = Vec3::Zero();   // 24 times the integral of p
    Mat3 second = Mat3::Zero();  // 120 times the integral of p p^T

    void add(const Vec3& p, const Vec3& q, const Vec3& r) {
        const double d = p.dot(q.cross(r));
        const Vec3 s = p + q + r;
        volume += d;
        first += d * s;
        second += d * (s * s.transpose() + p * p.transpose() + q * q.transpose() + r * r.transpose());
    }
    void add(const Moments& other) {
        volume += other.volume;
        first += other.first;
        second += other.second;
    }
};

// Pairwise summation (Higham, Accuracy and Stability of Numerical Algorithms, 4.2): the rounding error grows with the
// logarithm of the number of triangles.
Moments integrate(const std::vector<Vec3>& vertices, std::span<const Triangle> triangles, const Vec3& reference) {
    Moments sum;
    if (triangles.size() > 16) {
        const std::size_t half = triangles.size() / 2;
        sum.add(integrate(vertices, triangles.first(half), reference));
        sum.add(integrate(vertices, triangles.subspan(half), reference));
        return sum;
    }
    for (const Triangle& t : triangles)
        sum.add(vertices[t[0]] - reference, vertices[t[1]] - reference, vertices[t[2]] - reference);
    return sum;
}

// The diagonal is summed from two squares, not as trace minus one: a needle keeps its small moment.
Mat3 inertia_of(const Mat3& covariance) {
    Mat3 inertia = -covariance;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        inertia(i, i) = covariance(j, j) + covariance(k, k);
    }
    return inertia;
}

// One Jacobi rotation in the plane of axes p and q, by the smaller of the two angles that make a(p, q) zero.
void rotate(Mat3& a, Mat3& axes, int p, int q) {
    const double theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
    const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::hypot(theta, 1.0));
    const Eigen::JacobiRotation<double> rotation(1 / std::hypot(t, 1.0), t / std::hypot(t, 1.0));
    a.applyOnTheLeft(p, q, rotation.transpose());
    a.applyOnTheRight(p, q, rotation);
    axes.applyOnTheRight(p, q, rotation);
    a(p, q) = a(q, p) = 0;
}

}  // namespace

MassProperties mass_properties(const TriangleSoup& closed_surface) {
    MassProperties result;
    if (closed_surface.triangles.empty()) return result;
    const Vec3 reference = closed_surface.vertices[closed_surface.triangles.front()[0]];
    const Moments sum = integrate(closed_surface.vertices, closed_surface.triangles, reference);
    result.volume = sum.volume / 6;
    if (sum.volume == 0) return result;
    const Vec3 center = sum.first / (4 * sum.volume);
    result.center_of_mass = reference + center;
    result.inertia_over_mass = inertia_of(sum.second / (20 * sum.volume) - center * center.transpose());
    return result;
}

PrincipalFrame principal_frame(const Mat3& inertia_over_mass) {
    Mat3 a = inertia_over_mass;
    Mat3 axes = Mat3::Identity();
    const double negligible = 2 * std::numeric_limits<double>::epsilon() * a.norm();
    bool rotated = true;
    // Convergence is quadratic: a handful of sweeps. The bound is for tensors that are not finite.
    for (int sweep = 0; rotated && sweep < 32; ++sweep) {
        rotated = false;
        for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
            if (std::abs(a(p, q)) > negligible) {
                rotate(a, axes, p, q);
                rotated = true;
            }
    }
    return {a.diagonal(), Quat(axes).normalized()};
}

}  // namespace kolize
