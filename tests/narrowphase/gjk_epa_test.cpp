// Convex bodies by their support functions, against closed forms and against boxes' separating axes.
#include "framework/scenes.h"
#include "framework/volumes_of_shapes.h"
#include "narrowphase/convex_solids.h"
#include "narrowphase/two_bodies.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

Vec3 random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return {uniform(random), uniform(random), uniform(random)};
}

NarrowphaseUnderTest with(const std::string& method) { return NarrowphaseUnderTest("gjk_epa", {{"method", method}}); }

// Of two segments, by fine sampling of one and the closed form on the other, twice refined.
double segment_distance(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    double low = 0, high = 1, best = infinity;
    for (int round = 0; round < 8; ++round) {
        constexpr int samples = 200;
        double at = low;
        for (int i = 0; i <= samples; ++i) {
            const double t = low + (high - low) * i / samples;
            const Vec3 x = p + t * (q - p);
            const double u = std::clamp((x - r).dot(s - r) / (s - r).squaredNorm(), 0.0, 1.0);
            const double distance = (x - r - u * (s - r)).norm();
            if (distance < best) best = distance, at = t;
        }
        const double step = (high - low) / samples;
        low = std::max(0.0, at - step), high = std::min(1.0, at + step);
    }
    return best;
}

}  // namespace

TEST_CASE("Two capsules touch where their axes are as near as their radii", "[narrowphase][gjk_epa]") {
    const unsigned seed = 20261123;
    CAPTURE(seed);
    std::mt19937 random(seed);
    auto stage = with("epa");
    const Shape a = make_capsule("a", 0.3, 0.8), b = make_capsule("b", 0.2, 0.5);
    int overlaps = 0;
    for (int round = 0; round < 500; ++round) {
        const World world = world_of({a, random_vector(random, 0.6), Quat(any_rotation(random))},
                                     {b, random_vector(random, 0.6), Quat(any_rotation(random))});
        const auto end = [&](int body, double half) -> Vec3 {
            return world.position[body] + world.orientation[body] * Vec3(0, half, 0);
        };
        const double distance = segment_distance(end(0, 0.8), end(0, -0.8), end(1, 0.5), end(1, -0.5));
        CAPTURE(round, distance);
        const auto rows = stage.collide(world, Detail::normal).rows;
        REQUIRE(rows.size() == (distance <= 0.5));
        if (rows.empty() || distance < 1e-3) continue;
        ++overlaps;
        CHECK(rows[0].depth == Approx(0.5 - distance).margin(1e-7));
        CHECK(std::abs(rows[0].normal.norm() - 1) < 1e-12);
    }
    CHECK(overlaps > 100);
}

// libccd's EPA at times stops at an edge of its polytope.
TEST_CASE("Boxes overlap as deep as their separating axes say, by EPA nearly always; never less",
          "[narrowphase][gjk_epa]") {
    const unsigned seed = 20261124;
    CAPTURE(seed);
    std::mt19937 random(seed);
    auto epa = with("epa"), mpr = with("mpr");
    const Shape a = make_box("a", Vec3(0.9, 0.4, 0.25)), b = make_box("b", Vec3(0.5, 0.6, 0.3));
    int overlaps = 0, deeper = 0;
    for (int round = 0; round < 500; ++round) {
        const World world = world_of({a, random_vector(random, 0.7), Quat(any_rotation(random))},
                                     {b, random_vector(random, 0.7), Quat(any_rotation(random))});
        CAPTURE(round);
        const double depth = box_depth(world);
        const auto found = epa.collide(world, Detail::normal), other = mpr.collide(world, Detail::normal);
        CHECK(found.failures + other.failures == 0);
        REQUIRE(found.rows.size() == (depth >= 0));
        REQUIRE(other.rows.size() == (depth >= 0));
        if (depth < 0) continue;
        ++overlaps;
        CHECK(found.rows[0].depth > depth - 1e-9);
        deeper += found.rows[0].depth > depth + 1e-5;
        CHECK(other.rows[0].depth > depth - 1e-9);
    }
    CHECK(overlaps > 100);
    CHECK(deeper < 0.03 * overlaps);
}

// Centres that coincide, flat and long bodies, far away and hardly touching: whatever comes out is finite and points a
// way, and what libccd cannot do is counted.
TEST_CASE("Degenerate pairs get an answer", "[narrowphase][gjk_epa]") {
    const std::string method = GENERATE("epa", "mpr");
    CAPTURE(method);
    auto stage = with(method);
    const std::vector<Shape> shapes{make_sphere("ball", 1),
                                    make_box("cube", Vec3::Ones()),
                                    make_box("plate", Vec3(1, 1e-6, 1)),
                                    make_box("needle", Vec3(1e-6, 1, 1e-6)),
                                    make_capsule("capsule", 0.5, 1),
                                    make_capsule("wire", 1e-7, 1),
                                    make_hull("hull", corners_of_dodecahedron(0.7)),
                                    make_box("huge", Vec3::Constant(1e6)),
                                    make_sphere("tiny", 1e-6)};
    for (const Shape& a : shapes)
        for (const Shape& b : shapes)
            for (const double offset : {0.0, 1e-9, 1e-3, 0.3})
                for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(1e6, -1e6, 1e6)})
                    for (const double angle : {0.0, 1e-9, 0.5}) {
                        CAPTURE(a.name, b.name, offset, origin.x(), angle);
                        const Quat turn(Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()));
                        const World world = world_of({a, origin}, {b, origin + Vec3(0, offset, 0), turn});
                        const auto found = stage.collide(world, Detail::normal);
                        REQUIRE(found.rows.size() <= 1);
                        if (offset == 0) CHECK(found.rows.size() == 1);
                        for (const Contact& row : found.rows) {
                            CHECK(std::abs(row.normal.norm() - 1) < 1e-9);
                            CHECK(row.depth >= 0);
                            CHECK((row.arm_a.allFinite() && row.arm_b.allFinite()));
                            CHECK(row.depth <= 2.1 * (a.radius + b.radius));
                        }
                    }
}

TEST_CASE("A hull comes to rest on the floor without gaining energy", "[narrowphase][gjk_epa]") {
    Scene scene = empty_scene();
    scene.pipeline.narrowphase = stage("gjk_epa");
    scene.pipeline.responses = {{stage("solver"), {}}};
    scene.pipeline.step.dt = 1 / 240.0;
    scene.world.forces.gravity = Vec3(0, -9.81, 0);
    scene.world.materials[0].restitution = 0;
    scene.world.materials[0].friction = 0.5;
    BodyDescription floor;
    floor.shape = add_shape(scene, make_half_space("floor", Vec3::UnitY(), 0));
    floor.is_static = true;
    scene.world.add(floor);
    const std::uint32_t hull = add_shape(scene, make_hull("hull", corners_of_dodecahedron(0.3)));
    const std::uint32_t capsule = add_shape(scene, make_capsule("capsule", 0.2, 0.4));
    for (int i = 0; i < 4; ++i) {
        BodyDescription body;
        give(body, i % 2 ? hull : capsule, Vec3(2.0 * i, 1, 0), Vec3::Zero());
        body.orientation = Quat(Eigen::AngleAxisd(0.3 + i, Vec3(1, 0, 1).normalized()));
        scene.world.add(body);
    }
    const RunResult result = run(scene, 1200);
    CHECK(result.energy_drift < 1e-9);
    CHECK(result.max_penetration_m < 0.02);
}
