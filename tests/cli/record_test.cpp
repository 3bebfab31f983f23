// kolize run --record and --replay as a user meets them.
#include "cli/crowd.h"
#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace kolize::test;
using nlohmann::json;

TEST_CASE("run --replay repeats a recording to the same bits, with any broadphase and number of threads",
          "[cli][record]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    const json first = json::parse(shell.kolize("run scene.toml --record run.rec --json - --threads 1").out);
    std::filesystem::remove(shell.folder.path() / "scene.toml");  // the recording needs no other file
    const Outcome again = shell.kolize("run --replay run.rec --threads 2");
    CHECK(again.code == 0);
    CHECK(again.out.ends_with("replay: the same bits in all 100 steps\n"));
    const json other = json::parse(shell.kolize("run --replay run.rec --set broadphase.plugin=bsp --json -").out);
    CHECK(other["replay"] == json({{"steps", 100}, {"same", true}}));
    CHECK(other["state_hash"] == first["state_hash"]);
    CHECK(shell.kolize("run --replay run.rec --steps 30").out.ends_with("the same bits in all 30 steps\n"));
}

TEST_CASE("run --replay with another pipeline says where the two part", "[cli][record]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    shell.kolize("run scene.toml --record run.rec");
    const Outcome other = shell.kolize("run --replay run.rec --set step.integrator=momentum_euler --json r.json");
    CHECK(other.code == 0);
    CHECK(other.out.ends_with("replay: the two part at step 0 (0 s)\n"));
    const json replay = json::parse(file_bytes(shell.folder.path() / "r.json"))["replay"];
    CHECK(replay == json({{"steps", 100}, {"same", false}, {"parts_at_step", 0}}));
}

TEST_CASE("A recording whose states are not those of its own pipeline fails at that step", "[cli][record]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    shell.kolize("run scene.toml --record run.rec");
    std::string text = file_bytes(shell.folder.path() / "run.rec");
    std::size_t line = text.find("hashes = ");
    for (int i = 0; i < 43; ++i) line = text.find('\n', line) + 1;  // of step 42
    text[line] = text[line] == '0' ? '1' : '0';
    shell.folder.write("run.rec", text);
    const Outcome replay = shell.kolize("run --replay run.rec");
    CHECK(replay.code == 1);
    CHECK(replay.out.ends_with("replay: the two part at step 42 (0.42 s)\n"));
}

TEST_CASE("Recordings and scenes are not taken for each other", "[cli][record]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    shell.kolize("run scene.toml --record run.rec --steps 5");
    const auto refusal = [&](const std::string& arguments) {
        const Outcome outcome = shell.kolize(arguments);
        CHECK(outcome.code == 2);
        CHECK(outcome.out.empty());
        return outcome.err;
    };
    CHECK(refusal("run run.rec").find("this is a recording, which is played with --replay") != std::string::npos);
    CHECK(refusal("run --replay scene.toml") ==
          "kolize: scene.toml: this is no recording: it has no tables [capsule] and [recording]; kolize run --record "
          "makes one\n");
    CHECK(refusal("run --replay run.rec --steps 6") == "kolize: the recording has 5 steps; asked for are 6\n");
    CHECK(refusal("run scene.toml --replay run.rec") ==
          "kolize: --replay has a scene of its own; leave scene.toml out\n");
    CHECK(refusal("run") == "kolize: a scene file is wanted, or --replay with a recording\n");
}
