// `kolize run` with a ledger and capsules, as a user meets them.
#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace kolize::test;
using nlohmann::json;

namespace {

// A body that tumbles, which momentum_euler cannot do without making energy, and a room around it.
const std::string tumbler = R"([step]
dt = 0.01
time = 0.5
[[shape]]
name = "brick"
kind = "box"
half_extents = [0.2, 0.5, 0.9]
[[body]]
name = "tumbler"
shape = "brick"
mass = 1
velocity = [3, 2, 1]
angular_velocity = [1, 2, 3]
[[room]]
min = [-2, -2, -2]
max = [2, 2, 2]
)";

std::string line_with(const std::string& text, const std::string& begin) {
    const std::size_t at = text.find(begin);
    return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
}

}  // namespace

TEST_CASE("run --ledger tells the first break, keeps its step, goes on and exits with 1", "[cli][ledger]") {
    const Shell shell;
    shell.folder.write("scene.toml", tumbler);
    const Outcome healthy = shell.kolize("run scene.toml --ledger --json r.json");
    CHECK(healthy.code == 0);
    CHECK(healthy.err.empty());
    CHECK(json::parse(file_bytes(shell.folder.path() / "r.json"))["ledger"]["broken"] == false);

    const Outcome broken = shell.kolize("run scene.toml --ledger --set step.integrator=momentum_euler --json r.json");
    CHECK(broken.code == 1);
    CHECK(broken.out.find("state hash") != std::string::npos);
    const std::string sentence = line_with(broken.err,
                                           "kolize: the ledger breaks at step 0 (0 s), integrator "
                                           "'momentum_euler', body 0 'tumbler': energy off by ");
    const std::string end = "; capsule: scene.step0.capsule.toml";
    REQUIRE(sentence.ends_with(end));
    const json ledger = json::parse(file_bytes(shell.folder.path() / "r.json"))["ledger"];
    CHECK(ledger["broken"] == true);
    CHECK(ledger["quantity"] == "energy");
    CHECK(ledger["bodies"] == json::array({0}));
    CHECK("kolize: " + ledger["sentence"].get<std::string>() + end == sentence);

    const std::size_t files = shell.files();
    const Outcome replay = shell.kolize("run scene.step0.capsule.toml");
    CHECK(replay.code == 1);
    CHECK(replay.err == sentence.substr(0, sentence.size() - end.size()) + "\n");  // no second capsule
    CHECK(shell.files() == files);
}

TEST_CASE("run --capsule-at keeps a step of a healthy run, which goes on from there to the same bits", "[cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", tumbler);
    const json all = json::parse(shell.kolize("run scene.toml --json - --capsule-at 20 --capsule c.toml").out);
    const json rest = json::parse(shell.kolize("run c.toml --steps 30 --json -").out);
    CHECK(rest["state_hash"] == all["state_hash"]);
    CHECK(all["accuracy"]["max_penetration_m"] > 0);
    CHECK(json::parse(shell.kolize("run c.toml --json -").out)["steps"] == 1);

    shell.kolize("run scene.toml --steps 21 --capsule-at 20");
    CHECK(file_bytes(shell.folder.path() / "scene.step20.capsule.toml") == file_bytes(shell.folder.path() / "c.toml"));
    const Outcome late = shell.kolize("run scene.toml --steps 20 --capsule-at 20");
    CHECK(late.code == 2);
    CHECK(late.err == "kolize: --capsule-at 20: there is no such step; the run has 20, from step 0\n");
}

TEST_CASE("run --capsule keeps the step in which a stage failed", "[cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", tumbler + "[world]\ngravity = [0, 1e308, 0]\n");
    const Outcome plain = shell.kolize("run scene.toml --set step.dt=100 --steps 3");
    CHECK(plain.code == 1);
    CHECK(plain.err == "kolize: integrator 'pdmv4' failed at step 0: the position of body 0 'tumbler' is not finite\n");
    CHECK(shell.files() == 3);  // the scene, out.txt, err.txt
    const Outcome kept = shell.kolize("run scene.toml --set step.dt=100 --steps 3 --capsule c.toml");
    CHECK(kept.code == 1);
    CHECK(kept.err == plain.err.substr(0, plain.err.size() - 1) + "; capsule: c.toml\n");
    CHECK(shell.kolize("run c.toml").err == plain.err);
}

TEST_CASE("run --expect takes a break of the scene's ledger for a failure", "[cli][ledger]") {
    const Shell shell;
    shell.folder.write("scene.toml", "[ledger]\ncheck = true\n" + tumbler);
    shell.folder.write("expect.toml",
                       "[[expect]]\nset = { \"step.integrator\" = \"momentum_euler\" }\nsteps = 3\n"
                       "escaped = { max = 0 }\n");
    const Outcome outcome = shell.kolize("run scene.toml --expect expect.toml");
    CHECK(outcome.code == 1);
    CHECK(outcome.out.find("the ledger breaks at step 0") != std::string::npos);
}

TEST_CASE("limits of the ledger are read and checked", "[cli][ledger]") {
    const Shell shell;
    shell.folder.write("scene.toml", tumbler);
    CHECK(shell.kolize("run scene.toml --ledger --set ledger.penetration=1e-9 --set ledger.energy=1").code == 1);
    CHECK(shell.kolize("run scene.toml --ledger --set ledger.penetration=9").code == 0);
    const Outcome wrong = shell.kolize("run scene.toml --ledger --set ledger.energie=1");
    CHECK(wrong.code == 2);
    CHECK(wrong.err == "kolize: --set ledger.energie: no key 'energie' in [ledger]; did you mean 'energy'?\n");
    CHECK(shell.kolize("run scene.toml --set ledger.momentum=-1").err ==
          "kolize: --set ledger.momentum: momentum must be at least 0, is -1\n");
}
