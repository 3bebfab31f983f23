// What is put into a simulation between two steps.
#include "framework/capsules.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

struct Bench {
    explicit Bench(Scene scene) : host(make_host(1)), simulation(scene, liars(), *host, 1000) {}

    double worst_drift() const {
        const Reading r = simulation.reading();
        return std::max({r.energy_drift, r.momentum_drift, r.angular_momentum_drift});
    }

    std::unique_ptr<Host> host;
    Simulation simulation;
};

// A ball of 2 kg and a brick of 1 kg on either side of a wall of 1 m, 10 m apart.
Scene two_and_a_wall() {
    Scene scene = empty_scene();
    const std::uint32_t ball = add_shape(scene, make_sphere("ball", 0.5));
    const std::uint32_t brick = add_shape(scene, make_box("brick", Vec3(0.2, 0.5, 0.9)));
    BodyDescription body;
    give(body, ball, Vec3(-5, 0, 0), Vec3(1, 0, 0)).mass = 2;
    scene.world.add(body);
    body = {};
    give(body, brick, Vec3(5, 0, 0), Vec3::Zero());
    scene.world.add(body);
    body = {};
    give(body, add_shape(scene, make_box("wall", Vec3(0.5, 4, 4))), Vec3::Zero(), Vec3::Zero()).is_static = true;
    scene.world.add(body);
    scene.pipeline.step.dt = 0.01;
    return scene;
}

}  // namespace

TEST_CASE("A load pushes and turns its body until it is taken off, and is no drift", "[framework][input]") {
    Bench bench(two_and_a_wall());
    bench.simulation.apply(LoadInput{0, Vec3(0, 3, 0), Vec3(0, 0, 0.5)});
    advance(bench.simulation, 40);
    bench.simulation.apply(LoadInput{0, Vec3::Zero(), Vec3::Zero()});
    advance(bench.simulation, 20);
    const World& world = bench.simulation.world();
    CHECK((world.velocity[0] - Vec3(1, 0.4 * 3 / 2, 0)).norm() < 1e-12);
    const double inertia = 0.4 * 2 * 0.25;
    CHECK((world.angular_velocity[0] - Vec3(0, 0, 0.4 * 0.5 / inertia)).norm() < 1e-12);
    const double y = 0.5 * 1.5 * 0.4 * 0.4 + 0.6 * 0.2;
    CHECK((world.position[0] - Vec3(-4.4, y, 0)).norm() < 1e-12);
    CHECK(bench.worst_drift() < 1e-12);
}

TEST_CASE("Gravity and drag that come and go in the middle of a run are no drift", "[framework][input]") {
    Bench bench(gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 2, 2, 5));
    advance(bench.simulation, 50);
    const double calm = bench.worst_drift();
    bench.simulation.apply(ForcesInput{{Vec3(0, -9.81, 0), Vec3::Zero(), 0}});
    advance(bench.simulation, 50);
    bench.simulation.apply(ForcesInput{{Vec3::Zero(), Vec3(1, 0, 0), 0.3}});
    advance(bench.simulation, 50);
    bench.simulation.apply(ForcesInput{});
    advance(bench.simulation, 50);
    CHECK(calm < 1e-12);
    CHECK(bench.worst_drift() < 1e-11);
}

TEST_CASE("A body that is taken out meets nothing, and one that is placed does", "[framework][input]") {
    Bench bench(two_and_a_wall());
    bench.simulation.apply(RemoveInput{0});
    BodyState state;
    state.position = Vec3(1.2, 0, 0);
    state.velocity = Vec3(-4, 0, 0);
    bench.simulation.apply(PlaceInput{1, state});
    advance(bench.simulation, 20);
    const World& world = bench.simulation.world();
    CHECK(world.position[0] == Vec3(-5, 0, 0));
    CHECK(world.velocity[1].x() > 3);  // thrown back by the wall
    state.position = Vec3(-1.2, 0, 0);
    state.velocity = Vec3(2, 0, 0);
    bench.simulation.apply(PlaceInput{0, state});
    CHECK(world.removed[0] == 0);
    advance(bench.simulation, 20);
    CHECK(world.velocity[0].x() == Approx(-2));
    CHECK(bench.worst_drift() < 1e-12);
}

