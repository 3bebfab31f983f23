#include "framework/scene_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace kolize;
using namespace kolize::test;

TEST_CASE("a complete scene is read as it is written", "[scene]") {
    SceneFolder folder;
    const std::string text = R"(
schema = 1
[world]
gravity = [0, -9.81, 0]
wind = [1, 2, 3]
drag = 0.5
[step]
dt = 0.01
mode = "bisection"
integrator = "semi_implicit_euler"
tolerance = 0.25
max_impacts = 7
substeps = 3
time = 3
[[material]]
name = "rubber"
restitution = 0.5
friction = 0.25
density = 900
[[shape]]
name = "ball"
kind = "sphere"
radius = 2
[[shape]]
name = "brick"
kind = "box"
half_extents = [1, 2, 3]
[[shape]]
name = "floor"
kind = "half_space"
normal = [0, 2, 0]
offset = -1
[[shape]]
name = "tetra"
kind = "mesh"
file = "t.obj"
scale = 6
[[body]]
name = "b"
shape = "ball"
material = "rubber"
mass = 4
kind = "missile"
position = [1, 2, 3]
orientation = [0, 1, 0, 0]
velocity = [4, 5, 6]
angular_velocity = [7, 8, 9]
force = [1, 0, 0]
torque = [0, 1, 0]
[[body]]
shape = "floor"
static = true
reference = true
[[body]]
shape = "tetra"
density = 2
[[room]]
min = [-1, -2, -3]
max = [1, 2, 3]
thickness = 2.5
open = ["+y", "-z"]
material = "rubber"
[broadphase]
plugin = "sieve"
cell_size = 2
[narrowphase]
plugin = "fine"
contact = "averaged"
exact = true
walls = "box"
[[response]]
plugin = "explode"
when = { kind = "missile" }
[[response]]
plugin = "impulse"
when = { kinds = ["ball", "body"] }
iterations = 10
)";
    const Scene scene = folder.write("t.obj", tetrahedron).write("scene.toml", text).load();
    const World& world = scene.world;

    CHECK(world.forces.gravity == Vec3(0, -9.81, 0));
    CHECK(world.forces.wind == Vec3(1, 2, 3));
    CHECK(world.forces.drag == 0.5);

    const StepConfig& step = scene.pipeline.step;
    CHECK(step.dt == 0.01);
    CHECK(step.mode == "bisection");
    CHECK(step.integrator == "semi_implicit_euler");
    CHECK(step.tolerance == 0.25);
    CHECK(step.max_impacts == 7);
    CHECK(step.substeps == 3);
    CHECK(step.time == 3);

    REQUIRE(world.shapes.size() == 4);
    CHECK(world.shapes[0].radius == 2);
    CHECK(world.shapes[1].half_extents == Vec3(1, 2, 3));
    CHECK(world.shapes[2].normal == Vec3::UnitY());
    CHECK(world.shapes[3].kind == ShapeKind::mesh);
    CHECK(world.shapes[3].name == "tetra");
    CHECK(world.shapes[3].volume == Approx(36));  // 6^3 / 6

    REQUIRE(world.size() == 3);
    CHECK(world.name[0] == "b");
    CHECK(world.kinds[world.kind[0]] == "missile");
    CHECK(world.materials[world.material[0]].name == "rubber");
    CHECK(world.materials[world.material[0]].friction == 0.25);
    CHECK(scene.warnings == std::vector<std::string>{"friction of material 'rubber' has no effect: no response of this "
                                                     "pipeline models friction"});
    CHECK(world.position[0] == Vec3(1, 2, 3));
    CHECK(world.model_orientation(0).angularDistance(Quat(0, 1, 0, 0)) == Approx(0).margin(1e-12));
    CHECK(world.velocity[0] == Vec3(4, 5, 6));
    CHECK(world.angular_velocity[0] == Vec3(7, 8, 9));
    CHECK(world.constant_force[0] == Vec3::UnitX());
    CHECK(world.constant_torque[0] == Vec3::UnitY());
    CHECK(world.inverse_mass[0] == 0.25);
    CHECK(world.is_static[1] == 1);
    CHECK(world.is_reference == std::vector<std::uint8_t>{0, 1, 0});
    CHECK(1 / world.inverse_mass[2] == Approx(72));
    CHECK(world.model_position(2).norm() == Approx(0).margin(1e-12));

    REQUIRE(scene.rooms.size() == 1);
    CHECK(scene.rooms[0].min == Vec3(-1, -2, -3));
    CHECK(scene.rooms[0].thickness == 2.5);
    CHECK(scene.rooms[0].open == std::array<bool, 6>{false, false, false, true, true, false});
    CHECK(world.materials[scene.rooms[0].material].name == "rubber");

    CHECK(scene.pipeline.broadphase.plugin == "sieve");
    CHECK(std::get<std::int64_t>(scene.pipeline.broadphase.settings.at("cell_size").value) == 2);
    const auto lines_before = std::count(text.begin(), text.begin() + text.find("cell_size"), '\n');
    CHECK(scene.pipeline.broadphase.settings.at("cell_size").where.line == lines_before + 1);
    CHECK(scene.pipeline.narrowphase.settings.size() == 2);
    CHECK(std::get<std::string>(scene.pipeline.narrowphase.settings.at("contact").value) == "averaged");
    CHECK(std::get<bool>(scene.pipeline.narrowphase.settings.at("exact").value));
    CHECK(scene.pipeline.walls == "box");
    REQUIRE(scene.pipeline.responses.size() == 2);
    CHECK(scene.pipeline.responses[0].kinds == std::vector<std::string>{"missile"});
    CHECK(scene.pipeline.responses[1].kinds == std::vector<std::string>{"ball", "body"});
    CHECK(scene.pipeline.responses[1].stage.settings.count("iterations") == 1);
}

