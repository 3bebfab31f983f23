// The curve of intersection where nothing is in general position: bodies of unit cubes on the integer grid.
#include "contact_model/curve.h"
#include "oracle/polycubes.h"

#include <kolize/predicates.h>

#include <catch2/catch.hpp>

using namespace kolize;

namespace {

struct GridBody {
    std::set<oracle::Cell> cells;
    std::shared_ptr<const Mesh> mesh;
};

GridBody random_body(std::mt19937_64& random) {
    for (;;) {
        GridBody body;
        body.cells = oracle::random_cells(random, 1 + random() % 12);
        const TriangleSoup soup = oracle::surface(body.cells, random);
        if (!inspect(soup).closed()) continue;
        body.mesh = build_mesh(soup, true);
        return body;
    }
}

// A turn that maps the grid onto itself.
Mat3 random_turn(std::mt19937_64& random) {
    Mat3 turn = Mat3::Zero();
    const int first = static_cast<int>(random() % 3), handed = random() % 2 ? 1 : 2;
    for (int k = 0; k < 3; ++k) turn((first + handed * k) % 3, k) = random() % 2 ? 1 : -1;
    if (turn.determinant() < 0) turn.col(0) *= -1;
    return turn;
}

std::vector<TriangleHit> closed_hits(const MeshPair& pair) {
    std::vector<TriangleHit> hits;
    for (std::uint32_t i = 0; i < pair.a.triangles.size(); ++i)
        for (std::uint32_t j = 0; j < pair.b.triangles.size(); ++j) {
            Vec3 a[3], b[3];
            Aabb box_a, box_b;
            for (int k = 0; k < 3; ++k) {
                box_a.include(a[k] = pair.a.vertices[pair.a.triangles[i][k]]);
                box_b.include(b[k] = pair.b_to_a * pair.b.vertices[pair.b.triangles[j][k]]);
            }
            if (box_a.overlaps(box_b) && triangles_intersect(a, b)) hits.push_back({i, j, {}});
        }
    return hits;
}

std::set<oracle::Cell> placed(const std::set<oracle::Cell>& cells, const Transform& at) {
    std::set<oracle::Cell> result;
    for (const auto& [x, y, z] : cells) {
        const Vec3 center = at * Vec3(x + 0.5, y + 0.5, z + 0.5);
        result.insert({int(std::floor(center.x())), int(std::floor(center.y())), int(std::floor(center.z()))});
    }
    return result;
}

// Which way the infinitesimal step goes along each axis: towards B, and where that is neither, like the longest axis.
oracle::Cell nudge_signs(const Vec3& towards_b) {
    int longest = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(towards_b[k]) > std::abs(towards_b[longest])) longest = k;
    oracle::Cell signs;
    for (int k = 0; k < 3; ++k)
        signs[k] = towards_b[k] > 0 ? 1 : towards_b[k] < 0 ? -1 : towards_b[longest] < 0 ? -1 : 1;
    return signs;
}

// Crossings that are not exactly once a start and once an end.
std::size_t open_crossings(const std::vector<ContourSegment>& segments) {
    std::map<std::uint64_t, std::pair<int, int>> uses;
    for (const ContourSegment& s : segments) {
        ++uses[s.from.key].first;
        ++uses[s.to.key].second;
    }
    return static_cast<std::size_t>(
        std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second != std::pair(1, 1); }));
}

Vec3 area(const std::vector<ContourSegment>& segments) {
    Vec3 sum = Vec3::Zero();
    for (const ContourSegment& s : segments) sum += 0.5 * s.from.point.cross(s.to.point);
    return sum;
}

std::size_t regions(const std::vector<ContourSegment>& segments) {
    std::set<std::uint32_t> ids;
    for (const ContourSegment& s : segments) ids.insert(s.region);
    return ids.size();
}

}  // namespace

TEST_CASE("the curve of two bodies on a grid is closed, and its area is the gradient of their overlap",
          "[narrowphase][contour]") {
    std::mt19937_64 random(21);
    ContourScratch scratch;
    std::size_t crossing = 0, several = 0;
    for (int round = 0; round < 3000; ++round) {
        const GridBody a = random_body(random), b = random_body(random);
        Transform b_to_a;
        b_to_a.rotation = random_turn(random);
        for (double& x : b_to_a.translation) x = static_cast<double>(random() % 5) - 2;
        const MeshPair pair{*a.mesh, *b.mesh, b_to_a};
        const auto hits = closed_hits(pair);
        Nudge nudge(b_to_a.translation);
        find_segments(pair, hits, nudge, scratch);
        CAPTURE(round, b_to_a.rotation, b_to_a.translation);
        REQUIRE(open_crossings(scratch.segments) == 0);
        const oracle::NudgedOverlap overlap(a.cells, placed(b.cells, b_to_a), nudge_signs(b_to_a.translation));
        const auto [x, y, z] = overlap.gradient();
        CHECK((area(scratch.segments) - Vec3(x, y, z)).norm() < 1e-12);
        if (scratch.segments.empty()) continue;
        join_segments(pair, scratch);
        CHECK(regions(scratch.segments) == overlap.components());
        ++crossing;
        several += overlap.components() > 1;
    }
    CHECK(crossing > 1200);
    CHECK(several > 30);
}

TEST_CASE("a loop is closed over triangle pairs that the triangle test has missed", "[narrowphase][contour]") {
    std::mt19937_64 random(22);
    ContourScratch whole, mended;
    std::size_t missed = 0;
    for (int round = 0; round < 150; ++round) {
        const GridBody a = random_body(random), b = random_body(random);
        Transform b_to_a;
        for (double& x : b_to_a.translation) x = static_cast<double>(random() % 5) - 2;
        const MeshPair pair{*a.mesh, *b.mesh, b_to_a};
        auto hits = closed_hits(pair);
        Nudge nudge(b_to_a.translation);
        find_segments(pair, hits, nudge, whole);
        // Every loop keeps one of its pairs.
        join_segments(pair, whole);
        missed += std::erase_if(hits, [&](const TriangleHit& hit) {
            const auto at = std::find_if(whole.segments.begin(), whole.segments.end(), [&](const ContourSegment& s) {
                return s.triangle_a == hit.a && s.triangle_b == hit.b;
            });
            const bool only_one = at != whole.segments.end() && at->loop == at - whole.segments.begin();
            return at != whole.segments.end() && !only_one && random() % 2;
        });
        find_segments(pair, hits, nudge, mended);
        CAPTURE(round);
        REQUIRE(mended.segments.size() == whole.segments.size());
        for (std::size_t i = 0; i < whole.segments.size(); ++i) {
            CHECK(mended.segments[i].from.key == whole.segments[i].from.key);
            CHECK(mended.segments[i].to.key == whole.segments[i].to.key);
        }
    }
    CHECK(missed > 500);
}
