#include <kolize/predicates.h>

#include "exact_volume.h"

#include <tuple>

namespace kolize {

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return sign(volume({a, b}, {a, c}, {a, d}));
}

namespace {

using Corners = Vec3[3];

bool before(const Vec3& p, const Vec3& q) { return std::tie(p[0], p[1], p[2]) < std::tie(q[0], q[1], q[2]); }

// Which way (p, q, r) turns, seen along a coordinate axis.
int turn(const Vec3& p, const Vec3& q, const Vec3& r, int axis) {
    static const Vec3 origin = Vec3::Zero(), units[3] = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    return sign(volume({origin, units[axis]}, {p, q}, {p, r}));
}

// An axis along which the plane of the three points is not seen edge-on; 3 if they lie on one line.
int viewing_axis(const Vec3& p, const Vec3& q, const Vec3& r) {
    int axis = 0;
    while (axis < 3 && turn(p, q, r, axis) == 0) ++axis;
    return axis;
}

// Of four points on one line: do the closed segments pq and rs share one?
bool overlap_on_line(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    const auto& [p0, p1] = std::minmax(p, q, before);
    const auto& [r0, r1] = std::minmax(r, s, before);
    return !before(p1, r0) && !before(r1, p0);
}

// Of four points in a plane that is not seen edge-on: do the closed segments pq and rs share one?
bool cross_in_view(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, int axis) {
    const int a = turn(p, q, r, axis), b = turn(p, q, s, axis), c = turn(r, s, p, axis), d = turn(r, s, q, axis);
    if (a == 0 && b == 0 && c == 0 && d == 0) return overlap_on_line(p, q, r, s);
    return a * b <= 0 && c * d <= 0;
}

bool segments_intersect(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    if (orient3d(p, q, r, s) != 0) return false;
    const int axis = std::min(std::min(viewing_axis(p, q, r), viewing_axis(p, q, s)),
                              std::min(viewing_axis(r, s, p), viewing_axis(r, s, q)));
    return axis == 3 ? overlap_on_line(p, q, r, s) : cross_in_view(p, q, r, s, axis);
}

bool contains_in_view(const Corners& t, const Vec3& p, int axis) {
    const int a = turn(t[0], t[1], p, axis), b = turn(t[1], t[2], p, axis), c = turn(t[2], t[0], p, axis);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

// A closed segment against a closed triangle, either of which may be without extent.
bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Corners& t) {
    const int hp = orient3d(t[0], t[1], t[2], p), hq = orient3d(t[0], t[1], t[2], q);
    if (hp * hq > 0) return false;
    if (hp != hq) {
        const int a = orient3d(p, q, t[0], t[1]), b = orient3d(p, q, t[1], t[2]), c = orient3d(p, q, t[2], t[0]);
        return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
    }
    const int axis = viewing_axis(t[0], t[1], t[2]);
    for (int k = 0; k < 3; ++k) {
        const Vec3 &r = t[k], &s = t[(k + 1) % 3];
        if (axis == 3 ? segments_intersect(p, q, r, s) : cross_in_view(p, q, r, s, axis)) return true;
    }
    return axis < 3 && contains_in_view(t, p, axis);
}

// Where two closed triangles intersect, a side of one meets the other; so for those in one plane or without area.
bool a_side_meets_the_other(const Corners& a, const Corners& b) {
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        if (segment_meets_triangle(a[k], a[next], b) || segment_meets_triangle(b[k], b[next], a)) return true;
    }
    return false;
}

// On which side of a plane each corner of a triangle lies.
struct Heights {
    int of[3];

    // The bound is that of volume(), once for all corners, for the determinant in another order: each of the six
    // products is wrong by eight roundings at most and no larger than the product of the largest coordinates.
    Heights(const Corners& t, const Corners& plane) {
        constexpr double rounding = 49 * 0x1p-53, may_underflow = 1e-97, may_overflow = 1e102;
        const Vec3 u = plane[1] - plane[0], v = plane[2] - plane[0];
        const Vec3 seen[3] = {t[0] - plane[0], t[1] - plane[0], t[2] - plane[0]};
        Vec3 largest = u.cwiseAbs().cwiseMax(v.cwiseAbs());
        for (const Vec3& p : seen) largest = largest.cwiseMax(p.cwiseAbs());
        const bool usual = largest.minCoeff() > may_underflow && largest.maxCoeff() < may_overflow;
        const double bound = usual ? rounding * largest.prod() : infinity;
        const Vec3 normal = u.cross(v);
        for (int k = 0; k < 3; ++k) {
            const double height = normal.dot(seen[k]);
            of[k] = std::abs(height) > bound ? sign(height) : orient3d(plane[0], plane[1], plane[2], t[k]);
        }
    }
    bool all_on_one_side() const { return std::abs(of[0] + of[1] + of[2]) == 3; }
    bool all_zero() const { return of[0] == 0 && of[1] == 0 && of[2] == 0; }