TEST_CASE("a scene that says nothing is an empty world with the default plugins", "[scene]") {
    const Scene scene = SceneFolder().write("scene.toml", "").load();
    CHECK(scene.world.size() == 0);
    CHECK(scene.pipeline.broadphase.plugin == "grid");
    CHECK(scene.pipeline.narrowphase.plugin == "moller");
    REQUIRE(scene.pipeline.responses.size() == 1);
    CHECK(scene.pipeline.responses[0].stage.plugin == "impulse");
}

TEST_CASE("a pipeline file replaces whole tables of the scene", "[scene]") {
    SceneFolder folder;
    folder.write("scene.toml",
                 "[step]\ndt = 0.5\ntime = 1\n[broadphase]\nplugin = \"a\"\nx = 1\n[narrowphase]\nplugin = \"n\"\n"
                 "[[response]]\nplugin = \"r\"\n[[response]]\nplugin = \"s\"");
    folder.write("p.toml", "[broadphase]\nplugin = \"b\"\ny = 2\n[[response]]\nplugin = \"t\"\n");
    const PipelineConfig pipeline = folder.load({}, "p.toml").pipeline;
    CHECK(pipeline.step.dt == 0.5);
    CHECK(pipeline.broadphase.plugin == "b");
    CHECK(pipeline.broadphase.settings.count("x") == 0);
    CHECK(pipeline.broadphase.settings.count("y") == 1);
    CHECK(pipeline.narrowphase.plugin == "n");
    REQUIRE(pipeline.responses.size() == 1);
    CHECK(pipeline.responses[0].stage.plugin == "t");

    folder.write("p.toml", "[step]\ndt = 1\n[[body]]\nshape = \"s\"\n");
    CHECK(folder.complaint({}, "p.toml") ==
          "p.toml:3:3: a pipeline file has no table 'body'; it may hold [step], [broadphase], [narrowphase], "
          "[[response]], [ledger] and [render]");
    CHECK(folder.complaint({}, "q.toml") == "pipeline file 'q.toml' does not exist");
}

TEST_CASE("overrides by --set replace keys, reaches into lists and takes bare words as text", "[scene]") {
    SceneFolder folder;
    folder.write("scene.toml", "[[response]]\nplugin = \"a\"\n[[response]]\nplugin = \"b\"\n[step]\ndt = 1\n");
    const Scene scene = folder.load({{"step.dt", "0.25"},
                                     {"world.gravity", "[0, -1, 0]"},
                                     {"broadphase.plugin", "bsp"},
                                     {"broadphase.depth", "3"},
                                     {"response.1.plugin", "\"c\""},
                                     {"response.0.when.kind", "ball"}});
    CHECK(scene.pipeline.step.dt == 0.25);
    CHECK(scene.world.forces.gravity == Vec3(0, -1, 0));
    CHECK(scene.pipeline.broadphase.plugin == "bsp");
    CHECK(to_string(scene.pipeline.broadphase.settings.at("depth").where) == "--set broadphase.depth");
    CHECK(scene.pipeline.responses[1].stage.plugin == "c");
    CHECK(scene.pipeline.responses[0].kinds == std::vector<std::string>{"ball"});

    CHECK(folder.complaint({{"response.plugin", "c"}}) ==
          "--set response.plugin: there are 2 [[response]] tables; say which: response.0 to response.1");
    CHECK(folder.complaint({{"response.2.plugin", "c"}}) ==
          "--set response.2.plugin: there is no [[response]] table number 2; there are 2, counted from 0");
    CHECK(folder.complaint({{"dt", "1"}}) == "--set dt: a dotted key such as broadphase.cell_size is wanted");
    CHECK(folder.complaint({{"step.dt.x", "1"}}) == "--set step.dt.x: 'dt' is a value, not a table");
    CHECK(folder.complaint({{"step.dt", "fast"}}) == "--set step.dt: dt must be a number, is the text \"fast\"");
    CHECK(folder.complaint({{"step.tme", "1"}}) == "--set step.tme: no key 'tme' in [step]; did you mean 'time'?");
}

