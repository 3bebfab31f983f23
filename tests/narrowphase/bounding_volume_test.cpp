// The narrowphase that answers from bounds alone, against closed forms and against surfaces.
#include "framework/scenes.h"
#include "framework/volumes_of_shapes.h"
#include "narrowphase/two_bodies.h"
#include "oracle/allocation_counter.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

const std::vector<std::string> kinds{"sphere", "aabb", "obb", "kdop18", "kdop26"};

NarrowphaseUnderTest with(const std::string& volume) {
    return NarrowphaseUnderTest("bounding_volume", {{"volume", volume}});
}

Vec3 random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return {uniform(random), uniform(random), uniform(random)};
}

// Side by side along x: a sphere of radius 1 and a box of half extent 1 that is turned by 45 degrees about z.
World ball_and_turned_box(double distance) {
    const Quat turn(Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitZ()));
    return world_of({make_sphere("ball", 1)}, {make_box("box", Vec3::Ones()), Vec3(distance, 0, 0), turn});
}

}  // namespace

TEST_CASE("A ball and a turned box collide as far apart as their volumes say", "[narrowphase][bounding_volume]") {
    const double edge = std::sqrt(2.0);  // how far the turned box reaches along x
    const std::map<std::string, double> touch{{"sphere", 1 + std::sqrt(3.0)},
                                              {"aabb", 1 + edge},
                                              {"obb", 1 + edge},
                                              {"kdop18", 1 + edge},
                                              {"kdop26", 1 + edge}};
    for (const auto& [volume, distance] : touch) {
        CAPTURE(volume);
        auto stage = with(volume);
        CHECK(stage.collide(ball_and_turned_box(distance + 1e-6), Detail::normal).rows.empty());
        const World world = ball_and_turned_box(distance - 0.01);
        const auto rows = stage.collide(world, Detail::normal).rows;
        REQUIRE(rows.size() == 1);
        CHECK((rows[0].normal - Vec3::UnitX()).norm() < 1e-9);
        CHECK(rows[0].depth == Approx(0.01).epsilon(1e-9));
        CHECK((point_of(world, rows[0]) - world.position[1] - rows[0].arm_b).norm() < 1e-12);
        // In the middle of the overlap, seen along the normal; the sphere around a ball is the ball.
        if (volume == "sphere") CHECK(rows[0].arm_a.x() == Approx(1 - 0.005));
    }
}

TEST_CASE("Whatever overlaps has bounds that overlap, and rows that keep the contract",
          "[narrowphase][bounding_volume]") {
    const std::string volume = GENERATE("sphere", "aabb", "obb", "kdop18", "kdop26");
    const unsigned seed = 20261140;
    CAPTURE(volume, seed);
    std::mt19937 random(seed);
    auto bounds = with(volume);
    NarrowphaseUnderTest surfaces("moller");
    std::vector<Shape> shapes{make_sphere("sphere", 0.7), make_box("box", Vec3(0.9, 0.4, 0.25)),
                              make_mesh("u", u_bar()), make_half_space("floor", Vec3::UnitY(), 0)};
    std::size_t overlaps = 0;
    for (int round = 0; round < 40; ++round) {
        const std::size_t i = random() % 4, j = random() % 3;
        const Placed a{shapes[i], random_vector(random, 1.5), Quat(any_rotation(random)), i == 3};
        const Placed b{shapes[j], random_vector(random, 1.5), Quat(any_rotation(random))};
        CAPTURE(round, i, j);
        const World world = world_of(a, b);
        const auto rows = bounds.collide(world, Detail::normal).rows, back = bounds.collide(b, a, Detail::normal).rows;
        const bool overlap = !surfaces.collide(world, Detail::overlap).rows.empty();
        overlaps += overlap;
        if (overlap) CHECK(rows.size() == 1);
        REQUIRE(rows.size() == back.size());
        if (rows.empty()) continue;
        CHECK(rows[0].depth > 0);
        CHECK(std::abs(rows[0].normal.norm() - 1) < 1e-12);
        CHECK((rows[0].normal + back[0].normal).norm() < 1e-9);
        CHECK((rows[0].arm_a - back[0].arm_b).norm() < 1e-9);
        const auto one = bounds.collide(world, Detail::overlap).rows;
        CHECK((one.size() == 1 && one[0].depth == 0 && one[0].normal.isZero(0)));
    }
    CHECK(overlaps > 5);
}

TEST_CASE("Balls bounce off their bounds exactly as off their surfaces", "[narrowphase][bounding_volume]") {
    Scene scene = gas(make_sphere("ball", 0.4), 3, 1.1, 20261141);
    scene.pipeline.step.dt = 0.01;
    const RunResult surfaces = run(scene, 100);
    CHECK(surfaces.contacts > 50);
    scene.pipeline.narrowphase = stage("bounding_volume", {{"volume", "sphere"}});
    CHECK(run(scene, 100).state_hash == surfaces.state_hash);
    CHECK(run(scene, 100, 3).state_hash == surfaces.state_hash);
}

TEST_CASE("A warm call allocates nothing, whatever the volume", "[narrowphase][bounding_volume]") {
    if (!AllocationCounter::available()) return;
    for (const std::string& volume : kinds) {
        CAPTURE(volume);
        const auto host = make_host(1);
        const auto stage = library().make<Narrowphase>(
            {.plugin = "bounding_volume", .where = {}, .settings = {{"volume", {volume, {}}}}}, *host);
        const World world = world_of({make_mesh("u", u_bar())}, {make_mesh("cone", cone(12, 1, 1)), Vec3(0.5, 0.5, 0)});
        stage->prepare(world);
        const Pair pair{0, 1};
        const Detail detail = Detail::normal;
        Contacts contacts;
        std::size_t count = 0;
        for (int call = 0; call < 3; ++call) {
            contacts.clear();
            const AllocationCounter allocations;
            stage->find_contacts({world, {&pair, 1}, {&detail, 1}}, contacts);
            count = allocations.count();
        }
        CHECK(contacts.rows.size() == 1);
        CHECK(count == 0);
    }
}
