#include "oracle/exact_hulls.h"

#include <kolize/predicates.h>

#include <catch2/catch.hpp>

#include <random>

using namespace kolize;

namespace {

struct Corners {
    Vec3 at[3];
};

Corners corners(const Vec3& p, const Vec3& q, const Vec3& r) { return {{p, q, r}}; }

constexpr int finest = 1074;  // every double is a whole number of 2^-1074

oracle::BigPoint exact(const Vec3& p, int exponent) {
    return {oracle::in_units(p[0], exponent), oracle::in_units(p[1], exponent), oracle::in_units(p[2], exponent)};
}

bool exact_answer(const Corners& a, const Corners& b, int exponent) {
    std::vector<oracle::BigPoint> pa, pb;
    for (int k = 0; k < 3; ++k) {
        pa.push_back(exact(a.at[k], exponent));
        pb.push_back(exact(b.at[k], exponent));
    }
    return oracle::hulls_intersect(pa, pb);
}

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int exponent) {
    const oracle::BigPoint p = exact(a, exponent);
    const auto seen = [&](const Vec3& q) { return oracle::minus(exact(q, exponent), p); };
    return oracle::dot(oracle::cross(seen(b), seen(c)), seen(d)).sign();
}

// In whatever order the corners and the triangles are given.
void check_all_orders(const Corners& a, const Corners& b, bool expected) {
    for (int turn = 0; turn < 3; ++turn)
        for (const bool flip : {false, true}) {
            const Corners t = corners(a.at[turn], a.at[(turn + (flip ? 2 : 1)) % 3], a.at[(turn + (flip ? 1 : 2)) % 3]);
            CHECK(triangles_intersect(t.at, b.at) == expected);
            CHECK(triangles_intersect(b.at, t.at) == expected);
        }
}

}  // namespace

TEST_CASE("orient3d has the sign of exact arithmetic where floating point is lost in rounding", "[predicates]") {
    std::mt19937_64 random(11);
    std::uniform_int_distribution<int> step(-3, 3);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    int zero = 0, wrong_in_floats = 0;
    for (int round = 0; round < 3000; ++round) {
        // Four points that are coplanar but for a few units in the last place.
        const auto any = [&] { return Vec3(coordinate(random), coordinate(random), coordinate(random)); };
        Vec3 p[4] = {any(), any(), any(), Vec3::Zero()};
        p[3] = p[0] + 0.25 * (p[1] - p[0]) + 0.5 * (p[2] - p[0]);
        for (double& x : p[3]) x += step(random) * 0x1p-53;
        const int expected = exact_orientation(p[0], p[1], p[2], p[3], 120);
        CAPTURE(round);
        CHECK(orient3d(p[0], p[1], p[2], p[3]) == expected);
        CHECK(orient3d(p[1], p[0], p[2], p[3]) == -expected);
        CHECK(orient3d(p[3], p[2], p[1], p[0]) == expected);
        const double in_floats = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
        wrong_in_floats += ((in_floats > 0) - (in_floats < 0)) != expected;
        zero += expected == 0;
    }
    CHECK(wrong_in_floats > 100);  // or the points would be no test
    CHECK(zero < 3000);
}

TEST_CASE("orient3d is exact for coordinates of any magnitude, mixed at will", "[predicates]") {
    std::mt19937_64 random(12);
    std::uniform_int_distribution<int> exponent(-1074, 1023), shared(0, 2);
    std::uniform_real_distribution<double> mantissa(-2, 2);
    int signs[3] = {0, 0, 0};
    for (int round = 0; round < 2000; ++round) {
        Vec3 p[4];
        for (Vec3& q : p)
            for (double& x : q) x = std::ldexp(mantissa(random), exponent(random) - (round % 2 ? 0 : 60));
        // Coordinates in common, so that large parts cancel.
        for (int k = 1; k < 4; ++k)
            for (int i = 0; i < 3; ++i)
                if (shared(random) == 0) p[k][i] = p[0][i];
        for (Vec3& q : p)
            for (double& x : q) x = std::clamp(x, -1e308, 1e308);
        const int expected = exact_orientation(p[0], p[1], p[2], p[3], finest);
        CAPTURE(round, p[0], p[1], p[2], p[3]);
        CHECK(orient3d(p[0], p[1], p[2], p[3]) == expected);
        ++signs[expected + 1];
    }
    CHECK(std::min({signs[0], signs[1], signs[2]}) > 100);
}

