// Embree chooses the candidates, exact predicates decide: the same triangles as moller's, whoever is refitted.
#include "framework/scenes.h"
#include "framework/solids.h"
#include "narrowphase/two_bodies.h"

#include <kolize/mesh_io.h>
#include <kolize/mesh_narrowphase.h>

#include <catch2/catch.hpp>

#include <algorithm>
#include <tuple>

using namespace kolize;
using namespace kolize::test;

namespace {

struct Walk {
    std::unique_ptr<Host> host = make_host(1);
    StagePtr<Narrowphase> stage;

    Walk(const std::string& plugin, const World& world)
        : stage(library().make<Narrowphase>({.plugin = plugin, .where = {}, .settings = {}}, *host)) {
        stage->prepare(world);
    }

    std::vector<TriangleHit> hits(const MeshPair& pair) const {
        TriangleHits found;
        dynamic_cast<const MeshNarrowphase&>(*stage).intersect_meshes(pair, found);
        std::sort(found.hits.begin(), found.hits.end(),
                  [](const TriangleHit& x, const TriangleHit& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
        return found.hits;
    }
};

World models() {
    World world;
    for (const char* file : {"box_fighter/fighter.obj", "box_objects/models/torus.obj", "box_objects/models/cone.obj"})
        world.shapes.push_back(make_mesh(file, read_mesh(std::string(KOLIZE_SOURCE_DIR "/demos/") + file)));
    world.shapes.push_back(make_box("box", Vec3(1, 0.5, 0.2)));
    return world;
}

World scaled(World world, double factor) {
    for (Shape& shape : world.shapes) {
        TriangleSoup soup;
        for (const Vec3& v : shape.mesh->vertices) soup.vertices.push_back(factor * v);
        soup.triangles = shape.mesh->triangles;
        shape.mesh = build_mesh(soup);
    }
    return world;
}

}  // namespace

TEST_CASE("Embree finds the triangles and the segments that moller finds, at every scale", "[narrowphase][embree]") {
    const double scale = GENERATE(1e-60, 1e-9, 1.0, 1e12, 1e30);
    const unsigned seed = 20261130;
    CAPTURE(scale, seed);
    std::mt19937 random(seed);
    const World world = scaled(models(), scale);
    const Walk embree("embree", world), moller("moller", world);
    std::size_t count = 0, segments = 0;
    for (int round = 0; round < 30; ++round) {
        const std::uint32_t a = random() % 4, b = random() % 4;
        const double reach = world.shapes[a].mesh->radius + world.shapes[b].mesh->radius;
        std::uniform_real_distribution<double> uniform(-0.4 * reach, 0.4 * reach);
        MeshPair pair{*world.shapes[a].mesh,
                      *world.shapes[b].mesh,
                      {random_rotation(random), Vec3(uniform(random), uniform(random), uniform(random))},
                      a,
                      b};
        pair.want_segments = true;
        CAPTURE(round, a, b);
        const auto found = embree.hits(pair), expected = moller.hits(pair);
        REQUIRE(found.size() == expected.size());
        count += found.size();
        for (std::size_t i = 0; i < found.size(); ++i) {
            REQUIRE(found[i].a == expected[i].a);
            REQUIRE(found[i].b == expected[i].b);
            const TriangleSegment &s = found[i].segment, &t = expected[i].segment;
            const double there = std::max((s.p - t.p).norm(), (s.q - t.q).norm());
            const double back = std::max((s.p - t.q).norm(), (s.q - t.p).norm());
            segments += std::min(there, back) < 1e-9 * reach;
        }
        pair.first_only = true;
        CHECK(embree.hits(pair).empty() == expected.empty());
    }
    CHECK(count > 200);
    if (scale > 1e-10 && scale < 1e20) CHECK(segments == count);
}

TEST_CASE("A crowd of meshes moves alike with embree and with moller, on one thread and on several",
          "[narrowphase][embree]") {
    Scene scene = gas(make_mesh("cone", cone(12, 0.6, 1)), 3, 1.3, 20261131);
    scene.pipeline.step.dt = 0.01;
    const std::string contact = GENERATE("contour", "averaged");
    scene.pipeline.narrowphase = stage("moller", {{"contact", contact}});
    const RunResult expected = run(scene, 40);
    CHECK(expected.contacts > 20);
    scene.pipeline.narrowphase = stage("embree", {{"contact", contact}});
    const RunResult found = run(scene, 40), on_many = run(scene, 40, 4);
    CHECK(found.contacts == expected.contacts);
    CHECK(on_many.state_hash == found.state_hash);
    if (contact == "contour") CHECK(found.state_hash == expected.state_hash);
}
