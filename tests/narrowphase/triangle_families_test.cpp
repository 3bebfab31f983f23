#include "conformance/triangle_families.h"
#include "narrowphase/two_bodies.h"
#include "oracle/rational_triangles.h"

#include <kolize/predicates.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;
using oracle::RationalTriangles;
using oracle::triangles_meet;

namespace {

using Settings = std::map<std::string, Value>;
using Answers = std::vector<std::uint8_t>;

std::vector<TrianglePair> pairs_of_all(int count_of_each, std::uint64_t seed) {
    std::vector<TrianglePair> all;
    for (const auto& family : triangle_families())
        for (const TrianglePair& pair : triangle_pairs(family, count_of_each, seed++)) all.push_back(pair);
    return all;
}

class TriangleTest {
public:
    explicit TriangleTest(const std::string& plugin, const Settings& settings = {})
        : host_(make_host(1)), stage_(library().make<Narrowphase>(configured(plugin, settings), *host_)) {}
    Answers answers(std::span<const TrianglePair> pairs, std::span<TriangleSegment> segments = {}) const {
        Answers hit(pairs.size(), 2);
        dynamic_cast<const TriangleNarrowphase&>(*stage_).intersect_triangles(pairs, hit, segments);
        return hit;
    }

private:
    static StageConfig configured(const std::string& plugin, const Settings& settings) {
        StageConfig config;
        config.plugin = plugin;
        for (const auto& [key, value] : settings) config.settings[key] = {value, {}};
        return config;
    }

    std::unique_ptr<Host> host_;
    StagePtr<Narrowphase> stage_;
};

Settings with(const std::string& key, const std::string& value) { return {{key, value}}; }

oracle::BigPoint in_units(const Vec3& p, int exponent) {
    return {oracle::in_units(p[0], exponent), oracle::in_units(p[1], exponent), oracle::in_units(p[2], exponent)};
}

// The distance between two points, in units of what rounding may do to coordinates of their size.
double roundings_between(const Vec3& p, const Vec3& q) {
    double most = 0;
    for (int i = 0; i < 3; ++i) {
        const double size = std::max(std::abs(p[i]), std::abs(q[i]));
        if (size > 0) most = std::max(most, std::abs(p[i] - q[i]) / (0x1p-53 * size));
    }
    return most;
}

double nearest(const Vec3& p, const std::vector<Vec3>& points) {
    double least = infinity;
    for (const Vec3& q : points) least = std::min(least, roundings_between(p, q));
    return least;
}

}  // namespace

TEST_CASE("the two oracles of intersecting triangles agree, and the families have hits and misses", "[narrowphase]") {
    constexpr std::uint64_t seed = 20261101;
    std::size_t with_misses = 0;
    for (const auto& family : triangle_families()) {
        CAPTURE(family.name, seed);
        int hits = 0, wrong = 0;
        const auto pairs = triangle_pairs(family, 30, seed);
        for (const TrianglePair& pair : pairs) {
            constexpr int finest = 1074;
            std::vector<oracle::BigPoint> a, b;
            for (int k = 0; k < 3; ++k) {
                a.push_back(in_units(pair.a[k], finest));
                b.push_back(in_units(pair.b[k], finest));
            }
            const bool meet = triangles_meet(pair.a, pair.b);
            wrong += meet != oracle::hulls_intersect(a, b);
            hits += meet;
        }
        CHECK(wrong == 0);
        CHECK(hits > 0);
        with_misses += hits < 30;
    }
    CHECK(with_misses == triangle_families().size() - 3);  // sides that touch, and what is shared
}

TEST_CASE("exact decides as rational arithmetic does, in every family", "[narrowphase]") {
    constexpr std::uint64_t seed = 20261102;
    const TriangleTest exact("exact");
    for (const auto& family : triangle_families()) {
        CAPTURE(family.name, seed);
        const auto pairs = triangle_pairs(family, 1700, seed);
        Answers expected;
        for (const TrianglePair& pair : pairs) expected.push_back(triangles_meet(pair.a, pair.b));
        CHECK(exact.answers(pairs) == expected);
    }
}

TEST_CASE("what exact gives as the common segment lies within a few roundings of the exact one", "[narrowphase]") {
    constexpr std::uint64_t seed = 20261103;
    constexpr double few = 16;
    for (const auto& family : triangle_families()) {
        int checked = 0;
        for (const TrianglePair& pair : triangle_pairs(family, 400, seed)) {
            if (!triangles_intersect(pair.a, pair.b)) continue;
            CAPTURE(family.name, seed, ++checked);
            const std::vector<Vec3> exact = RationalTriangles(pair.a, pair.b).shared_points();
            const CommonSegment common = common_segment(pair.a, pair.b);
            REQUIRE(common.begin.allFinite());
            REQUIRE(common.end.allFinite());
            CHECK(nearest(common.begin, exact) < few);
            CHECK(nearest(common.end, exact) < few);
            if (family.name == "in one plane" || family.name == "without area") continue;
            for (const Vec3& p : exact)
                CHECK(std::min(roundings_between(p, common.begin), roundings_between(p, common.end)) < few);
        }
        CHECK(checked > 10);
    }
}

