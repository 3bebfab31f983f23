#include "framework/solids.h"
#include "narrowphase/two_bodies.h"
#include "oracle/exact_hulls.h"
#include "oracle/exact_triangles.h"

#include <kolize/mesh_narrowphase.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

struct IntegerTetrahedron {
    std::array<oracle::Point, 4> corners;

    TriangleSoup soup() const {
        TriangleSoup soup;
        for (const auto& p : corners) soup.vertices.emplace_back(double(p[0]), double(p[1]), double(p[2]));
        soup.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
        return soup;
    }
    oracle::Corners face(const Triangle& t) const { return {corners[t[0]], corners[t[1]], corners[t[2]]}; }
};

IntegerTetrahedron random_tetrahedron(std::mt19937& random) {
    std::uniform_int_distribution<std::int64_t> coordinate(-1000, 1000);
    IntegerTetrahedron t;
    do
        for (auto& p : t.corners)
            for (auto& x : p) x = coordinate(random);
    while (oracle::orientation(t.corners[0], t.corners[1], t.corners[2], t.corners[3]) <= 0);
    return t;
}

// Intersecting face pairs, or -1 where some pair is degenerate.
int exact_hits(const IntegerTetrahedron& a, const IntegerTetrahedron& b) {
    int hits = 0;
    for (const Triangle& ta : a.soup().triangles)
        for (const Triangle& tb : b.soup().triangles) {
            const auto answer = oracle::triangles(a.face(ta), b.face(tb));
            if (answer == oracle::Answer::degenerate) return -1;
            hits += answer == oracle::Answer::intersect;
        }
    return hits;
}

// Tetrahedron pairs whose number of intersecting faces the plugin gets wrong, of those that can be judged.
std::pair<int, int> wrong_of(const std::string& plugin, std::map<std::string, Value> settings, int rounds) {
    std::mt19937 random(20260101);
    NarrowphaseUnderTest narrowphase(plugin, std::move(settings));
    int wrong = 0, judged = 0;
    for (int round = 0; round < rounds; ++round) {
        const IntegerTetrahedron a = random_tetrahedron(random), b = random_tetrahedron(random);
        const int expected = exact_hits(a, b);
        if (expected < 0) continue;
        const Contacts found = narrowphase.collide({make_mesh("a", a.soup())}, {make_mesh("b", b.soup())});
        ++judged;
        wrong += static_cast<int>(found.triangle_hits) != expected;
    }
    return {wrong, judged};
}

// The second triangle has a corner on the first one or on the line of one of its sides, but for a few roundings; now
// and then all of it lies in the first one's plane.
TrianglePair near_touch(std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-1, 1);
    const auto any = [&] { return Vec3(coordinate(random), coordinate(random), coordinate(random)); };
    TrianglePair pair;
    for (int k = 0; k < 3; ++k) {
        pair.a[k] = any();
        pair.b[k] = any();
    }
    const auto in_plane = [&] {
        const double s = 0.25 * int(random() % 6) - 0.25, t = random() % 3 ? 0.25 * int(random() % 6) - 0.25 : 0;
        Vec3 p = pair.a[0] + s * (pair.a[1] - pair.a[0]) + t * (pair.a[2] - pair.a[0]);
        for (double& x : p) x += (int(random() % 5) - 2) * 0x1p-54;
        return p;
    };
    const bool coplanar = random() % 8 == 0;
    for (int k = 0; k < (coplanar ? 3 : 1); ++k) pair.b[k] = in_plane();
    return pair;
}

bool exact_answer(const TrianglePair& pair) {
    constexpr int exponent = 120;  // no coordinate of near_touch has a finer bit than 2^-107
    std::vector<oracle::BigPoint> hulls[2];
    for (int k = 0; k < 3; ++k)
        for (const bool of_a : {true, false}) {
            const Vec3& p = of_a ? pair.a[k] : pair.b[k];
            hulls[of_a].push_back(
                {oracle::in_units(p[0], exponent), oracle::in_units(p[1], exponent), oracle::in_units(p[2], exponent)});
        }
    return oracle::hulls_intersect(hulls[0], hulls[1]);
}

