#include "cli/shell.h"
#include "demos/tunnel_games.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

std::vector<TimedEvent> project_script(const std::string& name) {
    return read_key_script(tunnel_folder / "scripts" / (name + ".keys"));
}

struct Flown {
    std::uint64_t hash = 0;
    Phase phase = Phase::ready;
    std::uint64_t explosions = 0;
    bool stayed_inside = true;
};

Flown fly(const std::string& name, int threads) {
    const TunnelScene tunnel = project_tunnel(name);
    const std::vector<TimedEvent> script = project_script(name);
    const std::unique_ptr<Host> host = make_host(threads);
    Game game = game_of(tunnel);
    Playthrough session(game, game_plugins(), *host);
    ScriptPlayer player(script);
    Flown flown;
    const double longest = script.back().time + 30;  // s
    while (!player.at_end() || (game.phase() == Phase::flying && session.time() < longest)) {
        player.play(session.time(), game);
        session.tick();
        flown.stayed_inside &=
            cell_at(tunnel.tunnel, session.simulation().world().position[tunnel.fighter]).has_value();
    }
    flown.hash = session.simulation().state_hash();
    flown.phase = game.phase();
    flown.explosions = game.explosions();
    return flown;
}

Outcome play(const Shell& shell, const std::string& arguments) { return shell.run("kolize-tunnel " + arguments); }

}  // namespace

TEST_CASE("Each tunnel is flown by its script from start to end, to the same bits every time", "[tunnel]") {
    for (const std::string& name : tunnel_names) {
        CAPTURE(name);
        const Flown flown = fly(name, 1);
        CHECK(flown.phase == Phase::done);
        CHECK(flown.stayed_inside);
        CHECK(flown.explosions > 0);
        CHECK(fly(name, 1).hash == flown.hash);
        CHECK(fly(name, 2).hash == flown.hash);
    }
}

TEST_CASE("The first flight's missiles hit the crate in its way", "[tunnel]") {
    const TunnelScene tunnel = project_tunnel("first_flight");
    const std::vector<TimedEvent> script = project_script("first_flight");
    Game game = game_of(tunnel);
    Playthrough session(game, game_plugins(), *game_host());
    ScriptPlayer player(script);
    const World& world = session.simulation().world();
    const auto crate = std::find(world.name.begin(), world.name.end(), "models/crate.obj.6") - world.name.begin();
    bool hit = false;
    while (!player.at_end()) {
        player.play(session.time(), game);
        session.tick();
        for (const Event& event : session.simulation().events())
            hit |= event.kind == EventKind::explosion &&
                   (event.position - world.position[crate]).norm() < world.shape_of(crate).radius + 0.5;
    }
    CHECK(hit);
}

TEST_CASE("A key script gives keys, buttons and the pointer at their times", "[tunnel]") {
    const std::vector<TimedEvent> events = parse_key_script(
        "# a flight\n0 press enter\n\n 0.05 down w # forward\n2 up w\n2.5 down left_button 0.25 1\n3 move 0.5 0\n",
        "k");
    REQUIRE(events.size() == 7);
    CHECK(events[0].event.key == Key::enter);
    CHECK(events[0].event.kind == WindowEventKind::key_down);
    CHECK(events[1].event.key == static_cast<Key>('W'));
    CHECK(events[2].time == Approx(0.1));  // Enter is let go
    CHECK(events[2].event.kind == WindowEventKind::key_up);
    CHECK(events[3].event.kind == WindowEventKind::key_up);
    CHECK(events[4].event.kind == WindowEventKind::pointer);
    CHECK(events[4].event.x == 0.25);
    CHECK(events[4].event.y == 1);
    CHECK(events[5].event.kind == WindowEventKind::button_down);
    CHECK(events[5].event.button == 0);
    CHECK(events[6].event.kind == WindowEventKind::pointer);
    CHECK(events[6].time == 3);
}

