// `kolize run --judge` and `kolize check CAPSULE`, as a user meets them.
#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>

using namespace kolize::test;
using nlohmann::json;

namespace {

// Two wedges of 0.2 mm that fly into each other, corner first. The plugin any_size of the tests overlooks triangles
// below 1 mm; it stands in a folder of its own, beside liars that nobody asks for here.
const std::string wedge =
    "v 0 0 0\nv 1e-4 0 0\nv 0 2e-4 0\nv 0 0 1e-4\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const std::string wedges = R"([step]
dt = 0.001
time = 0.08
[[shape]]
name = "wedge"
kind = "mesh"
file = "wedge.obj"
[[body]]
name = "left"
shape = "wedge"
mass = 1
position = [-2e-4, 1e-5, 0]
velocity = [4e-3, 0, 0]
[[body]]
name = "right"
shape = "wedge"
mass = 1
position = [2e-4, 1.2e-4, 1e-5]
orientation = [0, 0, 0, 1]
velocity = [-4e-3, 0, 0]
)";

// Two that hit each other edge on face.
const std::string bricks = R"([step]
dt = 0.01
time = 1
[[shape]]
name = "brick"
kind = "box"
half_extents = [0.1, 0.5, 0.2]
[[body]]
shape = "brick"
mass = 1
position = [-0.5, 0, 0]
velocity = [1, 0, 0]
orientation = [0.96, 0.28, 0, 0]
[[body]]
shape = "brick"
mass = 1
position = [0.5, 0.1, 0.05]
orientation = [0.96, 0, 0, 0.28]
)";

void write_scene(const Shell& shell, const std::string& plugin = "any_size") {
    shell.folder.write("wedge.obj", wedge);
    shell.folder.write("scene.toml", wedges);
    std::filesystem::copy_file(KOLIZE_BINARY_DIR "/false_claims/narrowphase_" + plugin + ".so",
                               shell.folder.path() / ("narrowphase_" + plugin + ".so"));
}

