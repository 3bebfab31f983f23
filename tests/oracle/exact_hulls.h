// Oracle: do two sets of points have convex hulls with a point in common? In integers of any size.
//
// They do exactly when the origin lies in the hull of all differences, and then (Caratheodory) in a simplex of at most
// four of them that is not flat. Triangles, segments and points are all the same to it, touching and coplanar or not.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace oracle {

using Big = boost::multiprecision::cpp_int;
using BigPoint = std::array<Big, 3>;

// A double as an integer, in units of 2^-exponent; the caller chooses the exponent so that nothing is left over.
inline Big in_units(double x, int exponent) {
    int e = 0;
    const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &e), 53));
    const int shift = e - 53 + exponent;
    return shift < 0 ? Big(digits / (Big(1) << -shift)) : Big(Big(digits) << shift);
}

inline BigPoint minus(const BigPoint& p, const BigPoint& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
inline Big dot(const BigPoint& p, const BigPoint& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
inline BigPoint cross(const BigPoint& p, const BigPoint& q) {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
inline bool is_zero(const BigPoint& p) { return p[0] == 0 && p[1] == 0 && p[2] == 0; }

inline bool origin_between(const BigPoint& p, const BigPoint& q) { return is_zero(cross(p, q)) && dot(p, q) <= 0; }

inline bool origin_in_triangle(const BigPoint& p, const BigPoint& q, const BigPoint& r) {
    const BigPoint normal = cross(minus(q, p), minus(r, p));
    if (is_zero(normal) || dot(normal, p) != 0) return false;
    return dot(normal, cross(p, q)) >= 0 && dot(normal, cross(q, r)) >= 0 && dot(normal, cross(r, p)) >= 0;
}

inline bool origin_in_tetrahedron(const BigPoint& p, const BigPoint& q, const BigPoint& r, const BigPoint& s) {
    const Big volumes[4] = {dot(q, cross(r, s)), -dot(p, cross(r, s)), dot(p, cross(q, s)), -dot(p, cross(q, r))};
    if (volumes[0] + volumes[1] + volumes[2] + volumes[3] == 0) return false;
    bool none_above = true, none_below = true;
    for (const Big& v : volumes) {
        none_above = none_above && v <= 0;
        none_below = none_below && v >= 0;
    }
    return none_above || none_below;
}

inline bool origin_in_hull(const std::vector<BigPoint>& points) {
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (is_zero(points[i])) return true;
        for (std::size_t j = i + 1; j < n; ++j) {
            if (origin_between(points[i], points[j])) return true;
            for (std::size_t k = j + 1; k < n; ++k) {
                if (origin_in_triangle(points[i], points[j], points[k])) return true;
                for (std::size_t l = k + 1; l < n; ++l)
                    if (origin_in_tetrahedron(points[i], points[j], points[k], points[l])) return true;
            }
        }
    }
    return false;
}

inline bool hulls_intersect(const std::vector<BigPoint>& a, const std::vector<BigPoint>& b) {
    std::vector<BigPoint> differences;
    for (const BigPoint& p : a)
        for (const BigPoint& q : b) differences.push_back(minus(p, q));
    return origin_in_hull(differences);
}

}  // namespace oracle
