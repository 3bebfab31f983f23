// The built program as a user meets it: exit codes, what stands on which stream, and the files it leaves.
#include "cli/shell.h"

#include <kolize/plugin.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace kolize::test;
using nlohmann::json;

namespace {

// Two balls that meet after 1 s, head on, and bounce back.
const std::string two_balls = R"([step]
dt = 0.01
time = 2
[[shape]]
name = "ball"
kind = "sphere"
radius = 1
[[body]]
shape = "ball"
mass = 1
position = [-2, 0, 0]
velocity = [1, 0, 0]
[[body]]
shape = "ball"
mass = 1
position = [2, 0, 0]
velocity = [-1, 0, 0]
)";

// A cube about the origin, outward.
std::string cube(const std::string& half) {
    std::string text;
    for (const char* signs : {"---", "+--", "++-", "-+-", "--+", "+-+", "+++", "-++"}) {
        text += "v";
        for (const char* sign = signs; *sign; ++sign) text += *sign == '-' ? " -" + half : " " + half;
        text += "\n";
    }
    return text + "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4\nf 2 3 7 6\n";
}

}  // namespace

TEST_CASE("the program says its version and how it is used", "[cli]") {
    const Shell shell;
    const Outcome version = shell.kolize("--version");
    CHECK(version.code == 0);
    CHECK(version.out.find("(plugin API " + std::to_string(kolize::plugin_api) + ")") != std::string::npos);
    for (const std::string command : {"run", "compare", "bench", "check", "plugins", "plugins list", "plugins show",
                                      "plugins test", "plugins docs"}) {
        const Outcome help = shell.kolize(command + " --help");
        CAPTURE(command);
        CHECK(help.code == 0);
        CHECK(help.out.find("Example: kolize " + command) != std::string::npos);
    }
}

TEST_CASE("wrong usage and bad input exit with 2 and one sentence on stderr", "[cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", "[step]\ndt = -1\n");
    shell.folder.write("good.toml", two_balls);
    const auto [arguments, sentence] = GENERATE(table<std::string, std::string>({
        {"run scene.toml", "kolize: scene.toml:2:6: dt must be greater than 0, is -1\n"},
        {"run no.toml", "kolize: scene file 'no.toml' does not exist\n"},
        {"run good.toml --set step.dt", "kolize: --set step.dt: KEY=VALUE is wanted, such as broadphase.plugin=grid\n"},
        {"compare good.toml --vary step.dt=0.1,zero",
         "kolize: --set step.dt: dt must be a number, is the text \"zero\"\n"},
        {"run good.toml --steps 1 --json no/such.json", "kolize: file 'no/such.json' cannot be written\n"},
        {"plugins show gird", "kolize: there is no plugin 'gird'; did you mean 'grid'?\n"},
    }));
    const Outcome outcome = shell.kolize(arguments);
    CAPTURE(arguments);
    CHECK(outcome.code == 2);
    CHECK(outcome.err == sentence);
    CHECK(shell.kolize("").code == 2);
    CHECK(shell.kolize("run good.toml --steps 1 --time 1").code == 2);
    CHECK(shell.kolize("fly").code == 2);
}

TEST_CASE("run writes what it measured as JSON, and nothing else on stdout", "[cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", two_balls);
    const Outcome outcome = shell.kolize("run scene.toml --json - --threads 1 --set narrowphase.contact=averaged");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json result = json::parse(outcome.out);
    CHECK(result["scene"] == "scene.toml");
    CHECK(result["bodies"] == 2);
    CHECK(result["steps"] == 200);
    CHECK(result["dt"] == 0.01);
    CHECK(result["threads"] == 1);
    for (const char* stage : {"broadphase", "narrowphase", "response", "integrate", "step"})
        for (const char* key : {"median_us", "p95_us", "total_s"}) CHECK(result["stages"][stage][key].is_number());
    for (const char* key : {"pairs", "contacts", "triangle_tests", "events"}) CHECK(result["counts"].contains(key));
    CHECK(result["counts"]["contacts"] > 0);
    CHECK(result["accuracy"]["energy_initial_J"] == Approx(1));
    CHECK(result["accuracy"]["energy_drift"] < 1e-12);
    for (const char* key :
         {"energy_final_J", "momentum_drift", "angular_momentum_drift", "max_penetration_m", "escaped", "stuck"})
        CHECK(result["accuracy"].contains(key));
    CHECK(result["peak_memory_bytes"] > 1000000);
    CHECK(result["state_hash"].get<std::string>().size() == 16);
    CHECK(result["pipeline"]["broadphase"]["plugin"] == "grid");
    CHECK(result["pipeline"]["broadphase"].size() > 1);  // parameters in force, given or not
    CHECK(result["pipeline"]["narrowphase"]["contact"] == "averaged");
    CHECK(result["pipeline"]["response"][0]["plugin"] == "impulse");
    CHECK(result["pipeline"]["step"]["mode"] == "discrete");
}

TEST_CASE("results do not depend on the number of threads", "[cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", two_balls);
    const json one = json::parse(shell.kolize("run scene.toml --json - --threads 1").out);
    const json three = json::parse(shell.kolize("run scene.toml --json - --threads 3").out);
    CHECK(one["state_hash"] == three["state_hash"]);
    CHECK(one["accuracy"] == three["accuracy"]);
}