TEST_CASE("plain tests in double are right in general position", "[narrowphase]") {
    constexpr std::uint64_t seed = 20261104;
    CAPTURE(seed);
    const auto pairs = triangle_pairs(triangle_families().front(), 20000, seed);
    const Answers expected = TriangleTest("exact").answers(pairs);
    CHECK(TriangleTest("moller").answers(pairs) == expected);
    CHECK(TriangleTest("guigue_devillers").answers(pairs) == expected);
}

TEST_CASE("moller in double is exact in every family", "[narrowphase]") {
    constexpr std::uint64_t seed = 20261105;
    CAPTURE(seed);
    const auto pairs = pairs_of_all(500, seed);
    CHECK(TriangleTest("moller").answers(pairs) == TriangleTest("exact").answers(pairs));
}

TEST_CASE("guigue_devillers answers alike with every instruction set", "[narrowphase]") {
    constexpr std::uint64_t seed = 20261106;
    const auto pairs = pairs_of_all(300, seed);
    for (const char* precision : {"double", "float"}) {
        const TriangleTest best("guigue_devillers", with("precision", precision));
        std::vector<TriangleSegment> expected_segments(pairs.size()), segments(pairs.size());
        const Answers expected = best.answers(pairs, expected_segments);
        for (const char* instructions : {"sse2", "avx2", "avx512"}) {
            CAPTURE(seed, precision, instructions);
            try {
                const TriangleTest test("guigue_devillers", {{"precision", std::string(precision)},
                                                             {"instructions", std::string(instructions)}});
                CHECK(test.answers(pairs, segments) == expected);
            } catch (const Error& error) {
                CHECK(std::string(error.what()).find("this processor") != std::string::npos);
                continue;
            }
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (!expected[i]) continue;
                CHECK(segments[i].p == expected_segments[i].p);
                CHECK(segments[i].q == expected_segments[i].q);
            }
        }
    }
}

TEST_CASE("a triangle test answers a pair alike in a batch of any length, with segments and without", "[narrowphase]") {
    constexpr std::uint64_t seed = 20261107;
    const auto pairs = pairs_of_all(20, seed);
    for (const char* plugin : {"guigue_devillers", "exact", "moller", "angle_sum"})
        for (const char* precision : {"double", "float"}) {
            if (plugin == std::string("exact") && precision == std::string("float")) continue;
            CAPTURE(seed, plugin, precision);
            const TriangleTest test(plugin, plugin == std::string("exact") ? Settings{} : with("precision", precision));
            const Answers expected = test.answers(pairs);
            std::vector<TriangleSegment> segments(pairs.size());
            CHECK(test.answers(pairs, segments) == expected);
            for (std::size_t length = 1; length < 20; ++length) {
                const std::size_t first = 7 * length;
                const Answers part = test.answers(std::span(pairs).subspan(first, length));
                CHECK(std::equal(part.begin(), part.end(), expected.begin() + static_cast<std::ptrdiff_t>(first)));
            }
            CHECK(test.answers({}).empty());
        }
}

TEST_CASE("segments of plain tests are those of exact arithmetic where triangles cross plainly", "[narrowphase]") {
    constexpr std::uint64_t seed = 20261108;
    const auto pairs = triangle_pairs(triangle_families().front(), 2000, seed);
    for (const char* plugin : {"guigue_devillers", "moller", "angle_sum"})
        for (const auto& [precision, tolerance] : {std::pair("double", 1e-9), std::pair("float", 1e-2)}) {
            const TriangleTest test(plugin, with("precision", precision));
            std::vector<TriangleSegment> segments(pairs.size());
            const Answers hit = test.answers(pairs, segments);
            int far = 0, hits = 0;
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (!hit[i] || !triangles_intersect(pairs[i].a, pairs[i].b)) continue;
                const CommonSegment exact = common_segment(pairs[i].a, pairs[i].b);
                const TriangleSegment& s = segments[i];
                const double as_is = (s.p - exact.begin).norm() + (s.q - exact.end).norm();
                const double swapped = (s.q - exact.begin).norm() + (s.p - exact.end).norm();
                far += std::min(as_is, swapped) > tolerance;
                ++hits;
            }
            CAPTURE(seed, plugin, precision, hits);
            CHECK(hits > 400);
            CHECK(far <= hits / 100);  // planes that nearly coincide
        }
}

TEST_CASE("in float the distance from the origin costs nothing: differences are taken before narrowing",
          "[narrowphase]") {
    constexpr std::uint64_t seed = 20261109;
    std::vector<TrianglePair> near, far;
    for (const auto& name : {"corner touches", "sides touch", "in one plane"})
        for (const auto& family : triangle_families())
            if (family.name == name)
                for (const TrianglePair& pair : triangle_pairs(family, 500, seed)) near.push_back(pair);
    far = near;
    for (TrianglePair& pair : far)
        for (int k = 0; k < 3; ++k) {
            pair.a[k] += Vec3(0x1p40, -0x1p41, 0x1p42);
            pair.b[k] += Vec3(0x1p40, -0x1p41, 0x1p42);
        }
    for (const char* plugin : {"guigue_devillers", "moller", "angle_sum"}) {
        CAPTURE(seed, plugin);
        const TriangleTest test(plugin, with("precision", "float"));
        CHECK(test.answers(near) == test.answers(far));
    }
}