// Answers of a triangle test by itself, with the pairs scaled by a power of two.
std::vector<std::uint8_t> answers(const std::string& plugin, std::vector<TrianglePair> pairs, int exponent) {
    for (TrianglePair& pair : pairs)
        for (int k = 0; k < 3; ++k) {
            pair.a[k] *= std::ldexp(1.0, exponent);
            pair.b[k] *= std::ldexp(1.0, exponent);
        }
    const auto host = make_host(1);
    const StagePtr<Narrowphase> stage =
        library().make<Narrowphase>({.plugin = plugin, .where = {}, .settings = {}}, *host);
    std::vector<std::uint8_t> hit(pairs.size(), 2);
    dynamic_cast<const TriangleNarrowphase&>(*stage).intersect_triangles(pairs, hit, {});
    return hit;
}

}  // namespace

TEST_CASE("moller is exact where triangles touch or nearly do, at every scale", "[narrowphase]") {
    std::mt19937 random(20260306);
    std::vector<TrianglePair> pairs;
    std::vector<std::uint8_t> expected;
    for (int i = 0; i < 500; ++i) {
        pairs.push_back(near_touch(random));
        expected.push_back(exact_answer(pairs.back()));
    }
    const auto hits = std::count(expected.begin(), expected.end(), 1);
    CHECK(hits > 100);
    CHECK(hits < 400);
    for (const int exponent : {-900, -600, -320, -100, 0, 30, 300, 320, 500, 1000}) {
        CAPTURE(exponent);
        CHECK(answers("moller", pairs, exponent) == expected);
    }
}

TEST_CASE("triangle tests agree with exact arithmetic on random tetrahedra in general position", "[narrowphase]") {
    for (const char* plugin : {"moller", "fcl"}) {
        CAPTURE(plugin);
        const auto [wrong, judged] = wrong_of(plugin, {}, 1500);
        CHECK(judged > 1200);
        CHECK(wrong == 0);
    }
}

TEST_CASE("the angle sum errs where its epsilon fattens the triangle, and float errs more", "[narrowphase]") {
    const auto [wrong_narrow, judged] = wrong_of("angle_sum", {{"epsilon", 1e-6}}, 1500);
    const auto [wrong_wide, same] = wrong_of("angle_sum", {{"epsilon", 0.1}}, 1500);
    REQUIRE(judged == same);
    CHECK(wrong_narrow <= judged / 100);
    CHECK(wrong_wide > wrong_narrow);
    const auto [wrong_float, again] =
        wrong_of("angle_sum", {{"epsilon", 1e-6}, {"precision", std::string("float")}}, 1500);
    CHECK(wrong_float > wrong_narrow);
}

TEST_CASE("asked for overlap only, the walk stops at the first intersecting triangle pair", "[narrowphase]") {
    const Placed a{make_mesh("a", subdivided(subdivided(cone48())))};
    const Placed b{a.shape, Vec3(20, 10, 5), Quat(0.9, 0.1, 0.3, -0.2).normalized()};
    for (const char* plugin : {"moller", "angle_sum", "fcl"}) {
        CAPTURE(plugin);
        NarrowphaseUnderTest narrowphase(plugin);
        const Contacts overlap = narrowphase.collide(a, b, Detail::overlap);
        const Contacts manifold = narrowphase.collide(a, b, Detail::manifold);
        CHECK(overlap.triangle_hits == 1);
        CHECK(manifold.triangle_hits > 100);
        CHECK(10 * overlap.triangle_tests < manifold.triangle_tests);
        REQUIRE(overlap.rows.size() == 1);
        CHECK(overlap.rows[0].normal.isZero());
        CHECK(overlap.rows[0].depth == 0);
    }
}
