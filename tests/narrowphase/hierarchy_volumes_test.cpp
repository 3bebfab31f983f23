// Whatever volumes the trees over two meshes have, the walk finds the same pairs of triangles.
#include "framework/solids.h"
#include "narrowphase/two_bodies.h"

#include <kolize/mesh_io.h>
#include <kolize/mesh_narrowphase.h>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace kolize;
using namespace kolize::test;

namespace {

using IdPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

const std::vector<std::string> kinds{"aabb", "sphere", "obb", "kdop18", "kdop26"};

class Walker {
public:
    Walker(const std::string& kind, const World& world)
        : world_(world),
          host_(make_host(1)),
          stage_(library().make<Narrowphase>({.plugin = "moller", .where = {}, .settings = {{"hierarchy", {kind, {}}}}},
                                             *host_)) {
        stage_->prepare(world);
    }

    IdPairs walk(std::uint32_t a, std::uint32_t b, const Transform& b_to_a, bool first_only = false) {
        MeshPair pair{*world_.shapes[a].mesh, *world_.shapes[b].mesh, b_to_a, a, b};
        pair.first_only = first_only;
        found_.clear();
        dynamic_cast<const MeshNarrowphase&>(*stage_).intersect_meshes(pair, found_);
        IdPairs ids;
        for (const TriangleHit& hit : found_.hits) ids.emplace_back(hit.a, hit.b);
        std::sort(ids.begin(), ids.end());
        return ids;
    }
    std::uint64_t tests() const { return found_.tests; }

private:
    const World& world_;
    std::unique_ptr<Host> host_;
    StagePtr<Narrowphase> stage_;
    TriangleHits found_;
};

Vec3 random_point(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return {uniform(random), uniform(random), uniform(random)};
}

TriangleSoup scaled(TriangleSoup soup, double factor) {
    for (Vec3& p : soup.vertices) p *= factor;
    return soup;
}

Shape model(const std::string& path) { return make_mesh(path, read_mesh(KOLIZE_SOURCE_DIR "/demos/" + path)); }

}  // namespace

TEST_CASE("The walk finds the same triangles with every kind of volume, on the demos' models", "[narrowphase][walk]") {
    const unsigned seed = 20261120;
    CAPTURE(seed);
    std::mt19937 random(seed);
    World world;
    world.shapes = {model("box_fighter/fighter.obj"), model("box_objects/models/torus.obj"),
                    model("box_objects/models/star.obj"), make_box("box", Vec3(1, 0.5, 0.2))};
    std::vector<Walker> walkers;
    for (const std::string& kind : kinds) walkers.emplace_back(kind, world);
    std::vector<std::uint64_t> tests(kinds.size());
    std::size_t hits = 0;
    for (int round = 0; round < 120; ++round) {
        const std::uint32_t a = random() % 4, b = random() % 4;
        const double reach = world.shapes[a].radius + world.shapes[b].radius;
        const Transform place{random_rotation(random), random_point(random, 0.5 * reach)};
        CAPTURE(round, a, b);
        const IdPairs expected = walkers[0].walk(a, b, place);
        hits += expected.size();
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            CAPTURE(kinds[k]);
            CHECK(walkers[k].walk(a, b, place) == expected);
            tests[k] += walkers[k].tests();
            CHECK(walkers[k].walk(a, b, place, true).empty() == expected.empty());
        }
    }
    CHECK(hits > 1000);
    for (std::size_t k = 1; k < kinds.size(); ++k) {
        CAPTURE(kinds[k], tests[k], tests[0]);
        CHECK(tests[k] <= 2 * tests[0]);
    }
}

TEST_CASE("The walk finds the same triangles with every kind of volume at every scale", "[narrowphase][walk]") {
    const double scale = GENERATE(1e-90, 1e-40, 1e-12, 1e6, 1e40, 1e90);
    const unsigned seed = 20261121;
    CAPTURE(scale, seed);
    std::mt19937 random(seed);
    World world;
    for (const TriangleSoup& soup : {subdivided(cone(12, 1, 1.5)), subdivided(box_soup(Vec3(0.7, 0.4, 0.3)))}) {
        Shape shape;
        shape.kind = ShapeKind::mesh;
        shape.mesh = build_mesh(scaled(soup, scale));
        world.shapes.push_back(shape);
    }
    std::vector<Walker> walkers;
    for (const std::string& kind : kinds) walkers.emplace_back(kind, world);
    std::size_t hits = 0;
    for (int round = 0; round < 10; ++round) {
        const Transform place{random_rotation(random), scale * random_point(random, 1)};
        const IdPairs expected = walkers[0].walk(0, 1, place);
        hits += expected.size();
        for (std::size_t k = 1; k < kinds.size(); ++k) {
            CAPTURE(round, kinds[k]);
            CHECK(walkers[k].walk(0, 1, place) == expected);
        }
    }
    CHECK(hits > 20);
}

// Faces that lie in each other: the touch is exact, and no volume may round it away.
TEST_CASE("Boxes that touch face to face have the same triangles in touch with every kind of volume",
          "[narrowphase][walk]") {
    World world;
    for (const double half : {1.0, 0.5}) {
        Shape shape = make_box("box", Vec3::Constant(half));
        shape.mesh = build_mesh(subdivided(box_soup(Vec3::Constant(half))));
        world.shapes.push_back(shape);
    }
    const Transform place{Mat3::Identity(), Vec3(1.5, 0.25, -0.5)};
    const IdPairs expected = Walker("aabb", world).walk(0, 1, place);
    CHECK(expected.size() > 8);
    for (const std::string& kind : kinds) {
        CAPTURE(kind);
        CHECK(Walker(kind, world).walk(0, 1, place) == expected);
    }
}