json verdict(const json& judges, const std::string& plugin, const std::string& role) {
    for (const json& one : judges["verdicts"])
        if (one["plugin"] == plugin && one["role"] == role) return one;
    FAIL("no verdict on " << plugin);
    return {};
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

TEST_CASE("a wrong driver is caught by its judges, and what it overlooked replays in check", "[cli][judge]") {
    const Shell shell;
    write_scene(shell);
    const Outcome run = shell.kolize(
        "run scene.toml --set narrowphase.plugin=any_size --judge exact,moller --disagreements d --keep 3 --json -");
    INFO(run.err);
    REQUIRE(run.code == 0);
    const json judges = json::parse(run.out)["judges"];
    CHECK(judges["truth"] == "exact");
    const json driver = verdict(judges, "any_size", "drives");
    const std::uint64_t misses = driver["misses"]["count"];
    CHECK(misses > 3);
    CHECK(driver["false_hits"]["count"] == 0);
    CHECK(driver["misses"]["low"] > 0);
    CHECK(driver["asked"] == driver["misses"]["of"].get<int>() + driver["false_hits"]["of"].get<int>());
    const json moller = verdict(judges, "moller", "judge");
    CHECK(moller["misses"]["count"] == 0);
    CHECK(moller["misses"]["high"] == Approx(std::min(1.0, 3.0 / moller["misses"]["of"].get<double>())));
    CHECK(moller["normal_angle_rad"]["max"] < 1e-9);
    CHECK(judges["disagreements"]["count"] == misses);
    CHECK(judges["disagreements"]["kept"].size() == 3);

    const std::vector<std::string> files = files_in(shell.folder.path() / "d");
    REQUIRE(files.size() == 3);
    const std::string capsule = "d/" + files.front();
    CHECK(file_bytes(shell.folder.path() / capsule).find("triangle") != std::string::npos);  // no more than two
    const Outcome check = shell.kolize("check " + capsule + " --plugin-path . --json -");
    CHECK(check.code == 1);
    const json said = json::parse(check.out);
    CHECK(said["pairs"] == json::parse("[[0, 1]]"));
    for (const json& one : said["narrowphases"]) {
        CAPTURE(one["plugin"]);
        CHECK((one["misses"] == 1) == (one["plugin"] == "any_size"));
        CHECK(one["false_hits"] == 0);
        if (one["plugin"] == "sat") CHECK(one["answers"] == json::array({"not asked"}));
    }
    CHECK(shell.kolize("check " + capsule + " --set narrowphase.plugin=moller").code == 0);
    CHECK(shell.kolize("check " + capsule + " --plugin-path . --set narrowphase.plugin=any_size").code == 1);
}

TEST_CASE("judges leave the run as it is", "[cli][judge]") {
    const Shell shell;
    write_scene(shell);
    const json alone = json::parse(shell.kolize("run scene.toml --json -").out);
    const json judged = json::parse(shell.kolize("run scene.toml --judge exact,fcl,any_size --json -").out);
    CHECK(judged["state_hash"] == alone["state_hash"]);
    CHECK_FALSE(alone.contains("judges"));
    CHECK(verdict(judged["judges"], "any_size", "judge")["misses"]["count"] > 0);
    CHECK(verdict(judged["judges"], "moller", "drives")["misses"]["count"] == 0);
}

TEST_CASE("pairs that a judge does not take are counted, and touching is not judged", "[cli][judge]") {
    const Shell shell;
    write_scene(shell);
    const json judges = json::parse(shell.kolize("run scene.toml --judge exact,sat --json -").out)["judges"];
    const json sat = verdict(judges, "sat", "judge");
    CHECK(sat["asked"] == 0);
    CHECK(sat["not_asked"] == verdict(judges, "exact", "truth")["asked"]);
    const json touching =
        json::parse(shell.kolize("run scene.toml --judge exact --set step.mode=continuous --json -").out)["judges"];
    CHECK(touching["touching_calls_not_judged"] > 0);
    CHECK(touching["calls"] == 0);
}

TEST_CASE("a judge whose contacts make no sense is not counted as asked", "[cli][judge]") {
    const Shell shell;
    write_scene(shell);
    std::filesystem::copy_file(KOLIZE_BAD_PLUGIN_DIR "/liar_narrowphase.so", shell.folder.path() / "liar.so");
    const Outcome run = shell.kolize("run scene.toml --judge exact,liar,moller --json -");
    INFO(run.err);
    REQUIRE(run.code == 0);
    const json judges = json::parse(run.out)["judges"];
    const json liar = verdict(judges, "liar", "judge");
    CHECK(liar["asked"] == 0);
    CHECK(liar["failed_calls"] == judges["calls"]);
    CHECK(liar["first_failure"].get<std::string>().find("bodies 0 and 1 without a direction") != std::string::npos);
    CHECK(verdict(judges, "moller", "judge")["asked"] == verdict(judges, "exact", "truth")["asked"]);
}

TEST_CASE("a judge that gives less detail is held against the truth in that detail", "[cli][judge]") {
    const Shell shell;
    shell.folder.write("scene.toml", bricks);
    const json judges = json::parse(shell.kolize("run scene.toml --judge exact,gjk_epa,sat --json -").out)["judges"];
    for (const char* plugin : {"gjk_epa", "sat"}) {
        CAPTURE(plugin);
        const json one = verdict(judges, plugin, "judge");
        CHECK(one["misses"]["of"] > 0);
        CHECK(one["misses"]["count"] == 0);
        CHECK(one["depth_error_in_radii"]["count"] == one["misses"]["of"]);
        CHECK(one["depth_error_in_radii"]["max"] < 1e-6);
        CHECK(one["normal_angle_rad"]["max"] < 1e-6);
    }
    const json truth = verdict(judges, "exact", "truth");
    CHECK(truth["call_us"]["count"] == judges["calls"]);
}

TEST_CASE("bodies that are no meshes are kept whole", "[cli][judge]") {
    const Shell shell;
    shell.folder.write("scene.toml", R"([step]
dt = 0.01
time = 0.3
[[shape]]
name = "rod"
kind = "box"
half_extents = [0.1, 1, 0.1]
[[body]]
name = "left"
shape = "rod"
mass = 1
position = [-0.5, 0, 0]
orientation = [0.92388, 0, 0, 0.38268]
[[body]]
name = "right"
shape = "rod"
mass = 1
position = [0.5, 0, 0]
orientation = [0.92388, 0, 0, 0.38268]
velocity = [0.1, 0, 0]
)");
    const Outcome run = shell.kolize(
        "run scene.toml --set narrowphase.plugin=bounding_volume --set narrowphase.volume=sphere --disagreements d");
    INFO(run.out << run.err);
    REQUIRE(run.code == 0);
    CHECK(run.out.find("judged by exact") != std::string::npos);
    const std::vector<std::string> files = files_in(shell.folder.path() / "d");
    REQUIRE(!files.empty());
    const Outcome all = shell.kolize("check d/" + files.front());
    CHECK(all.code == 0);
    CHECK(all.out.find("bounding_volume is left out") != std::string::npos);
    const Outcome named = shell.kolize("check d/" + files.front() +
                                       " --set narrowphase.plugin=bounding_volume --set narrowphase.volume=sphere");
    CHECK(named.code == 1);
    CHECK(named.out.find("0 'left', 1 'right'") != std::string::npos);
}

TEST_CASE("bad input of judges and of check CAPSULE is refused in a sentence", "[cli][judge]") {
    const Shell shell;
    write_scene(shell);
    const Outcome unknown = shell.kolize("run scene.toml --judge exakt");
    CHECK(unknown.code == 2);
    CHECK(unknown.err.find("exact") != std::string::npos);
    const Outcome scene = shell.kolize("check scene.toml");
    CHECK(scene.code == 2);
    CHECK(scene.err.find("kolize: 'scene.toml' is no capsule of a step") == 0);
    CHECK(shell.kolize("check wedge.obj wedge.obj").code == 2);
    CHECK(shell.kolize("check none.toml").code == 2);
    CHECK(shell.kolize("run scene.toml --judge exact --disagreements scene.toml/d").code == 2);
    CHECK(shell.kolize("run scene.toml --judge exact --disagreements .").err ==
          "kolize: folder '.' is not empty; one of its own is wanted\n");
}
