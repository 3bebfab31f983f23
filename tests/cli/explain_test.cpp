// kolize explain: each rule has a scene that just needs what is left out, and one that just does not.
#include "cli/crowd.h"
#include "cli/shell.h"
#include "explain/thickness.h"
#include "framework/scenes.h"
#include "framework/solids.h"
#include "narrowphase/solids.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace kolize::test;
using nlohmann::json;

namespace {

json explain(const Shell& shell, const std::string& options = "") {
    const Outcome outcome = shell.kolize("explain scene.toml --repeat 1 --json - " + options);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return json::parse(outcome.out);
}

const json& feature(const json& answer, const std::string& begin) {
    for (const json& f : answer["features"])
        if (f["feature"].get<std::string>().starts_with(begin)) return f;
    throw std::runtime_error("no feature " + begin);
}

std::string two_balls(const std::string& world, const std::string& material, const std::string& rest = "") {
    return "[world]\n" + world + "\n[step]\ndt = 0.01\ntime = 0.1\n[[material]]\nname = \"stuff\"\n" + material + R"(
[[shape]]
name = "ball"
kind = "sphere"
radius = 0.5
[[body]]
shape = "ball"
material = "stuff"
mass = 1
velocity = [1, 0, 0]
[[body]]
shape = "ball"
material = "stuff"
mass = 1
position = [3, 0, 0]
)" + rest;
}

// A ball of 1 m and a plate of 0.25 m: the ball passes the plate unseen if a step carries it farther than 1.25 m.
std::string bullet(const std::string& speed) {
    return R"(
[step]
dt = 0.25
time = 0.25
[[shape]]
name = "ball"
kind = "sphere"
radius = 0.5
[[shape]]
name = "plate"
kind = "box"
half_extents = [0.125, 4, 4]
[[body]]
name = "bullet"
shape = "ball"
mass = 1
position = [-100, 0, 0]
velocity = [)" +
           speed + R"(, 0, 0]
[[body]]
shape = "plate"
static = true
)";
}

}  // namespace

TEST_CASE("friction is modelled from the least of it on, if there is a response for it", "[cli][explain]") {
    const Shell shell;
    const std::string solver = "[[response]]\nplugin = \"solver\"\n";
    shell.folder.write("scene.toml", two_balls("", "friction = 0", solver));
    CHECK(feature(explain(shell), "friction")["modelled"] == false);
    shell.folder.write("scene.toml", two_balls("", "friction = 1e-300", solver));
    CHECK(feature(explain(shell), "friction")["modelled"] == true);
    shell.folder.write("scene.toml", two_balls("", "friction = 1e-300"));
    const json without = feature(explain(shell), "friction");
    CHECK(without["modelled"] == false);
    CHECK(without["wrong_when"].get<std::string>().starts_with("now"));
}

TEST_CASE("forces are modelled from the least gravity on", "[cli][explain]") {
    const Shell shell;
    shell.folder.write("scene.toml", two_balls("gravity = [0, 0, 0]", ""));
    CHECK(feature(explain(shell), "forces")["modelled"] == false);
    shell.folder.write("scene.toml", two_balls("gravity = [0, -1e-300, 0]", ""));
    CHECK(feature(explain(shell), "forces")["modelled"] == true);
}

TEST_CASE("contacts get as much detail as a response uses, and model.detail gives all", "[cli][explain]") {
    const Shell shell;
    shell.folder.write("scene.toml", two_balls("", "", "[[response]]\nplugin = \"explode\"\n"));
    const json lean = feature(explain(shell), "contacts up to overlap");
    CHECK(lean["modelled"] == false);
    CHECK(lean["other"] == json({{"model.detail", "most"}}));
    CHECK(feature(explain(shell, "--set model.detail=most"), "contacts up to manifold")["modelled"] == true);
    shell.folder.write("scene.toml", two_balls("", "", "[[response]]\nplugin = \"impulse\"\n"));
    CHECK(feature(explain(shell), "contacts up to manifold")["modelled"] == true);
}

TEST_CASE("a run warns when a body begins to move farther in a step than things are thick", "[cli][explain]") {
    const Shell shell;
    for (const bool too_fast : {false, true}) {
        shell.folder.write("scene.toml", bullet(too_fast ? "5.0000001" : "5"));
        const Outcome run = shell.kolize("run scene.toml");
        CHECK((run.err.find("'bullet'") != std::string::npos) == too_fast);
        CHECK(shell.kolize("run scene.toml --set step.mode=continuous").err.empty());
        const std::string wrong = feature(explain(shell), "what happens between")["wrong_when"];
        CHECK(wrong.find("0.25 s") != std::string::npos);  // the step at which it begins to be wrong, either way
    }
}

TEST_CASE("explain --check-minimal finds that nothing was left out that mattered, or where it did", "[cli][explain]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    const Outcome crowded = shell.kolize("explain scene.toml --check-minimal --steps 100 --json -");
    const json found = json::parse(crowded.out);
    CHECK(found["same"] == (crowded.code == 0));
    shell.folder.write("scene.toml", two_balls("", ""));
    const Outcome same = shell.kolize("explain scene.toml --check-minimal");
    CHECK(same.code == 0);
    CHECK(same.out.find("the same bits in all steps") != std::string::npos);
    // Two bars are balls to a rule that asks for no more; as bars they fly past each other.
    shell.folder.write("bars.toml", R"(
[step]
dt = 0.01
time = 1
[[shape]]
name = "bar"
kind = "box"
half_extents = [1, 0.1, 0.1]
[[body]]
shape = "bar"
mass = 1
velocity = [0, 2, 0]
[[body]]
shape = "bar"
mass = 1
position = [1.5, 1.8, 0.5]
[[response]]
plugin = "simple_bounce"
)");
    const Outcome apart = shell.kolize("explain bars.toml --check-minimal --json -");
    CHECK(apart.code == 1);
    CHECK(json::parse(apart.out)["alone"] == json({"model.bounding_spheres=false"}));
    CHECK(shell.kolize("run bars.toml --force-all").out != shell.kolize("run bars.toml").out);
}

TEST_CASE("what leaves no trace in the state gives the same bits the other way", "[cli][explain]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    const json answer = explain(shell, "--steps 50");
    CHECK(feature(answer, "broadphase")["saving_ms"]["same_bits"] == true);
    CHECK(feature(answer, "ledger")["saving_ms"]["same_bits"] == true);
}

TEST_CASE("the thickness of shapes is that of their thinnest place", "[explain]") {
    using namespace kolize;
    using kolize::cli::thickness;
    CHECK(thickness(make_sphere("", 0.5)) == 1);
    CHECK(thickness(make_box("", Vec3(3, 0.25, 1))) == 0.5);
    CHECK(thickness(make_capsule("", 0.25, 2)) == 0.5);
    CHECK(thickness(make_half_space("", Vec3::UnitY(), 0)) == infinity);
    CHECK(thickness(make_mesh("", box_soup(Vec3(3, 0.25, 1)))) == Approx(0.5));
}
