// The walk over two hierarchies and the exact triangle test, against brute force with the exact predicate.
#include "framework/solids.h"
#include "narrowphase/two_bodies.h"

#include <kolize/mesh_narrowphase.h>
#include <kolize/predicates.h>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace kolize;
using namespace kolize::test;

namespace {

using IdPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// Any soup, closed or not, about the origin of its frame.
std::shared_ptr<const Mesh> mesh_of(const TriangleSoup& soup) { return build_mesh(soup, false); }

IdPairs brute_force(const MeshPair& pair) {
    IdPairs found;
    for (std::uint32_t i = 0; i < pair.a.triangles.size(); ++i)
        for (std::uint32_t j = 0; j < pair.b.triangles.size(); ++j) {
            Vec3 a[3], b[3];
            for (int k = 0; k < 3; ++k) {
                a[k] = pair.a.vertices[pair.a.triangles[i][k]];
                b[k] = pair.b_to_a * pair.b.vertices[pair.b.triangles[j][k]];
            }
            if (triangles_intersect(a, b)) found.emplace_back(i, j);
        }
    return found;
}

class Walker {
public:
    Walker()
        : host_(make_host(1)),
          stage_(library().make<Narrowphase>({.plugin = "moller", .where = {}, .settings = {}}, *host_)) {}

    IdPairs walk(MeshPair pair) {
        found_.clear();
        dynamic_cast<const MeshNarrowphase&>(*stage_).intersect_meshes(pair, found_);
        IdPairs ids;
        for (const TriangleHit& hit : found_.hits) ids.emplace_back(hit.a, hit.b);
        std::sort(ids.begin(), ids.end());
        return ids;
    }
    std::uint64_t tests() const { return found_.tests; }

private:
    std::unique_ptr<Host> host_;
    StagePtr<Narrowphase> stage_;
    TriangleHits found_;
};

// Checks one placement in both orders of the meshes and both modes; returns the number of intersecting pairs.
std::size_t check_pair(Walker& walker, const MeshPair& pair) {
    const IdPairs expected = brute_force(pair);
    CHECK(walker.walk(pair) == expected);
    MeshPair first = pair;
    first.first_only = true;
    const IdPairs one = walker.walk(first);
    CHECK(one.size() == std::min<std::size_t>(1, expected.size()));
    CHECK(std::includes(expected.begin(), expected.end(), one.begin(), one.end()));
    const MeshPair swapped{pair.b, pair.a, pair.b_to_a.inverse()};
    CHECK(walker.walk(swapped) == brute_force(swapped));
    return expected.size();
}

Vec3 random_point(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return {uniform(random), uniform(random), uniform(random)};
}

TriangleSoup random_soup(std::mt19937& random, std::uint32_t count, double size) {
    TriangleSoup soup;
    for (std::uint32_t t = 0; t < count; ++t) {
        const Vec3 center = random_point(random, 1);
        for (int k = 0; k < 3; ++k) soup.vertices.push_back(center + random_point(random, size));
        soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return soup;
}

TriangleSoup scaled(TriangleSoup soup, double factor) {
    for (Vec3& p : soup.vertices) p *= factor;
    return soup;
}

// One of the 24 rotations of the cube.
Mat3 cube_rotation(std::mt19937& random) {
    std::array<int, 3> axes{0, 1, 2};
    std::shuffle(axes.begin(), axes.end(), random);
    Mat3 rotation = Mat3::Zero();
    for (int k = 0; k < 3; ++k) rotation(k, axes[k]) = random() % 2 ? 1 : -1;
    if (rotation.determinant() < 0) rotation.row(0) *= -1;
    return rotation;
}

}  // namespace

TEST_CASE("the walk finds the triangle pairs that brute force finds, in random places", "[narrowphase][walk]") {
    std::mt19937 random(20260301);
    Walker walker;
    std::size_t hits = 0;
    for (int round = 0; round < 60; ++round) {
        CAPTURE(round);
        const auto a = mesh_of(random_soup(random, 1 + random() % 90, 0.3));
        const auto b = mesh_of(random_soup(random, 1 + random() % 90, 0.02 + 0.1 * (round % 5)));
        hits += check_pair(walker, {*a, *b, {random_rotation(random), random_point(random, 0.5)}});
    }
    CHECK(hits > 100);
}

TEST_CASE("the walk finds every pair of triangles that only touch on a grid", "[narrowphase][walk]") {
    std::mt19937 random(20260302);
    Walker walker;
    const auto box = mesh_of(subdivided(subdivided(box_soup({4, 2, 2}))));
    const auto small = mesh_of(subdivided(box_soup({2, 2, 2})));
    std::size_t hits = 0, apart = 0;
    for (int round = 0; round < 60; ++round) {
        const Vec3 place(int(random() % 17) - 8, int(random() % 13) - 6, int(random() % 13) - 6);
        CAPTURE(round, place.transpose());
        const std::size_t found = check_pair(walker, {*box, *small, {cube_rotation(random), place}});
        hits += found;
        apart += found == 0;
    }
    CHECK(hits > 1000);
    CHECK(apart > 0);
}

TEST_CASE("the walk is right at every scale, far beyond the range of float", "[narrowphase][walk]") {
    const double scale = GENERATE(1e-200, 1e-60, 1e-42, 1e-30, 1e-12, 1e6, 1e20, 1e31, 1e39, 1e60, 1e200);
    CAPTURE(scale);
    std::mt19937 random(20260303);
    Walker walker;
    std::size_t hits = 0;
    for (int round = 0; round < 3; ++round) {
        const auto a = mesh_of(scaled(random_soup(random, 16, 0.5), scale));
        const auto b = mesh_of(scaled(random_soup(random, 16, 0.5), scale));
        hits += check_pair(walker, {*a, *b, {random_rotation(random), scale * random_point(random, 0.3)}});
    }
    CHECK(hits > 5);
}

TEST_CASE("the walk is right for meshes of very different size and for those far from their frame's origin",
          "[narrowphase][walk]") {
    std::mt19937 random(20260304);
    Walker walker;
    std::size_t hits = 0;
    for (int round = 0; round < 20; ++round) {
        CAPTURE(round);
        const double size = std::pow(10, -round / 4), far = std::pow(10, round / 2);
        const auto large = mesh_of(random_soup(random, 60, 0.6));
        const auto tiny = mesh_of(scaled(random_soup(random, 40, 0.6), size));
        const Vec3 on_large = large->vertices[random() % large->vertices.size()];
        hits += check_pair(walker, {*large, *tiny, {random_rotation(random), on_large}});
        const Vec3 offset = random_point(random, far);
        const auto away = mesh_of(moved(random_soup(random, 40, 0.6), Mat3::Identity(), offset));
        const Mat3 turn = random_rotation(random);
        hits += check_pair(walker, {*large, *away, {turn, -(turn * offset)}});
    }
    CHECK(hits > 500);
}

TEST_CASE("the walk hands over few more triangle pairs than intersect", "[narrowphase][walk]") {
    std::mt19937 random(20260305);
    Walker walker;
    for (const double scale : {1.0, 1e-9, 1e9}) {
        CAPTURE(scale);
        const auto a = mesh_of(scaled(subdivided(subdivided(cone48())), scale));
        const Transform place{random_rotation(random), scale * Vec3(20, 10, 5)};
        const std::size_t hits = walker.walk({*a, *a, place}).size();
        CHECK(hits > 100);
        CHECK(walker.tests() < 40 * hits);
    }
}
