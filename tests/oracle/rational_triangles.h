// Oracle: do two closed triangles have a point in common, and which? In rational numbers, by clipping.
//
// A point p + t (q - p) of a side lies in the other triangle where some functions that are linear in t are not
// negative: height over the plane and under it, and distance inward from each side. What they leave of 0 <= t <= 1 is
// an interval between two fractions. Triangles in one plane are no special case; one without area is the union of its
// sides, and these are clipped alike. Nothing here is shared with the predicates of the framework.
#pragma once

#include "oracle/exact_hulls.h"

#include <kolize/math.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>

namespace oracle {

struct Fraction {
    Big n, d;  // d > 0
    bool operator<(const Fraction& o) const { return n * o.d < o.n * d; }
};

class Clip {
public:
    // Of a function that is p at t = 0 and q at t = 1.
    void keep_not_negative(const Big& p, const Big& q) {
        if (p < 0 && q < 0) empty_ = true;
        if (p < 0 && q >= 0) from = std::max(from, Fraction{-p, q - p});
        if (p >= 0 && q < 0) to = std::min(to, Fraction{p, p - q});
    }
    void keep_zero(const Big& p, const Big& q) {
        keep_not_negative(p, q);
        keep_not_negative(-p, -q);
    }
    bool empty() const { return empty_ || to < from; }

    Fraction from{0, 1}, to{1, 1};

private:
    bool empty_ = false;
};

class RationalTriangles {
public:
    RationalTriangles(const kolize::Vec3 (&a)[3], const kolize::Vec3 (&b)[3]) {
        for (const auto* t : {&a, &b})
            for (const kolize::Vec3& p : *t)
                for (const double x : p)
                    if (x != 0) exponent_ = std::max(exponent_, 53 - std::ilogb(x));
        for (int k = 0; k < 3; ++k) {
            a_[k] = in_own_units(a[k]);
            b_[k] = in_own_units(b[k]);
        }
    }

    bool meet() {
        clip_all(true);
        return !clipped_.empty();
    }

    // The ends of all parts of sides that lie in the other triangle, to the nearest double or nearly so.
    std::vector<kolize::Vec3> shared_points() {
        clip_all(false);
        std::vector<kolize::Vec3> points;
        for (const Part& part : clipped_)
            for (const Fraction& t : {part.clip.from, part.clip.to}) {
                kolize::Vec3& point = points.emplace_back();
                for (int i = 0; i < 3; ++i) point[i] = rounded(Big(part.p[i] * (t.d - t.n) + part.q[i] * t.n), t.d);
            }
        return points;
    }

private:
    using Corners = std::array<BigPoint, 3>;
    struct Part {
        BigPoint p, q;
        Clip clip;
    };

    BigPoint in_own_units(const kolize::Vec3& p) const {
        return {in_units(p[0], exponent_), in_units(p[1], exponent_), in_units(p[2], exponent_)};
    }
    double rounded(const Big& n, const Big& d) const {
        using Wide = boost::multiprecision::cpp_bin_float_100;
        return ldexp(Wide(n) / Wide(d), -exponent_).convert_to<double>();
    }

    void clip_all(bool first_only) {
        clipped_.clear();
        for (const bool of_a : {true, false})
            for (int k = 0; k < 3 && !(first_only && !clipped_.empty()); ++k) {
                const Corners &sides = of_a ? a_ : b_, &t = of_a ? b_ : a_;
                clip_side(sides[k], sides[(k + 1) % 3], t);
            }
    }

    void clip_side(const BigPoint& p, const BigPoint& q, const Corners& t) {
        const BigPoint normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
        if (is_zero(normal)) {
            for (int k = 0; k < 3; ++k) clip_by_segment(p, q, t[k], t[(k + 1) % 3]);
            return;
        }
        Clip clip;
        clip.keep_zero(dot(normal, minus(p, t[0])), dot(normal, minus(q, t[0])));
        for (int k = 0; k < 3 && !clip.empty(); ++k) {
            const BigPoint inward = cross(normal, minus(t[(k + 1) % 3], t[k]));
            clip.keep_not_negative(dot(inward, minus(p, t[k])), dot(inward, minus(q, t[k])));
        }
        if (!clip.empty()) clipped_.push_back({p, q, clip});
    }

    void clip_by_segment(const BigPoint& p, const BigPoint& q, const BigPoint& r, const BigPoint& s) {
        const BigPoint along = minus(s, r), to_p = minus(p, r), to_q = minus(q, r);
        const bool is_point = is_zero(along);
        const BigPoint off_p = is_point ? to_p : cross(along, to_p), off_q = is_point ? to_q : cross(along, to_q);
        Clip clip;
        for (int i = 0; i < 3; ++i) clip.keep_zero(off_p[i], off_q[i]);
        clip.keep_not_negative(dot(along, to_p), dot(along, to_q));
        clip.keep_not_negative(dot(along, minus(s, p)), dot(along, minus(s, q)));
        if (!clip.empty()) clipped_.push_back({p, q, clip});
    }

    int exponent_ = -1100;  // one unit is 2^-exponent
    Corners a_, b_;
    std::vector<Part> clipped_;
};

inline bool triangles_meet(const kolize::Vec3 (&a)[3], const kolize::Vec3 (&b)[3]) {
    return RationalTriangles(a, b).meet();
}

}  // namespace oracle
