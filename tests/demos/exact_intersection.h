// Whether triangles of a mesh cross, in exact integer arithmetic: coordinates are whole multiples of a unit, below 2^30
// of them, so that the determinants fit into 128 bits.
#pragma once

#include <kolize/mesh.h>

#include <array>
#include <cmath>

namespace kolize::test {

using Integer = __int128;
using Point = std::array<std::int64_t, 3>;

inline int sign(Integer x) { return (x > 0) - (x < 0); }

// Six times the signed volume of a tetrahedron.
inline int orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
    Integer m[3][3];
    for (int i = 0; i < 3; ++i) {
        m[0][i] = a[i] - d[i];
        m[1][i] = b[i] - d[i];
        m[2][i] = c[i] - d[i];
    }
    return sign(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) + m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
                m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]));
}

// The same in the plane that is left when one axis is dropped.
inline int orientation(const Point& a, const Point& b, const Point& c, int dropped) {
    const int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
    return sign(Integer(b[u] - a[u]) * (c[v] - a[v]) - Integer(b[v] - a[v]) * (c[u] - a[u]));
}

// An axis along which the triangle is not seen edge-on.
inline int good_axis(const Point& a, const Point& b, const Point& c) {
    int axis = 0;
    while (axis < 2 && orientation(a, b, c, axis) == 0) ++axis;
    return axis;
}

inline bool between(const Point& a, const Point& b, const Point& p) {  // p is on their line
    for (int i = 0; i < 3; ++i)
        if (p[i] < std::min(a[i], b[i]) || p[i] > std::max(a[i], b[i])) return false;
    return true;
}

// Closed segments of one plane.
inline bool segments_meet(const Point& p, const Point& q, const Point& a, const Point& b, int dropped) {
    const int sp = orientation(a, b, p, dropped), sq = orientation(a, b, q, dropped);
    const int sa = orientation(p, q, a, dropped), sb = orientation(p, q, b, dropped);
    if (sp * sq < 0 && sa * sb < 0) return true;
    return (sp == 0 && between(a, b, p)) || (sq == 0 && between(a, b, q)) || (sa == 0 && between(p, q, a)) ||
           (sb == 0 && between(p, q, b));
}

// A closed segment and a closed triangle.
inline bool segment_meets(const Point& p, const Point& q, const std::array<Point, 3>& t) {
    const int sp = orientation(t[0], t[1], t[2], p), sq = orientation(t[0], t[1], t[2], q);
    if (sp * sq > 0) return false;
    if (sp == 0 && sq == 0) {
        const int axis = good_axis(t[0], t[1], t[2]);
        bool left = false, right = false;
        for (int k = 0; k < 3; ++k) {
            if (segments_meet(p, q, t[k], t[(k + 1) % 3], axis)) return true;
            const int side = orientation(t[k], t[(k + 1) % 3], p, axis);
            left |= side > 0;
            right |= side < 0;
        }
        return !(left && right);
    }
    bool positive = false, negative = false;
    for (int k = 0; k < 3; ++k) {
        const int side = orientation(p, q, t[k], t[(k + 1) % 3]);
        positive |= side > 0;
        negative |= side < 0;
    }
    return !(positive && negative);
}

// Whether two triangles of a mesh share more than the vertices that they name both.
inline bool cross(const std::vector<Point>& points, const Triangle& a, const Triangle& b) {
    const auto corners = [&](const Triangle& t) { return std::array{points[t[0]], points[t[1]], points[t[2]]}; };
    const auto names = [](const Triangle& t, std::uint32_t v) { return t[0] == v || t[1] == v || t[2] == v; };
    int shared = 0;
    for (const std::uint32_t v : a) shared += names(b, v);
    if (shared == 2) {  // folded onto each other?
        std::uint32_t apex_a = 0, apex_b = 0, edge[2] = {};
        int found = 0;
        for (const std::uint32_t v : a) names(b, v) ? edge[found++] = v : apex_a = v;
        for (const std::uint32_t v : b)
            if (!names(a, v)) apex_b = v;
        const Point &e = points[edge[0]], &f = points[edge[1]], &p = points[apex_a], &q = points[apex_b];
        const int axis = good_axis(e, f, p);
        return orientation(e, f, p, q) == 0 && orientation(e, f, p, axis) == orientation(e, f, q, axis);
    }
    const auto crosses_sides_of = [&](const Triangle& t, const Triangle& other) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t from = t[k], to = t[(k + 1) % 3];
            if (names(other, from) || names(other, to)) continue;
            if (segment_meets(points[from], points[to], corners(other))) return true;
        }
        return false;
    };
    return crosses_sides_of(a, b) || crosses_sides_of(b, a);
}

// The number of pairs of triangles that cross. Every coordinate is a multiple of `unit`.
inline int self_intersections(const TriangleSoup& soup, double unit) {
    std::vector<Point> points;
    for (const Vec3& v : soup.vertices)
        points.push_back({std::llround(v.x() / unit), std::llround(v.y() / unit), std::llround(v.z() / unit)});
    int count = 0;
    for (std::size_t i = 0; i < soup.triangles.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) count += cross(points, soup.triangles[i], soup.triangles[j]);
    return count;
}

}  // namespace kolize::test
