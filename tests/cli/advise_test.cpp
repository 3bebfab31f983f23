// kolize advise as a user meets it: what it chooses keeps the limits, and is the cheapest that does.
#include "cli/crowd.h"
#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace kolize::test;
using nlohmann::json;

namespace {

// A ball that flies through the walls of its room in a step, unless it is followed.
const std::string bullet = R"(
[step]
dt = 0.01
time = 2
[[shape]]
name = "ball"
kind = "sphere"
radius = 0.1
[[body]]
shape = "ball"
mass = 1
velocity = [310, 70, 0]
[[room]]
min = [-1, -1, -1]
max = [1, 1, 1]
thickness = 0.1
[narrowphase]
walls = "box"
)";

const json& chosen(const json& answer) { return answer["candidates"][answer["chosen"].get<std::size_t>()]; }

}  // namespace

TEST_CASE("advise writes a pipeline file that keeps the limits and repeats its run", "[cli][advise]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    const Outcome outcome = shell.kolize(
        "advise scene.toml --max-drift 1e-3 --time 1 --vary narrowphase.plugin=moller,exact "
        "--vary step.dt=0.01,0.02 --output found.toml --json -");
    REQUIRE(outcome.code == 0);
    const json answer = json::parse(outcome.out);
    CHECK(answer["candidates"].size() == 2 * 2 * 4);
    const json& tried = chosen(answer)["tried"];
    CHECK(tried["energy_drift"] <= 1e-3);
    const json again = json::parse(shell.kolize("run scene.toml --pipeline found.toml --time 1 --json -").out);
    CHECK(again["state_hash"] == tried["state_hash"]);
    CHECK(again["pipeline"]["step"]["mode"] == chosen(answer)["settings"]["step.mode"]);
    CHECK(again["pipeline"]["broadphase"]["plugin"] == answer["broadphases"][0]["plugin"]);
}

TEST_CASE("advise takes nothing through which bodies escape", "[cli][advise]") {
    const Shell shell;
    shell.folder.write("scene.toml", bullet);
    const json answer = json::parse(
        shell
            .kolize("advise scene.toml --max-drift 1e-9 --vary narrowphase.plugin=moller --vary step.dt=0.01 "
                    "--vary step.mode=discrete,continuous --json -")
            .out);
    CHECK(answer["candidates"][0]["breaks"] == "1 escaped");
    CHECK(chosen(answer)["settings"]["step.mode"] == "continuous");
}

TEST_CASE("advise --max-missed asks the judge on the run's own states", "[cli][advise]") {
    const Shell shell;
    // Two boxes on edge, one beside the other: their bounding boxes and spheres overlap, and they do not.
    shell.folder.write("scene.toml", R"(
[step]
dt = 0.01
time = 1
[[shape]]
name = "box"
kind = "box"
half_extents = [0.5, 0.5, 0.5]
[[body]]
shape = "box"
mass = 1
orientation = [0.9238795325112867, 0, 0, 0.3826834323650898]
[[body]]
shape = "box"
mass = 1
orientation = [0.9238795325112867, 0, 0, 0.3826834323650898]
position = [1.2, 1.2, 0]
)");
    const json answer = json::parse(
        shell
            .kolize("advise scene.toml --max-missed 0 --vary narrowphase.plugin=bounding_volume,moller "
                    "--vary narrowphase.volume=sphere --vary step.dt=0.01 --vary step.mode=discrete --json -")
            .out);
    const json& candidates = answer["candidates"];
    REQUIRE(candidates.size() == 2);
    CHECK(candidates[0]["breaks"].get<std::string>().find("false hits") != std::string::npos);
}

TEST_CASE("advise finds nothing where nothing keeps the limits, and writes nothing", "[cli][advise]") {
    const Shell shell;
    shell.folder.write("scene.toml", bullet);
    const Outcome outcome = shell.kolize(
        "advise scene.toml --max-drift 1e-9 --vary narrowphase.plugin=moller --vary step.dt=0.01 "
        "--vary step.mode=discrete");
    CHECK(outcome.code == 1);
    CHECK(outcome.out.find("None of them keeps the limits.") != std::string::npos);
    CHECK(!std::filesystem::exists(shell.folder.path() / "advised.toml"));
}

TEST_CASE("advise --full says what a search of everything would have chosen", "[cli][advise]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    const json answer =
        json::parse(shell
                        .kolize("advise scene.toml --budget-ms 1000 --time 0.5 --full --vary narrowphase.plugin=moller "
                                "--vary step.mode=discrete,continuous --vary step.dt=0.01,0.02,0.005 --json -")
                        .out);
    for (const json& candidate : answer["candidates"]) CHECK(!candidate["tried"].is_null());
    const json& best = answer["candidates"][answer["best_of_full"].get<std::size_t>()];
    CHECK(best["tried"]["energy_drift"] == chosen(answer)["tried"]["energy_drift"]);
}

TEST_CASE("advise refuses a question without a limit and a judge that is not there", "[cli][advise]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    const Outcome open = shell.kolize("advise scene.toml");
    CHECK(open.code == 2);
    CHECK(open.err.find("--max-drift") != std::string::npos);
    const Outcome judge = shell.kolize("advise scene.toml --max-missed 0 --judge nobody");
    CHECK(judge.code == 2);
    CHECK(judge.err.find("nobody") != std::string::npos);
    CHECK(shell.kolize("advise scene.toml --max-drift -1").code == 2);
}