TEST_CASE("settings of a plugin that --set replaced are dropped where the new one has no such parameter", "[scene]") {
    const PluginLibrary plugins({KOLIZE_PLUGIN_DIR});
    const test::ScratchFolder scratch;
    const auto file = scratch.write("scene.toml",
                                    "[broadphase]\nplugin = \"grid\"\ncell_size = 1.0\n"
                                    "[narrowphase]\nplugin = \"moller\"\ncontact = \"averaged\"\n");
    const auto load = [&](const Set& set) { return load_scene(file, {{}, set, defaults}, plugins).pipeline; };
    CHECK(load({}).broadphase.settings.count("cell_size") == 1);
    CHECK(load({{"broadphase.plugin", "grid"}}).broadphase.settings.count("cell_size") == 1);
    CHECK(load({{"broadphase.plugin", "brute_force"}}).broadphase.settings.count("cell_size") == 0);
    CHECK(load({{"broadphase.plugin", "brute_force"}, {"broadphase.cell_size", "2"}})
              .broadphase.settings.count("cell_size") == 1);
    CHECK(load({{"narrowphase.plugin", "angle_sum"}}).narrowphase.settings.count("contact") == 1);
}

TEST_CASE("what a mesh file holds and is not read is a warning of the scene, once for all shapes of it", "[scene]") {
    SceneFolder folder;
    folder.write("part.wrl", "#VRML V2.0 utf8\nInline { url \"more.wrl\" }\nShape { geometry Box { } }\n");
    const std::string shape = "kind = \"mesh\"\nfile = \"part.wrl\"\n";
    folder.write("scene.toml", "[[shape]]\nname = \"a\"\n" + shape + "[[shape]]\nname = \"b\"\n" + shape);
    const std::vector<std::string> warnings = folder.load().warnings;
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].ends_with("part.wrl:2: Inline is not used"));
}

TEST_CASE("bodies take their states from a table with columns in any order", "[scene]") {
    SceneFolder folder;
    folder.write("scene.toml", ball + "[[body]]\nname = \"b\"\nshape = \"ball\"\nmass = 2\nfrom = \"s.csv\"\n");
    folder.write("s.csv", "wz, y ,x,qw,qx,qy,qz\r\n1,2,3,0,0,1,0\r\n\r\n-1,-2,-3e0,1,0,0,0\r\n");
    const World world = folder.load().world;
    REQUIRE(world.size() == 2);
    CHECK(world.position[0] == Vec3(3, 2, 0));
    CHECK(world.angular_velocity[0] == Vec3(0, 0, 1));
    CHECK(world.model_orientation(0).angularDistance(Quat(0, 0, 1, 0)) == Approx(0).margin(1e-12));
    CHECK(world.velocity[0].isZero(0));
    CHECK(world.inverse_mass[1] == 0.5);
    CHECK(world.name[1] == "b.1");

    folder.write("s.csv", "\xEF\xBB\xBFx,mass\n1,8\n");
    CHECK(folder.load().world.inverse_mass[0] == 0.125);
    CHECK(folder.load().world.model_orientation(0).w() == 1);
}

TEST_CASE("an orientation that is nearly a unit quaternion is made one", "[scene]") {
    SceneFolder folder;
    folder.write("scene.toml", ball + "[[body]]\nshape = \"ball\"\norientation = [1.0005, 0, 0, 0]\n");
    CHECK(folder.load().world.orientation[0].norm() == 1);
}

TEST_CASE("one mesh file at one scale is prepared once for all shapes that name it", "[scene]") {
    const auto shape = [](const std::string& name, const std::string& scale) {
        return "[[shape]]\nname = \"" + name + "\"\nkind = \"mesh\"\nfile = \"t.obj\"\nscale = " + scale + "\n";
    };
    SceneFolder folder;
    folder.write("t.obj", tetrahedron).write("scene.toml", shape("a", "1") + shape("b", "1") + shape("c", "2"));
    const World world = folder.load().world;
    CHECK(world.shapes[0].mesh == world.shapes[1].mesh);
    CHECK(world.shapes[0].mesh != world.shapes[2].mesh);
    CHECK(world.shapes[1].name == "b");
}

TEST_CASE("a stage alone can be configured by settings", "[scene]") {
    const StageConfig config =
        stage_config(StageKind::narrowphase, {{"narrowphase.plugin", "fcl"}, {"narrowphase.depth", "2"}}, "moller");
    CHECK(config.plugin == "fcl");
    CHECK(std::get<std::int64_t>(config.settings.at("depth").value) == 2);
    CHECK(stage_config(StageKind::response, {}, "impulse").plugin == "impulse");
    CHECK_THROWS_WITH(stage_config(StageKind::narrowphase, {{"step.dt", "1"}}, "moller"),
                      "--set step.dt: only narrowphase.* can be set here");
}

TEST_CASE("a time is taken in whole steps", "[scene]") {
    CHECK(steps_in(1, 1.0 / 240) == 240);
    CHECK(steps_in(0.1, 0.03) == 3);
    CHECK(steps_in(0, 0.1) == 0);
    CHECK_THROWS_AS(steps_in(1e9, 1e-9), Error);
}
