#include <kolize/mass_properties.h>

#include <algorithm>
#include <span>

namespace kolize {

namespace {

// Triangles side by side. Every processor does the same operations in the same order, in registers as wide as it has
// them: same bits everywhere.
constexpr std::size_t lanes = 4;
using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;

// The thread sanitizer is not ready yet when the choice between clones is made.
#ifdef __SANITIZE_THREAD__
#define KOLIZE_WIDE
#else
#define KOLIZE_WIDE [[gnu::target_clones("avx2", "default")]]
#endif

// Integrals over the tetrahedra that the triangles span with a reference point, as multiples of their common factor.
template <class Real>
struct Moments {
    Real volume{};     // 6 V
    Real first[3]{};   // 24 times the integral of x, y, z
    Real second[6]{};  // 120 times the integral of xx, yy, zz, yz, zx, xy

    [[gnu::always_inline]] void add(const Real (&p)[3], const Real (&q)[3], const Real (&r)[3]) {
        const Real d = p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                       p[2] * (q[0] * r[1] - q[1] * r[0]);
        const Real s[3] = {p[0] + q[0] + r[0], p[1] + q[1] + r[1], p[2] + q[2] + r[2]};
        volume += d;
        for (int i = 0; i < 3; ++i) first[i] += d * s[i];
        for (int n = 0; n < 6; ++n) {
            const int i = n < 3 ? n : (n + 1) % 3, j = n < 3 ? n : (n + 2) % 3;
            second[n] += d * (s[i] * s[j] + p[i] * p[j] + q[i] * q[j] + r[i] * r[j]);
        }
    }
    void add(const Moments& other) {
        volume += other.volume;
        for (int i = 0; i < 3; ++i) first[i] += other.first[i];
        for (int n = 0; n < 6; ++n) second[n] += other.second[n];
    }
};

double sum_of(const Lanes& x) { return (x[0] + x[1]) + (x[2] + x[3]); }

[[gnu::always_inline]] inline void add_block(Moments<Lanes>& sum, const Vec3* vertices, const Triangle* triangles,
                                             const Vec3& reference) {
    Lanes corners[3][3];
    for (std::size_t corner = 0; corner < 3; ++corner)
        for (int i = 0; i < 3; ++i) {
            const auto at = [&](std::size_t lane) { return vertices[triangles[lane][corner]][i]; };
            corners[corner][i] = Lanes{at(0), at(1), at(2), at(3)} - reference[i];
        }
    sum.add(corners[0], corners[1], corners[2]);
}

KOLIZE_WIDE void integrate_few(const Vec3* vertices, std::span<const Triangle> triangles, const Vec3& reference,
                               Moments<double>& result) {
    Moments<Lanes> sum;
    std::size_t begin = 0;
    for (; begin + lanes <= triangles.size(); begin += lanes) add_block(sum, vertices, &triangles[begin], reference);
    if (begin < triangles.size()) {
        std::array<Triangle, lanes> last;
        last.fill({triangles[begin][0], triangles[begin][0], triangles[begin][0]});  // adds nothing
        std::copy(triangles.begin() + static_cast<std::ptrdiff_t>(begin), triangles.end(), last.begin());
        add_block(sum, vertices, last.data(), reference);
    }
    result.volume = sum_of(sum.volume);
    for (int i = 0; i < 3; ++i) result.first[i] = sum_of(sum.first[i]);
    for (int n = 0; n < 6; ++n) result.second[n] = sum_of(sum.second[n]);
}

// Pairwise summation (Higham, Accuracy and Stability of Numerical Algorithms, 4.2): the rounding error grows with the
// logarithm of the number of triangles.
Moments<double> integrate(const std::vector<Vec3>& vertices, std::span<const Triangle> triangles,
                          const Vec3& reference) {
    Moments<double> sum;
    if (triangles.size() > 32 * lanes) {
        const std::size_t half = triangles.size() / (2 * lanes) * lanes;
        sum.add(integrate(vertices, triangles.first(half), reference));
        sum.add(integrate(vertices, triangles.subspan(half), reference));
        return sum;
    }
    integrate_few(vertices.data(), triangles, reference, sum);
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
    const Moments<double> sum = integrate(closed_surface.vertices, closed_surface.triangles, reference);
    result.volume = sum.volume / 6;
    if (sum.volume == 0) return result;
    const Vec3 center = Vec3(sum.first[0], sum.first[1], sum.first[2]) / (4 * sum.volume);
    const auto& [xx, yy, zz, yz, zx, xy] = sum.second;
    Mat3 second;
    second << xx, xy, zx, xy, yy, yz, zx, yz, zz;
    result.center_of_mass = reference + center;
    result.inertia_over_mass = inertia_of(second / (20 * sum.volume) - center * center.transpose());
    return result;
}

double surface_area(const TriangleSoup& surface) {
    double twice = 0;
    for (const Triangle& t : surface.triangles) {
        const Vec3& corner = surface.vertices[t[0]];
        twice += (surface.vertices[t[1]] - corner).cross(surface.vertices[t[2]] - corner).norm();
    }
    return twice / 2;
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