TEST_CASE("triangles on a coarse grid intersect exactly as their hulls do", "[predicates]") {
    // So coarse that most pairs touch, are coplanar, share corners, or have no area.
    std::mt19937_64 random(13);
    int intersecting = 0;
    for (int round = 0; round < 6000; ++round) {
        std::uniform_int_distribution<int> coordinate(0, 1 + round % 4);
        const bool flat = round % 3 == 0;
        Corners t[2];
        for (Corners& c : t)
            for (Vec3& p : c.at) p = Vec3(coordinate(random), coordinate(random), flat ? 0 : coordinate(random));
        const bool expected = exact_answer(t[0], t[1], 0);
        CAPTURE(round);
        check_all_orders(t[0], t[1], expected);
        intersecting += expected;
    }
    CHECK(intersecting > 1000);
    CHECK(intersecting < 5000);
}

TEST_CASE("N1 coplanar: triangles 10^-k apart, k = 0..300, never touch, and at 0 they do", "[predicates][N1]") {
    const Corners fixed = corners(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
    const Corners over[4] = {
        corners(Vec3(0.25, 0.25, 0), Vec3(1.25, 0.25, 0), Vec3(0.25, 1.25, 0)),     // overlaps
        corners(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)),                       // shares an edge
        corners(Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(1, -1, 0)),                      // shares a corner
        corners(Vec3(0.125, 0.125, 0), Vec3(0.25, 0.125, 0), Vec3(0.125, 0.25, 0))  // lies inside
    };
    for (const Corners& flat : over) {
        check_all_orders(fixed, flat, true);
        // Hinged on its last edge: touches just where that edge does, however far the first corner is lifted.
        const bool edge_touches = exact_answer(fixed, corners(flat.at[1], flat.at[1], flat.at[2]), finest);
        for (int k = 0; k <= 300; ++k)
            for (const double side : {1.0, -1.0}) {
                Corners raised = flat, hinged = flat;
                for (Vec3& p : raised.at) p.z() = side * std::pow(10.0, -k);
                hinged.at[0].z() = side * std::pow(10.0, -k);
                CAPTURE(k, side);
                CHECK_FALSE(triangles_intersect(fixed.at, raised.at));
                CHECK_FALSE(triangles_intersect(raised.at, fixed.at));
                CHECK(triangles_intersect(fixed.at, hinged.at) == edge_touches);
                CHECK(triangles_intersect(hinged.at, fixed.at) == edge_touches);
                if (k % 60 == 0) {
                    CHECK_FALSE(exact_answer(fixed, raised, finest));
                    CHECK(exact_answer(fixed, hinged, finest) == edge_touches);
                }
            }
    }
}

TEST_CASE("N2 needle: triangles of aspect 10^k, k = 0..15, against each other", "[predicates][N2]") {
    std::mt19937_64 random(14);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    int intersecting = 0, all = 0;
    for (int k = 0; k <= 15; ++k)
        for (int round = 0; round < 40; ++round) {
            const double width = std::pow(10.0, -k);
            const auto needle = [&](double along) {
                const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
                const Vec3 q = along * p + 0.5 * Vec3(coordinate(random), coordinate(random), coordinate(random));
                const Vec3 r = q + width * Vec3(coordinate(random), coordinate(random), coordinate(random));
                return corners(p, q, r);
            };
            const Corners a = needle(-1);
            Corners b = needle(-1);
            // Through a point of the other one, within its width, or it would nearly always miss.
            const Vec3 onto = 0.5 * (a.at[0] + a.at[1]) + width * coordinate(random) * Vec3(1, 1, 1);
            const Vec3 shift = onto - 0.5 * (b.at[0] + b.at[2]);
            for (Vec3& p : b.at) p += shift;
            const bool expected = exact_answer(a, b, 120);
            CAPTURE(k, round);
            CHECK(triangles_intersect(a.at, b.at) == expected);
            CHECK(triangles_intersect(b.at, a.at) == expected);
            intersecting += expected;
            ++all;
        }
    CHECK(intersecting > all / 20);
    CHECK(intersecting < all - all / 20);
}