    // The corner that is alone on its side of the plane, where corners in the plane count as on either side.
    int lone_corner() const {
        int k = 0;
        while (of[k] == next(k) || of[k] == last(k) || (of[k] == 0 && next(k) != last(k))) ++k;
        return k;
    }
    int next(int k) const { return of[(k + 1) % 3]; }
    int last(int k) const { return of[(k + 2) % 3]; }
};

// The corners in an order of the same orientation that begins with the lone one, which lies above the other's plane
// once that is turned over where `below` says so.
struct Ordered {
    const Vec3 *lone, *second, *third;
    bool below;
    Ordered(const Corners& t, const Heights& heights) {
        const int k = heights.lone_corner();
        lone = &t[k];
        second = &t[(k + 1) % 3];
        third = &t[(k + 2) % 3];
        below = heights.of[k] < std::max(heights.next(k), heights.last(k));
    }
    void turn_over() { std::swap(second, third); }
};

// Two triangles in planes that cross: the corners in the order in which the planes' common line asks for them.
struct Crossing {
    Ordered a, b;
    Crossing(const Corners& ta, const Corners& tb, const Heights& of_a, const Heights& of_b)
        : a(ta, of_a), b(tb, of_b) {
        if (a.below) b.turn_over();
        if (b.below) a.turn_over();
    }
    // The line passes the triangles in two intervals: does each begin before the other ends?
    bool intervals_overlap() const {
        return orient3d(*a.lone, *a.second, *b.lone, *b.second) <= 0 &&
               orient3d(*a.lone, *a.third, *b.third, *b.lone) <= 0;
    }
    // Where the second of the two begins, and where the first ends.
    CommonSegment ends(const Corners& ta, const Corners& tb) const {
        const bool a_begins = orient3d(*a.lone, *a.third, *b.second, *b.lone) > 0;
        const bool a_ends = orient3d(*a.lone, *a.second, *b.third, *b.lone) <= 0;
        return {a_begins ? exact_crossing(*a.lone, *a.third, tb) : exact_crossing(*b.lone, *b.second, ta),
                a_ends ? exact_crossing(*a.lone, *a.second, tb) : exact_crossing(*b.lone, *b.third, ta)};
    }
};

bool contains(const Corners& t, const Vec3& p) { return segment_meets_triangle(p, p, t); }

// Of two triangles in one plane, or of which one has no area. Where no corner of one lies in the other, two sides cross
// between their ends, or a side passes through a triangle that it is not in one plane with.
Vec3 common_point(const Corners& a, const Corners& b) {
    for (int k = 0; k < 3; ++k) {
        if (contains(b, a[k])) return a[k];
        if (contains(a, b[k])) return b[k];
    }
    for (int i = 0; i < 3; ++i)
        for (const bool of_a : {true, false}) {
            const Corners &sides = of_a ? a : b, &t = of_a ? b : a;
            const Vec3 &p = sides[i], &q = sides[(i + 1) % 3];
            if (!segment_meets_triangle(p, q, t)) continue;
            if (orient3d(t[0], t[1], t[2], p) != 0) return exact_crossing(p, q, t);
            for (int k = 0; k < 3; ++k) {
                const Vec3 &r = t[k], &s = t[(k + 1) % 3];
                if (!segments_intersect(p, q, r, s)) continue;
                Vec3 beside = s;  // r, s and this one lie in a plane that p and q cross
                double& x = beside[std::min(viewing_axis(p, q, r), viewing_axis(p, q, s))];
                x = x == 0 ? 1 : 0;
                return exact_crossing(p, q, {r, s, beside});
            }
        }
    return a[0];
}

}  // namespace

bool triangles_intersect(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
    const Heights of_a(a, b);
    if (of_a.all_on_one_side()) return false;
    const Heights of_b(b, a);
    if (of_b.all_on_one_side()) return false;
    if (of_a.all_zero() || of_b.all_zero()) return a_side_meets_the_other(a, b);
    return Crossing(a, b, of_a, of_b).intervals_overlap();
}

CommonSegment common_segment(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
    const Heights of_a(a, b), of_b(b, a);
    if (!of_a.all_zero() && !of_b.all_zero()) return Crossing(a, b, of_a, of_b).ends(a, b);
    const Vec3 point = common_point(a, b);
    return {point, point};
}

}  // namespace kolize
