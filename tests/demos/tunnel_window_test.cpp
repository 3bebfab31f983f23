// The game in its window, played by hand.
#include "render/window_visit.h"

#include <nlohmann/json.hpp>

using namespace kolize::test;

TEST_CASE("The tunnel is flown by keys in a window, and what was recorded of it plays to the same bits",
          "[tunnel][window]") {
    Visit visit("kolize-tunnel --record hand.rec --json hand.json", "Tunnel transit", {});
    visit.keys("key --window %1 Return sleep 0.3 keydown --window %1 w sleep 2 keyup --window %1 w");
    visit.keys("sleep 0.5 key --window %1 f sleep 3");
    const Outcome outcome = visit.end();
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    const auto json = nlohmann::json::parse(file_bytes(visit.shell.folder.path() / "hand.json"));
    CHECK(json["phase"] == "ended");
    CHECK(json["fighter"]["flight_time_s"] > 0.1);
    visit.shell.folder.write("nothing.keys", "# nobody flies\n");
    REQUIRE(visit.shell.run("kolize-tunnel --keys nothing.keys --time 0.1 --json start.json").code == 0);
    const auto start = nlohmann::json::parse(file_bytes(visit.shell.folder.path() / "start.json"));
    const double from = start["fighter"]["position_m"][2], to = json["fighter"]["position_m"][2];
    CHECK(to < from - 0.01);  // forward is along -z
    CHECK(json["fighter"]["missiles"] == 1);
    const Outcome replay = visit.shell.kolize("run --replay hand.rec --json replay.json");
    CHECK(replay.out.find("replay: the same bits in all") != std::string::npos);
    CHECK(nlohmann::json::parse(file_bytes(visit.shell.folder.path() / "replay.json"))["state_hash"] ==
          json["state_hash"]);
}
