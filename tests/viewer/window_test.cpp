// kolize view in a window, worked by hand.
#include "cli/crowd.h"
#include "render/window_visit.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace kolize::test;

TEST_CASE("The panel switches the broadphase while the scene runs, and the recording of it has the same bits",
          "[viewer][window]") {
    Visit visit("kolize view scene.toml --size 900x700 --record hand.rec", "kolize: scene.toml",
                {{"scene.toml", crowd}});
    visit.keys("key --window %1 t sleep 0.3 keydown --window %1 g key --window %1 Down keyup --window %1 g");
    CHECK(visit.tells("drag 0.05 1/s"));
    CHECK(visit.tells("gravity 9.81 m/s^2"));
    // The plugins of the broadphase, the first list of the panel, and another one of them. A machine that is busy may
    // not have drawn the list when the second click comes.
    for (int attempt = 0; attempt < 8 && !visit.tells("broadphase.plugin = ", attempt); ++attempt) {
        visit.click(100, 60);
        visit.keys("sleep " + std::to_string(attempt));
        visit.click(60, 96);
    }
    CHECK(visit.tells("broadphase.plugin = "));
    visit.keys("sleep 0.5");
    const Outcome outcome = visit.end();
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    CHECK(outcome.out.find("refused") == std::string::npos);

    const std::string recording = file_bytes(visit.shell.folder.path() / "hand.rec");
    CHECK(recording.find(" pipeline 0\n") != std::string::npos);
    CHECK(recording.find(" forces ") != std::string::npos);
    const Outcome replay = visit.shell.kolize("run --replay hand.rec --json r.json");
    CHECK(replay.code == 0);
    CHECK(replay.out.find("replay: the same bits in all") != std::string::npos);
    const auto json = nlohmann::json::parse(file_bytes(visit.shell.folder.path() / "r.json"));
    CHECK(json["pipeline"]["broadphase"]["plugin"] != "grid");
    CHECK(outcome.out.find(json["state_hash"].get<std::string>()) != std::string::npos);
    // With one broadphase all along it comes to the same.
    CHECK(visit.shell.kolize("run --replay hand.rec --set broadphase.plugin=brute_force")
              .out.find("replay: the same bits in all") != std::string::npos);
}

TEST_CASE("view steps, takes a picture, and closes when its time is over", "[viewer][window]") {
    Visit visit("kolize view scene.toml --size 640x480 --paused --steps 3", "kolize: scene.toml",
                {{"scene.toml", crowd}});
    visit.keys("key --window %1 n sleep 0.3 key --window %1 F12");
    CHECK(visit.tells("kolize_1.png"));
    visit.keys("key --window %1 n sleep 0.3 key --window %1 n");
    CHECK(visit.wait().out.find("3 steps, state hash") != std::string::npos);
    const std::string picture = file_bytes(visit.shell.folder.path() / "kolize_1.png");
    CHECK(picture.substr(1, 3) == "PNG");
}

TEST_CASE("view without a display says what to do", "[viewer][window]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    const Outcome outcome = shell.kolize("view scene.toml");
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("kolize: renderer 'gl': no window: "));
    CHECK(outcome.err.find("--video") != std::string::npos);
}