TEST_CASE("N3 edge point: segments through the edge of a triangle, within one ulp, 10^5 of them", "[predicates][N3]") {
    using Wide = boost::multiprecision::int256_t;
    const auto orientation = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        const auto units = [](double x) { return static_cast<std::int64_t>(std::ldexp(x, 60)); };
        Wide m[3][3];
        for (int k = 0; k < 3; ++k) {
            m[0][k] = units(b[k]) - units(a[k]);
            m[1][k] = units(c[k]) - units(a[k]);
            m[2][k] = units(d[k]) - units(a[k]);
        }
        const Wide v = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        return v.sign();
    };
    std::mt19937_64 random(15);
    std::uniform_real_distribution<double> coordinate(0.0625, 0.9375);
    std::uniform_int_distribution<int> ulp(-1, 1);
    // Whole numbers of 2^-60 in (0, 1): the oracle's determinants fit in 256 bits.
    const auto any = [&] { return Vec3(coordinate(random), coordinate(random), coordinate(random)); };
    int wrong = 0, judged = 0, hits = 0;
    for (int round = 0; round < 100000; ++round) {
        const Corners t = corners(any(), any(), any());
        const double part = coordinate(random);
        const Vec3 on_edge = t.at[0] + part * (t.at[1] - t.at[0]), p = any();
        Vec3 q = on_edge + (on_edge - p);
        for (double& x : q) x += ulp(random) * 0x1p-53;
        if (q.minCoeff() < 0.03125 || q.maxCoeff() > 1) continue;
        const int hp = orientation(t.at[0], t.at[1], t.at[2], p), hq = orientation(t.at[0], t.at[1], t.at[2], q);
        if (hp * hq >= 0) continue;
        const int a = orientation(p, q, t.at[0], t.at[1]), b = orientation(p, q, t.at[1], t.at[2]),
                  c = orientation(p, q, t.at[2], t.at[0]);
        const bool expected = (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
        const Corners segment = corners(p, q, q);
        wrong += triangles_intersect(t.at, segment.at) != expected;
        wrong += triangles_intersect(segment.at, t.at) != expected;
        hits += expected;
        ++judged;
    }
    CHECK(judged > 30000);
    CHECK(hits > judged / 4);
    CHECK(hits < judged - judged / 4);
    CHECK(wrong == 0);
}

TEST_CASE("points and segments touch triangles and each other exactly where they should", "[predicates]") {
    const Corners t = corners(Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0));
    const auto point = [](const Vec3& p) { return corners(p, p, p); };
    const auto segment = [](const Vec3& p, const Vec3& q) { return corners(p, q, q); };
    check_all_orders(t, point(Vec3(1, 1, 0)), true);
    check_all_orders(t, point(Vec3(2, 2, 0)), true);
    check_all_orders(t, point(Vec3(4, 0, 0)), true);
    check_all_orders(t, point(Vec3(2, 2.0000000000000004, 0)), false);
    check_all_orders(t, point(Vec3(1, 1, 1e-320)), false);
    check_all_orders(t, segment(Vec3(1, 1, -1), Vec3(1, 1, 1)), true);
    check_all_orders(t, segment(Vec3(1, 1, 0), Vec3(1, 1, 1)), true);
    check_all_orders(t, segment(Vec3(-1, -1, 0), Vec3(5, 5, 0)), true);
    check_all_orders(t, segment(Vec3(5, 0, 0), Vec3(6, 0, 0)), false);
    check_all_orders(t, segment(Vec3(4, 0, 0), Vec3(6, 0, 0)), true);
    check_all_orders(segment(Vec3(0, 0, 0), Vec3(2, 2, 2)), segment(Vec3(1, 1, 1), Vec3(3, 3, 3)), true);
    check_all_orders(segment(Vec3(0, 0, 0), Vec3(2, 2, 2)), segment(Vec3(3, 3, 3), Vec3(4, 4, 4)), false);
    check_all_orders(segment(Vec3(0, 0, 0), Vec3(2, 2, 0)), segment(Vec3(0, 2, 0), Vec3(2, 0, 0)), true);
    check_all_orders(segment(Vec3(0, 0, 0), Vec3(2, 2, 0)), segment(Vec3(0, 2, 1), Vec3(2, 0, 1)), false);
    check_all_orders(point(Vec3(1, 2, 3)), point(Vec3(1, 2, 3)), true);
    check_all_orders(point(Vec3(1, 2, 3)), point(Vec3(1, 2, 4)), false);
}
