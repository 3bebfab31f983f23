#include <kolize/scene.h>

#include <catch2/catch.hpp>

using namespace kolize;

namespace {

const std::filesystem::path demos = std::filesystem::path(KOLIZE_SOURCE_DIR) / "demos";
const std::vector<std::string> scene_names = {"box_cubes", "box_objects", "box_fighter"};

Scene load(const std::string& name, const std::string& pipeline = "") {
    const PluginLibrary plugins({KOLIZE_PLUGIN_DIR});
    SceneOptions options;
    if (!pipeline.empty()) options.pipeline = demos / name / "pipelines" / (pipeline + ".toml");
    return load_scene(demos / name / "scene.toml", options, plugins);
}

double radius(const World& world, std::uint32_t body) { return world.shape_of(body).radius; }

}  // namespace

TEST_CASE("Bodies of the box demos start apart from each other and from the walls", "[demos]") {
    for (const std::string& name : scene_names) {
        CAPTURE(name);
        const Scene scene = load(name);
        const World& world = scene.world;
        REQUIRE(scene.rooms.size() == 1);
        const Room& room = scene.rooms[0];
        for (std::uint32_t a = 0; a < world.size(); ++a) {
            CAPTURE(a);
            CHECK((world.position[a] - room.min).minCoeff() > radius(world, a));
            CHECK((room.max - world.position[a]).minCoeff() > radius(world, a));
            for (std::uint32_t b = 0; b < a; ++b)
                CHECK((world.position[a] - world.position[b]).norm() > radius(world, a) + radius(world, b));
        }
    }
}

TEST_CASE("Bodies of the box demos move, spin and lose nothing", "[demos]") {
    for (const std::string& name : scene_names) {
        CAPTURE(name);
        const World world = load(name).world;
        CHECK(world.forces.gravity.isZero(0));
        for (std::uint32_t body = 0; body < world.size(); ++body) {
            CHECK(world.restitution(body, body) == 1);
            CHECK(world.velocity[body].norm() > 1);
            CHECK(world.angular_velocity[body].norm() > 1);
        }
    }
}

TEST_CASE("The box demos have the bodies that their descriptions promise", "[demos]") {
    CHECK(load("box_cubes").world.size() == 27);
    const World objects = load("box_objects").world;
    CHECK(objects.shapes.size() == 8);
    CHECK(objects.size() == 20);
    const World fighter = load("box_fighter").world;
    REQUIRE(fighter.size() == 1);
    CHECK(fighter.inverse_mass[0] == 1);
    CHECK(fighter.angular_velocity[0].norm() == Approx(2).epsilon(0.05));
}

TEST_CASE("Every pipeline of the box demos loads with its scene", "[demos]") {
    for (const std::string& name : scene_names)
        for (const auto& [pipeline, mode] :
             {std::pair("thesis", "rollback"), std::pair("fast", "discrete"), std::pair("accurate", "continuous")}) {
            CAPTURE(name, pipeline);
            const PipelineConfig config = load(name, pipeline).pipeline;
            CHECK(config.step.mode == mode);
            CHECK(config.responses.size() == 1);
        }
}
