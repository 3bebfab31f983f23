// What is wrong with a scene is said in one sentence with its place.
#include "framework/scene_folder.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

TEST_CASE("a broken table of states is refused at the cell", "[scene]") {
    const auto [rows, sentence] = GENERATE(table<std::string, std::string>({
        {"",
         "s.csv:1:1: the table is empty; its first line must name columns: x, y, z, qw, qx, qy, qz, vx, vy, vz, "
         "wx, wy, wz, mass"},
        {"x,mas\n", "s.csv:1:3: no column 'mas' in a table of states; did you mean 'mass'?"},
        {"x,y,x\n", "s.csv:1:5: column 'x' stands there twice"},
        {"x,y\n1\n", "s.csv:2:1: the row has 1 values for 2 columns"},
        {"x,y\n1,2\n3,four\n", "s.csv:3:3: y must be a number, is \"four\""},
        {"x,y\n1,\n", "s.csv:2:3: y must be a number, is \"\""},
        {"x,y\n1,nan\n", "s.csv:2:3: y must be finite, is nan"},
        {"x,mass\n1,-1\n", "s.csv:2:3: mass must be greater than 0"},
        {"x,qw\n1,0\n", "s.csv:2:3: qw, qx, qy, qz is the zero quaternion; no turn at all is [1, 0, 0, 0]"},
        {"qw,qx\n1,1\n", "s.csv:2:1: qw, qx, qy, qz must be a unit quaternion [w, x, y, z], has length 1.414213562"},
    }));
    SceneFolder folder;
    folder.write("scene.toml", ball + "[[body]]\nshape = \"ball\"\nfrom = \"s.csv\"\n").write("s.csv", rows);
    CHECK(folder.complaint() == sentence);
}

TEST_CASE("what is wrong with a scene is said in one sentence with its place", "[scene]") {
    const auto [text, sentence] = GENERATE(table<std::string, std::string>({
        {"schema = 2", "scene.toml:1:10: schema 2 is not known; this program reads schema = 1"},
        {"[wrold]", "scene.toml:1:2: a scene has no table 'wrold'; did you mean 'world'?"},
        {"world = 1", "scene.toml:1:9: world must be a table, under [world]"},
        {"[body]", "scene.toml:1:1: body must be a list of tables, each under [[body]]"},
        {"[world]\ngravty = [0, 0, 0]", "scene.toml:2:1: no key 'gravty' in [world]; did you mean 'gravity'?"},
        {"[world]\ngravity = -9.81", "scene.toml:2:11: gravity must be three numbers [x, y, z], is -9.81"},
        {"[world]\ngravity = [0, 1]", "scene.toml:2:11: gravity must be three numbers [x, y, z], has 2 entries"},
        {"[world]\ngravity = [0, nan, 0]", "scene.toml:2:11: gravity must be finite, is nan"},
        {"[world]\ndrag = -1", "scene.toml:2:8: drag must be at least 0, is -1"},
        {"[step]\ndt = 0", "scene.toml:2:6: dt must be greater than 0, is 0"},
        {"[step]\ndt = inf", "scene.toml:2:6: dt must be finite, is inf"},
        {"[step]\ntolerance = 2", "scene.toml:2:13: tolerance must be greater than 0 and at most 1, is 2"},
        {"[step]\nmax_impacts = 1.5", "scene.toml:2:15: max_impacts must be an integer, is 1.5"},
        {"[step]\nmode = \"xx\"",
         "scene.toml:2:8: there is no mode 'xx'; there are discrete, rollback, bisection, continuous"},
        {"[step]\nmode = \"rolback\"", "scene.toml:2:8: there is no mode 'rolback'; did you mean 'rollback'?"},
        {"[step]\nintegrator = \"pdmv5\"", "scene.toml:2:14: there is no integrator 'pdmv5'; did you mean 'pdmv4'?"},
        {"[[material]]\nrestitution = 1", "scene.toml:1:1: [[material]] needs name"},
        {"[[material]]\nname = \"m\"\nrestitution = 1.5", "scene.toml:3:15: restitution must be from 0 to 1, is 1.5"},
        {"[[material]]\nname = \"m\"\n[[material]]\nname = \"m\"",
         "scene.toml:4:8: there is a material 'm' already, at scene.toml:2:8"},
        {"[[shape]]\nname = \"s\"\nkind = \"sphere\"", "scene.toml:1:1: shape 's' needs radius"},
        {"[[shape]]\nname = \"s\"\nkind = \"sphere\"\nradios = 1",
         "scene.toml:4:1: no key 'radios' in shape 's'; did you mean 'radius'?"},
        {"[[shape]]\nname = \"s\"\nkind = \"sphere\"\nradius = -1",
         "scene.toml:4:10: radius must be greater than 0, is -1"},
        {"[[shape]]\nname = \"s\"\nkind = \"capsule\"\nradius = 1", "scene.toml:1:1: shape 's' needs half_height"},
        {"[[shape]]\nname = \"s\"\nkind = \"spere\"",
         "scene.toml:3:8: there is no kind 'spere'; did you mean 'sphere'?"},
        {"[[shape]]\nname = \"s\"\nkind = \"box\"\nhalf_extents = [1, 0, 1]",
         "scene.toml:4:16: half_extents must be greater than 0 on every axis"},
        {"[[shape]]\nname = \"s\"\nkind = \"half_space\"\nnormal = [0, 0, 0]",
         "scene.toml:4:10: normal must have a length that is not 0"},
        {"[[shape]]\nname = \"s\"\nkind = \"mesh\"\nfile = \"no.obj\"", "scene.toml:4:8: file 'no.obj' does not exist"},
        {"[[body]]\nmass = 1", "scene.toml:1:1: [[body]] needs shape"},
        {"[[body]]\nshape = \"ball\"", "scene.toml:2:9: there is no shape 'ball'; there is none"},
        {"[[room]]\nmin = [0, 0, 0]", "scene.toml:1:1: [[room]] needs max"},
        {"[[room]]\nmin = [0, 0, 0]\nmax = [1, 0, 1]", "scene.toml:3:7: max must be greater than min on every axis"},
        {"[[room]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nopen = [\"y\"]",
         "scene.toml:4:8: there is no side 'y'; there are -x, +x, -y, +y, -z, +z"},
        {"[broadphase]\nplugin = 3", "scene.toml:2:10: plugin must be text, is 3"},
        {"[broadphase]\nsizes = [1]", "scene.toml:2:9: sizes must be true, false, a number or text, is an array"},
        {"[narrowphase]\nwalls = \"bricks\"",
         "scene.toml:2:9: there is no walls 'bricks'; there are auto, half_space, box, mesh"},
        {"[[response]]\nwhen = \"ball\"", "scene.toml:2:8: when must be a table such as { kind = \"ball\" }"},
        {"[[response]]\nwhen = { kinds = [\"a\"] }",
         "scene.toml:2:8: when must say either kind = \"...\" or kinds = [\"...\", \"...\"]"},
    }));
    CHECK(complaint(text) == sentence);
}

