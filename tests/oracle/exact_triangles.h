// Oracle: do two closed triangles with integer corners intersect? In exact arithmetic.
#pragma once

#include <array>
#include <cstdint>

namespace oracle {

using Int = __int128;
using Point = std::array<std::int64_t, 3>;
using Corners = std::array<Point, 3>;

// Sign of the volume of the tetrahedron (a, b, c, d); exact for coordinates below 2^40.
inline int orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
    Int m[3][3];
    for (int k = 0; k < 3; ++k) {
        m[0][k] = Int(b[k]) - a[k];
        m[1][k] = Int(c[k]) - a[k];
        m[2][k] = Int(d[k]) - a[k];
    }
    const Int volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return (volume > 0) - (volume < 0);
}

enum class Answer { apart, intersect, degenerate };

// A segment against a triangle, where no four of the five points lie in a plane.
inline Answer segment_triangle(const Point& p, const Point& q, const Corners& t) {
    const int above = orientation(t[0], t[1], t[2], p), below = orientation(t[0], t[1], t[2], q);
    const int u = orientation(p, q, t[0], t[1]), v = orientation(p, q, t[1], t[2]), w = orientation(p, q, t[2], t[0]);
    if (!above || !below || !u || !v || !w) return Answer::degenerate;
    return above != below && u == v && v == w ? Answer::intersect : Answer::apart;
}

// In general position two triangles intersect exactly when an edge of one goes through the other.
inline Answer triangles(const Corners& a, const Corners& b) {
    bool any = false;
    for (int k = 0; k < 3; ++k)
        for (const bool of_a : {true, false}) {
            const Corners &edges = of_a ? a : b, &face = of_a ? b : a;
            const Answer answer = segment_triangle(edges[k], edges[(k + 1) % 3], face);
            if (answer == Answer::degenerate) return answer;
            any = any || answer == Answer::intersect;
        }
    return any ? Answer::intersect : Answer::apart;
}

}  // namespace oracle