TEST_CASE("What cannot be put in changes nothing", "[framework][input]") {
    Bench bench(two_and_a_wall());
    advance(bench.simulation, 3);
    const std::uint64_t before = bench.simulation.state_hash();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    BodyState bent;
    bent.orientation = Quat(1, 1, 0, 0);
    const std::vector<Input> refused = {LoadInput{2, Vec3::UnitX(), Vec3::Zero()},
                                        LoadInput{3, Vec3::UnitX(), Vec3::Zero()},
                                        LoadInput{0, Vec3(nan, 0, 0), Vec3::Zero()},
                                        PlaceInput{2, {}},
                                        PlaceInput{0, bent},
                                        RemoveInput{2},
                                        RemoveInput{7},
                                        ForcesInput{{Vec3(0, nan, 0), Vec3::Zero(), 0}},
                                        ForcesInput{{Vec3::Zero(), Vec3::Zero(), -1}}};
    for (const Input& input : refused) CHECK_THROWS_AS(bench.simulation.apply(input), std::invalid_argument);
    CHECK_THROWS_WITH(bench.simulation.apply(RemoveInput{7}), "there is no body 7; the last one is 2");
    CHECK(bench.simulation.state_hash() == before);
    CHECK(bench.simulation.world().forces.drag == 0);
}

TEST_CASE("A switch to another conservative broadphase leaves no trace in the motion", "[framework][input]") {
    const Scene scene = mixed_crowd();
    Bench straight(scene), switched(scene);
    advance(straight.simulation, 120);
    advance(switched.simulation, 60);
    PipelineConfig other = switched.simulation.pipeline();
    other.broadphase = stage("bsp");
    switched.simulation.apply(PipelineInput{other});
    CHECK(switched.simulation.broadphase().plugin == "bsp");
    CHECK(switched.simulation.step_number() == 60);
    advance(switched.simulation, 60);
    CHECK(switched.simulation.step_number() == 120);
    CHECK(switched.simulation.state_hash() == straight.simulation.state_hash());
}

TEST_CASE("A switch of the response gives bodies their shapes back, and of the walls new walls", "[framework][input]") {
    Scene scene = mixed_crowd();
    Bench bench(scene);
    const auto marble = static_cast<std::uint32_t>(
        std::find(scene.world.kind.begin(), scene.world.kind.end(), scene.world.intern_kind("marble")) -
        scene.world.kind.begin());
    REQUIRE(scene.world.shape_of(marble).kind == ShapeKind::mesh);
    advance(bench.simulation, 30);
    CHECK(bench.simulation.world().shape_of(marble).kind == ShapeKind::sphere);
    PipelineConfig other = bench.simulation.pipeline();
    other.responses = {{stage("impulse"), {}}};
    other.walls = "box";
    const BodyState before = bench.simulation.world().state(marble);
    bench.simulation.apply(PipelineInput{other});
    const World& world = bench.simulation.world();
    CHECK(world.shape_of(marble).kind == ShapeKind::mesh);
    CHECK(world.position[marble] == before.position);
    CHECK(world.orientation[marble].coeffs() == before.orientation.coeffs());
    CHECK(bench.simulation.walls() == "box");
    advance(bench.simulation, 30);
    CHECK(bench.simulation.step_number() == 60);
}

TEST_CASE("A pipeline that is refused leaves the one in force", "[framework][input]") {
    const Scene scene = mixed_crowd();
    Bench straight(scene), tried(scene);
    PipelineConfig wrong = tried.simulation.pipeline();
    wrong.broadphase.plugin = "no_such";
    CHECK_THROWS_AS(tried.simulation.apply(PipelineInput{wrong}), Error);
    wrong = tried.simulation.pipeline();
    wrong.broadphase.settings["cell_size"] = {-1.0, {}};
    CHECK_THROWS_AS(tried.simulation.apply(PipelineInput{wrong}), Error);
    advance(straight.simulation, 40);
    advance(tried.simulation, 40);
    CHECK(tried.simulation.state_hash() == straight.simulation.state_hash());
    CHECK(tried.simulation.result().energy_drift == straight.simulation.result().energy_drift);
}