TEST_CASE("A key script that cannot be read is refused where it goes wrong", "[tunnel]") {
    const std::vector<std::pair<std::string, std::string>> table = {
        {"x down w", "k:1:1: the time in s, from 0 to 1e6, must be a number, is 'x'"},
        {"-1 down w", "k:1:1: the time in s, from 0 to 1e6, must be a number, is '-1'"},
        {"nan down w", "k:1:1: the time in s, from 0 to 1e6, must be a number, is 'nan'"},
        {"\n1", "k:2:1: after the time comes down, up, press or move"},
        {"1 hold w", "k:1:3: after the time comes down, up, press or move, not 'hold'"},
        {"1 down", "k:1:3: down takes a key, and may have X and Y after it"},
        {"1 down w 0.5", "k:1:10: down takes a key, and may have X and Y after it"},
        {"1 move 0.5", "k:1:8: move takes X and Y"},
        {"1 move 0.5 2", "k:1:12: Y, from 0 to 1, must be a number, is '2'"},
        {"1 press lft", "k:1:9: there is no key 'lft'; did you mean 'left'?"},
        {"1 press ?", "k:1:9: there is no key '?'"},
        {"2 press w\n1 press w", "k:2:1: the times of a key script never decrease; a line above is of 2.0 s"}};
    for (const auto& [script, complaint] : table) {
        CAPTURE(script);
        CHECK(complaint_of([&] { parse_key_script(script, "k"); }) == complaint);
    }
    CHECK(complaint_of([] { read_key_script("no.keys"); }) == "no.keys: there is no such key script");
}

TEST_CASE("The program flies a tunnel by a script and says how it went", "[tunnel]") {
    const Shell shell;
    const std::string tunnel = "'" + (tunnel_folder / "tunnels" / "first_flight.txt").string() + "'";
    const std::string keys = " --keys '" + (tunnel_folder / "scripts" / "first_flight.keys").string() + "'";
    const Outcome flown = play(shell, tunnel + keys + " --json result.json");
    CHECK(flown.code == 0);
    CHECK(flown.err.empty());
    CHECK(flown.out.starts_with("flight 1 of 1, "));
    CHECK(std::count(flown.out.begin(), flown.out.end(), '\n') == 1);
    const auto json = nlohmann::json::parse(file_bytes(shell.folder.path() / "result.json"));
    CHECK(json["score"] == 1);
    CHECK(json["phase"] == "done");
    CHECK(json["fighter"]["cell"] == json["fighter"]["cells"]);
    CHECK(json["flights"][0]["explosions"] > 0);
    const Outcome quiet = play(shell, tunnel + keys + " --json -");
    CHECK(nlohmann::json::parse(quiet.out)["state_hash"] == json["state_hash"]);
}

TEST_CASE("The program refuses what it cannot use in one sentence", "[tunnel]") {
    const Shell shell;
    shell.folder.write("t.txt", "S (0 0 0)(0 1 0) 1.0 END");
    shell.folder.write("k.keys", "1 press ente\n");
    const std::vector<std::pair<std::string, std::string>> table = {
        {"t.txt --keys k.keys", "k.keys:1:9: there is no key 'ente'; did you mean 'enter'?"},
        {"t.txt --keys t.txt", "t.txt:1:1: the time in s, from 0 to 1e6, must be a number, is 'S'"},
        {"no.txt --keys /dev/null", "/dev/null: there is no such key script"},
        {"--frames f", "--frames and --video take a key script; give one with --keys"}};
    for (const auto& [arguments, complaint] : table) {
        const Outcome outcome = play(shell, arguments);
        CAPTURE(arguments);
        CHECK(outcome.code == 2);
        CHECK(outcome.out.empty());
        CHECK(outcome.err == "kolize-tunnel: " + complaint + "\n");
    }
    shell.folder.write("good.keys", "");
    CHECK(play(shell, "t.txt --keys good.keys").err ==
          "kolize-tunnel: t.txt:1:25: the dynamics of this cell have no END before the end of the file\n");
}

TEST_CASE("A recorded flight is played by kolize run to the same bits, with another broadphase too",
          "[tunnel][record]") {
    const Shell shell;
    const std::string files = "'" + (tunnel_folder / "tunnels" / "first_flight.txt").string() + "' --keys '" +
                              (tunnel_folder / "scripts" / "first_flight.keys").string() + "'";
    REQUIRE(play(shell, files + " --record flight.rec").code == 0);
    CHECK(shell.kolize("run --replay flight.rec").out.find("replay: the same bits in all") != std::string::npos);
    const Outcome other = shell.kolize("run --replay flight.rec --set broadphase.plugin=brute_force");
    CHECK(other.code == 0);
    CHECK(other.out.find("replay: the same bits in all") != std::string::npos);
    const Outcome coarse = shell.kolize("run --replay flight.rec --set step.integrator=semi_implicit_euler");
    CHECK(coarse.code == 0);
    CHECK(coarse.out.find("replay: the two part at step") != std::string::npos);
}