TEST_CASE("a JSON file stands there whole or not at all", "[cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", two_balls);
    shell.folder.write("broken.toml", "[step]\ndt = 0\n");
    CHECK(shell.kolize("run broken.toml --json r.json").code == 2);
    CHECK(shell.files() == 4);  // the two scenes, out.txt, err.txt
    CHECK(shell.kolize("run scene.toml --steps 3 --json r.json").code == 0);
    CHECK(shell.files() == 5);
    CHECK(json::parse(file_bytes(shell.folder.path() / "r.json"))["steps"] == 3);
}

TEST_CASE("run --expect says which bounds hold and exits with 1 if one does not", "[cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", two_balls);
    shell.folder.write("holds.toml", "[[expect]]\nenergy_drift = { max = 1e-12 }\ncontacts = { min = 1 }\n");
    shell.folder.write("broken.toml", "[[expect]]\nsteps = 10\ncontacts = { min = 1 }\n");
    CHECK(shell.kolize("run scene.toml --expect holds.toml").code == 0);
    const Outcome broken = shell.kolize("run scene.toml --expect broken.toml");
    CHECK(broken.code == 1);
    CHECK(broken.out.find("broken.toml:3:12: contacts is 0") != std::string::npos);
}

TEST_CASE("compare runs every combination and marks those that nothing beats", "[cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", two_balls);
    const Outcome outcome = shell.kolize(
        "compare scene.toml --vary broadphase.plugin=grid,brute_force "
        "--vary step.dt=0.01,0.02,0.04 --repeat 2 --report out --json -");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json result = json::parse(outcome.out);
    REQUIRE(result["variants"].size() == 6);
    CHECK(result["repeat"] == 2);
    std::size_t front = 0;
    for (const json& variant : result["variants"]) {
        CHECK(variant["pipeline"]["broadphase"]["plugin"] == variant["vary"]["broadphase.plugin"]);
        CHECK(variant["dt"] == std::stod(variant["vary"]["step.dt"].get<std::string>()));
        CHECK(variant["repeatable"] == true);
        front += variant["front"].get<bool>();
    }
    CHECK(front >= 1);
    for (std::size_t i = 0; i < 3; ++i)  // the broadphase cannot change what happens
        CHECK(result["variants"][i]["state_hash"] == result["variants"][i + 3]["state_hash"]);
    for (const char* file : {"compare.txt", "compare.csv", "compare.json"})
        CHECK(std::filesystem::file_size(shell.folder.path() / "out" / file) > 0);
}

TEST_CASE("check tells for each pose whether two meshes overlap", "[cli]") {
    const Shell shell;
    shell.folder.write("cube.obj", cube("1"));
    shell.folder.write("small.obj", cube("0.5"));
    // Through the +x face by 0.2, apart by 0.1, and turned by a quarter about z through the +y face.
    const std::string poses =
        "1,0,0,0,1.3,0.1,0.2\n1,0,0,0,1.6,0,0\n0.7071067811865476,0,0,0.7071067811865476,0.2,1.3,0.1\n";
    shell.folder.write("poses.csv", poses);
    shell.folder.write("named.csv", "qw,qx,qy,qz,x,y,z\n" + poses);
    const Outcome outcome = shell.kolize("check cube.obj small.obj --poses poses.csv --json -");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json result = json::parse(outcome.out);
    REQUIRE(result["poses"].size() == 3);
    CHECK(result["poses"][0]["overlap"] == true);
    CHECK(result["poses"][0]["triangle_pairs"] > 0);
    CHECK(result["poses"][0]["contacts"][0]["normal"][0].get<double>() == Approx(1));
    CHECK(result["poses"][0]["contacts"][0]["depth"].get<double>() == Approx(0.2));
    CHECK(result["poses"][1]["overlap"] == false);
    CHECK(result["poses"][1]["contacts"].empty());
    CHECK(result["poses"][2]["contacts"][0]["normal"][1].get<double>() == Approx(1));
    const json named = json::parse(shell.kolize("check cube.obj small.obj --poses named.csv --json -").out);
    CHECK(named["poses"][2]["contacts"] == result["poses"][2]["contacts"]);

    shell.folder.write("open.obj", cube("1").substr(0, cube("1").rfind("f ")));
    const Outcome open = shell.kolize("check open.obj small.obj --poses poses.csv");
    CHECK(open.code == 2);
    CHECK(open.err.starts_with("kolize: mesh 'open.obj' is not the closed surface of a solid: "));
}

TEST_CASE("plugins are listed and described", "[cli]") {
    const Shell shell;
    const json list = json::parse(shell.kolize("plugins list --json").out);
    CHECK(list["plugin_api"] == kolize::plugin_api);
    std::vector<std::string> names;
    for (const json& plugin : list["plugins"]) names.push_back(plugin["name"]);
    for (const char* name : {"brute_force", "grid", "moller", "impulse"})
        CHECK(std::find(names.begin(), names.end(), name) != names.end());
    const Outcome show = shell.kolize("plugins show moller");
    CHECK(show.code == 0);
    CHECK(show.out.find("contact = \"contour\"") != std::string::npos);
}
