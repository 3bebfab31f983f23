// The determinant that geometric decisions rest on: the volume spanned by three vectors, with its exact sign.
#pragma once

#include <kolize/math.h>

#include <algorithm>

namespace kolize {

// The vector from one point to another, before rounding.
struct Span {
    const Vec3& from;
    const Vec3& to;
    Vec3 rounded() const { return to - from; }
};

// u . (v x w) for any finite coordinates. The sign is exact, and the value is to within a few roundings where that is
// a normal double.
double exact_volume(const Span& u, const Span& v, const Span& w);

// The same for most inputs: floating point alone where the error is certainly below 1/margin of the result, exact
// otherwise. The bound is that of Meyer & Pion, "FPG: A code generator for fast and certified geometric predicates",
// 2008, as CGAL uses it: a constant times the largest coordinate of each axis.
inline double volume(const Span& u, const Span& v, const Span& w, double margin = 1) {
    const Vec3 a = u.rounded(), b = v.rounded(), c = w.rounded();
    const Vec3 largest = a.cwiseAbs().cwiseMax(b.cwiseAbs()).cwiseMax(c.cwiseAbs());
    const double smallest_axis = largest.minCoeff();
    if (smallest_axis == 0) return 0;
    const double determinant = a.dot(b.cross(c));
    const bool may_underflow = smallest_axis < 1e-97, may_overflow = !(largest.maxCoeff() < 1e102);
    const double bound = 5.1107127829973299e-15 * largest.x() * largest.y() * largest.z();
    if (!may_underflow && !may_overflow && std::abs(determinant) > margin * bound) return determinant;
    return exact_volume(u, v, w);
}

// Where the segment pq, whose ends do not lie on one side of the plane through t, crosses it: each coordinate within a
// few roundings of the exact one. Not both ends lie in the plane.
Vec3 exact_crossing(const Vec3& p, const Vec3& q, const Vec3 (&t)[3]);

inline int sign(double x) { return (x > 0) - (x < 0); }

}  // namespace kolize
