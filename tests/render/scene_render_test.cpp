// [render] in a scene file.
#include "framework/mesh_files.h"
#include "framework/scenes.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace kolize;

namespace {

const std::string lamp_post = R"([[shape]]
name = "ball"
kind = "sphere"
radius = 1
[[body]]
name = "post"
shape = "ball"
mass = 1
[render]
)";

Scene load(const std::string& render) {
    const test::ScratchFolder folder;
    folder.write("paint.png", "");  // the scene only names it
    return load_scene(folder.write("scene.toml", lamp_post + render), {{}, {}, {"grid", "moller", "impulse", "gl"}},
                      test::plugins());
}

}  // namespace

TEST_CASE("A scene that says nothing of pictures leaves them to defaults", "[render][scene]") {
    const Scene scene = load("");
    CHECK(scene.render.stage.plugin == "gl");
    CHECK(scene.render.stage.settings.empty());
    CHECK_FALSE(scene.render.camera);
    CHECK(scene.render.lights.empty());
}

TEST_CASE("[render] says renderer, camera and lights", "[render][scene]") {
    const Scene scene = load(R"(plugin = "sketch"
samples = 1
camera = { eye = [0, 2, 9], target = [1, 0, 0], up = [0, 0, 1], fov_deg = 90 }
[[render.light]]
position = [1, 2, 3]
colour = [1, 0.5, 0.25]
range = 7
[[render.light]]
kind = "spot"
body = "post"
position = [0, 0, 0]
direction = [0, 0, -1]
cone_deg = 30
)");
    CHECK(scene.render.stage.plugin == "sketch");
    CHECK(scene.render.stage.settings.size() == 1);
    REQUIRE(scene.render.camera);
    CHECK(scene.render.camera->eye == Vec3(0, 2, 9));
    CHECK(scene.render.camera->target == Vec3(1, 0, 0));
    CHECK(scene.render.camera->up == Vec3(0, 0, 1));
    CHECK(scene.render.camera->field_of_view == Approx(std::numbers::pi / 2));
    REQUIRE(scene.render.lights.size() == 2);
    const Light &point = scene.render.lights[0], &spot = scene.render.lights[1];
    CHECK(point.kind == LightKind::point);
    CHECK(point.position == Vec3(1, 2, 3));
    CHECK(point.colour == Vec3(1, 0.5, 0.25));
    CHECK(point.range == 7);
    CHECK_FALSE(point.body);
    CHECK(spot.kind == LightKind::spot);
    CHECK(spot.direction == Vec3(0, 0, -1));
    CHECK(spot.cone == Approx(std::numbers::pi / 6));
    CHECK(spot.body == 0u);
}

TEST_CASE("What is wrong in [render] is told with its place", "[render][scene]") {
    const std::string light = "[[render.light]]\nposition = [0, 1, 0]\n";
    const std::vector<std::pair<std::string, std::string>> wrong = {
        {"camera = 3", "scene.toml:10:10: camera must be a table"},
        {"camera = { target = [0, 0, 0] }", "eye"},
        {"camera = { eye = [0, 0, 0] }", "eye must not be the target"},
        {"camera = { eye = [0, 1, 0] }", "up must not be zero or along the line of sight"},
        {"camera = { eye = [1, 1, 0], up = [0, 0, 0] }", "up must not be zero or along the line of sight"},
        {"camera = { eye = [1, 1, 0], fov_deg = 180 }", "fov_deg must be from 1 to 170, is 180"},
        {"camera = { eye = [1, 1, 0], zoom = 2 }", "no key 'zoom' in camera"},
        {"light = 1", "light must be a list of tables"},
        {"[[render.light]]\nrange = 3", "position"},
        {light + "kind = \"sun\"", "there is no kind 'sun'"},
        {light + "kind = \"spot\"", "direction"},
        {light + "kind = \"spot\"\ndirection = [0, 0, 0]", "direction must not be zero"},
        {light + "kind = \"spot\"\ndirection = [0, 0, 1]\ncone_deg = 90", "cone_deg must be from 1 to 89"},
        {light + "cone_deg = 20", "no key 'cone_deg'"},
        {light + "colour = [1, -1, 0]", "colour must be three numbers from 0"},
        {light + "range = 0", "range must be greater than 0"},
        {light + "body = \"past\"", "there is no body 'past'; did you mean 'post'?"}};
    for (const auto& [render, sentence] : wrong) {
        CAPTURE(render);
        CHECK_THROWS_WITH(load(render), Catch::Contains("scene.toml:") && Catch::Contains(sentence));
    }
}

TEST_CASE("[[render.texture]] names a shape, a file beside the scene and a side", "[render][scene]") {
    const Scene scene = load(R"([[render.texture]]
shape = "pole"
file = "paint.png"
side = 0.25
[[render.texture]]
shape = "ball"
file = "paint.png"
[[shape]]
name = "pole"
kind = "box"
half_extents = [1, 2, 3]
)");
    REQUIRE(scene.render.textures.size() == 2);
    const TextureConfig &pole = scene.render.textures[0], &ball = scene.render.textures[1];
    CHECK(scene.world.shapes[pole.shape].name == "pole");
    CHECK(pole.file.filename() == "paint.png");
    CHECK(pole.file.is_absolute());  // as the scene was named
    CHECK(pole.side == 0.25);
    CHECK(pole.where.line == 12);
    CHECK(scene.world.shapes[ball.shape].name == "ball");
    CHECK(ball.side == 1);
    CHECK(load("").render.textures.empty());
}

TEST_CASE("What is wrong in [[render.texture]] is told with its place", "[render][scene]") {
    const std::string shape = "[[render.texture]]\nshape = \"ball\"\n", whole = shape + "file = \"paint.png\"\n";
    const std::vector<std::pair<std::string, std::string>> wrong = {
        {"texture = 1", "scene.toml:10:11: texture must be a list of tables"},
        {"[[render.texture]]\nfile = \"paint.png\"", "[[render.texture]] needs shape"},
        {"[[render.texture]]\nshape = \"bell\"", "scene.toml:11:9: there is no shape 'bell'; did you mean 'ball'?"},
        {"[[render.texture]]\nshape = \"ground\"\n[[shape]]\nname = \"ground\"\nkind = \"half_space\"\nnormal = [0, 1, "
         "0]",
         "scene.toml:11:9: shape 'ground' is a half-space, which takes no texture"},
        {shape, "[[render.texture]] needs file"},
        {shape + "file = \"pain.png\"", "scene.toml:12:8: file '"},
        {whole + "side = 0", "scene.toml:13:8: "},
        {whole + "side = 0", "side must be greater than 0"},
        {whole + "sides = 2", "scene.toml:13:1: "},
        {whole + "sides = 2", "did you mean 'side'?"},
        {whole + whole, "shape 'ball' has a texture already, at "}};
    for (const auto& [render, sentence] : wrong) {
        CAPTURE(render);
        CHECK_THROWS_WITH(load(render), Catch::Contains("scene.toml:") && Catch::Contains(sentence));
    }
}
