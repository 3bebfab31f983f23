#include "bounding_volumes/local_points.h"

#include <kolize/bounding_volumes.h>

#include <algorithm>
#include <array>
#include <numbers>

namespace kolize {

namespace {

// The points that hold the sphere: four at most, and a fifth while one is exchanged.
struct Support {
    std::array<Vec3, 5> points;
    int count = 0;

    void add(const Vec3& p) { points[count++] = p; }
};

struct Ball {
    Vec3 center = Vec3::Zero();
    double squared_radius = infinity;
    Support support;
};

double squared_reach(const Vec3& center, const Support& points) {
    double reach = 0;
    for (int i = 0; i < points.count; ++i) reach = std::max(reach, (points.points[i] - center).squaredNorm());
    return reach;
}

// The point at one distance from all of the support, in the flat that the support spans: the shortest x, seen from the
// first point, with q . x = q . q / 2 for each other point q. Orthogonalised twice (Golub & Van Loan, Matrix
// Computations, 5.2); a point that adds no direction to those before it says nothing.
Vec3 equidistant(const Support& support) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    std::array<Vec3, 3> basis;
    int rank = 0;
    Vec3 x = Vec3::Zero();
    for (int i = 1; i < support.count; ++i) {
        const Vec3 q = support.points[i] - support.points[0];
        Vec3 rest = q;
        for (int pass = 0; pass < 2; ++pass)
            for (int k = 0; k < rank; ++k) rest -= basis[k].dot(rest) * basis[k];
        const double length = rest.norm();
        if (length <= rounding * q.norm()) continue;
        basis[rank] = rest / length;
        x += (0.5 * q.squaredNorm() - q.dot(x)) / q.dot(basis[rank]) * basis[rank];
        ++rank;
    }
    return support.points[0] + x;
}

// The smallest ball of a support and one more point, which lies outside the support's own ball and so on the surface of
// the new one. Every choice of supporting points is tried, and judged by how far it must reach to hold all of them: a
// choice that is badly conditioned loses by itself, without a tolerance.
Ball exchange(const Support& support, const Vec3& p) {
    Support all = support;
    all.add(p);
    Ball best;
    for (unsigned chosen = 1; chosen < 1u << support.count; ++chosen) {
        Support candidate;
        candidate.add(p);
        for (int i = 0; i < support.count; ++i)
            if (chosen >> i & 1) candidate.add(support.points[i]);
        if (candidate.count == 5) continue;
        const Vec3 center = equidistant(candidate);
        const double squared_radius = squared_reach(center, all);
        if (squared_radius < best.squared_radius) best = {center, squared_radius, candidate};
    }
    return best;
}

const Vec3& farthest_from(const Vec3& center, std::span<const Vec3> points) {
    const Vec3* farthest = &points.front();
    double largest = -1;
    for (const Vec3& p : points)
        if (const double d = (p - center).squaredNorm(); d > largest) {
            largest = d;
            farthest = &p;
        }
    return *farthest;
}

// The farthest point enters the support until none is outside: the pivot rule of Gaertner, "Fast and robust smallest
// enclosing balls", ESA 1999, on the exchange steps of Sharir & Welzl 1992. A handful of passes over the points.
Vec3 center_of_smallest_ball(std::span<const Vec3> points) {
    // A point at (1 + d) r may lift the radius by only d^2 / 2, less than rounding: growth cannot be asked of each
    // exchange, and the bound ends the exchanges among points on one sphere to within rounding.
    constexpr int most_exchanges = 64;
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    Ball ball{points.front(), 0, {}};
    ball.support.add(points.front());
    Vec3 best = ball.center;
    double least_reach = infinity;
    for (int exchanges = 0; exchanges < most_exchanges; ++exchanges) {
        const Vec3& p = farthest_from(ball.center, points);
        const double reach = (p - ball.center).squaredNorm();
        if (reach < least_reach) {
            least_reach = reach;
            best = ball.center;
        }
        if (reach <= (1 + rounding) * ball.squared_radius) break;
        ball = exchange(ball.support, p);
    }
    return best;
}

}  // namespace

double BoundingSphere::volume() const { return 4 * std::numbers::pi / 3 * radius * radius * radius; }

BoundingSphere sphere_about(const Vec3& center, std::span<const Vec3> points) {
    require_points(points);
    BoundingSphere sphere{center, 0};
    for (const Vec3& p : points) {
        const Vec3 d = p - center;
        sphere.radius = std::max(sphere.radius, std::hypot(d.x(), d.y(), d.z()));
    }
    return sphere;
}

BoundingSphere smallest_enclosing_sphere(std::span<const Vec3> points) {
    const LocalPoints local = local_points(points);
    // Measured from the centre as it is rounded to the frame of the points.
    return sphere_about(local.origin + local.unit * center_of_smallest_ball(local.points), points);
}

}  // namespace kolize