TEST_CASE("what is wrong with a body is said in one sentence with its place", "[scene]") {
    const auto [text, sentence] = GENERATE(table<std::string, std::string>({
        {"shape = \"bal\"", "scene.toml:6:9: there is no shape 'bal'; did you mean 'ball'?"},
        {"shape = \"ball\"\nmaterial = \"ice\"", "scene.toml:7:12: there is no material 'ice'; there is none"},
        {"shape = \"ball\"\nmass = 0", "scene.toml:7:8: mass must be greater than 0, is 0"},
        {"shape = \"ball\"\nmass = 1\ndensity = 1",
         "scene.toml:8:11: density cannot stand beside mass; give one of them"},
        {"shape = \"ball\"\nstatic = 1", "scene.toml:7:10: static must be true or false, is 1"},
        {"shape = \"ball\"\nvelocity = [0, inf, 0]", "scene.toml:7:12: velocity must be finite, is inf"},
        {"shape = \"ball\"\norientation = [0, 0, 0, 0]",
         "scene.toml:7:15: orientation is the zero quaternion; no turn at all is [1, 0, 0, 0]"},
        {"shape = \"ball\"\norientation = [1, 1, 0, 0]",
         "scene.toml:7:15: orientation must be a unit quaternion [w, x, y, z], has length 1.414213562"},
        {"shape = \"ball\"\nfrom = \"s.csv\"", "scene.toml:7:8: file 's.csv' does not exist"},
        {"shape = \"ball\"\nposition = [0, 0, 0]\nfrom = \"s.csv\"",
         "scene.toml:7:12: position cannot stand beside from, whose table holds the states"},
        {"name = \"b\"\nshape = \"ball\"\n[[body]]\nname = \"b\"\nshape = \"ball\"",
         "scene.toml:9:8: there is a body 'b' already, at scene.toml:6:8"},
        {"name = \"b\"\nshape = \"ball\"\nspin = 1",
         "scene.toml:8:1: no key 'spin' in body 'b'; there are name, shape, material, kind, static, reference, mass, "
         "density, "
         "force, torque, from, position, orientation, velocity, angular_velocity"},
    }));
    CHECK(complaint(ball + "[[body]]\n" + text) == sentence);
}

TEST_CASE("a mesh that bounds no solid is refused with its first defect", "[scene]") {
    const std::string scene = "[[shape]]\nname = \"s\"\nkind = \"mesh\"\nfile = \"x.obj\"\n";
    SceneFolder folder;
    folder.write("scene.toml", scene);
    const auto starts = [&](const std::string& faces, const std::string& sentence) {
        const std::string said = folder.write("x.obj", tetrahedron_vertices + faces).complaint();
        INFO(said);
        CHECK(said.substr(0, sentence.size()) == sentence);
    };
    starts("f 1 3 2\nf 1 2 4\nf 2 3 4\n", "scene.toml:4:8: mesh 'x.obj' is open: edge ");
    starts("f 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n", "scene.toml:4:8: mesh 'x.obj' is inside out: ");
    starts("f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 3 4\n", "scene.toml:4:8: mesh 'x.obj' is not oriented: edge ");
    starts("f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 1 1 2\n", "scene.toml:4:8: mesh 'x.obj' is degenerate: ");
}
