// kolize-tunnel: the game.
#include "places.h"
#include "play.h"

#include "common.h"

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <iostream>

namespace kolize::tunnel {
namespace {

struct Options {
    std::vector<std::string> tunnels;
    std::string pipeline;
    std::vector<std::string> set;
    std::string keys;
    std::string json;
    int threads = 1;
    std::vector<std::string> plugin_path;
    PlayOptions play;
};

std::vector<TunnelScene> load_tunnels(const Options& options, const PluginLibrary& plugins, Host& host) {
    const Places places = find_places();
    const Scene base = load_scene(
        places.pipeline, {options.pipeline, cli::parse_settings(options.set), cli::plugin_defaults()}, plugins);
    std::vector<std::filesystem::path> files(options.tunnels.begin(), options.tunnels.end());
    std::vector<TunnelScene> tunnels;
    for (const std::filesystem::path& file : files.empty() ? places.tunnels : files) {
        tunnels.push_back(make_tunnel_scene(read_tunnel(file), base, places.fighter));
        require_apart(tunnels.back(), plugins, host);
    }
    return tunnels;
}

void write_result(const Game& game, const Played& played, const std::string& file) {
    cli::Json flights = cli::Json::array();
    for (const FlightReport& flight : game.reports())
        flights.push_back({{"tunnel", flight.file},
                           {"time_s", flight.time},
                           {"missiles", flight.missiles},
                           {"explosions", flight.explosions}});
    const Vec3& p = played.fighter;
    cli::Json fighter = {{"tunnel", game.tunnel().scene.file},
                         {"position_m", {p.x(), p.y(), p.z()}},
                         {"cell", game.cell() + 1},
                         {"cells", game.tunnel().tunnel.cells.size()},
                         {"flight_time_s", game.flight_time()},
                         {"missiles", game.magazine().fired()},
                         {"explosions", game.explosions()}};
    cli::write_json({{"score", game.reports().size()},
                     {"flights", flights},
                     {"phase", to_string(game.phase())},
                     {"fighter", fighter},
                     {"steps", played.ticks},
                     {"time_s", played.time},
                     {"state_hash", cli::hex(played.state_hash)},
                     {"host", cli::host_block()},
                     {"command", cli::command_line()}},
                    file);
}

void run(Options& options) {
    options.play.tells = options.json != "-";
    const PluginLibrary plugins = cli::open_plugins(options.plugin_path, {});
    const std::unique_ptr<Host> host = make_host(options.threads);
    std::vector<TimedEvent> script;
    if (!options.keys.empty()) script = read_key_script(options.keys);
    if (options.keys.empty() && options.play.film.wanted())
        throw Error("--frames and --video take a key script; give one with --keys");
    Game game(load_tunnels(options, plugins, *host));
    const Played played = options.keys.empty() ? play_in_window(game, options.play, plugins, *host)
                                               : play_script(game, script, options.play, plugins, *host);
    if (!options.json.empty()) write_result(game, played, options.json);
}

void add_options(CLI::App& app, Options& options) {
    app.add_option("tunnels", options.tunnels, "Tunnel files, flown one after the other; none: those of the project");
    app.add_option("--pipeline", options.pipeline, "Pipeline file: replaces the tables of the default one");
    cli::add_set_option(app, options.set);
    app.add_option("--keys", options.keys, "Key script that plays the game, without a window");
    app.add_option("--time", options.play.time, "The game ends after so much simulated time, s")
        ->check(CLI::PositiveNumber);
    cli::add_film_options(app, options.play.film);
    app.add_option("--record", options.play.record,
                   "Keep the flight in this file, to be played again by kolize run --replay");
    cli::add_json_option(app, options.json);
    cli::add_threads_option(app, options.threads);
    cli::add_plugin_path_option(app, options.plugin_path);
    app.footer(
        "Example: kolize-tunnel --keys demos/tunnel/scripts/first_flight.keys --video flight.mp4\n"
        "F1 in the game shows the keys. Exit codes: 0 fine, 1 a run failed, 2 bad input or usage.");
}

int complain(const std::string& sentence, int code) {
    std::cerr << "kolize-tunnel: " << sentence << '\n';
    return code;
}

}  // namespace
}  // namespace kolize::tunnel

int main(int argc, char** argv) {
    using namespace kolize;
    enum ExitCode { fine = 0, failed = 1, bad_input = 2 };
    spdlog::set_default_logger(spdlog::stderr_color_st("kolize-tunnel"));
    spdlog::set_pattern("%^%l%$: %v");
    CLI::App app("A fighter is flown through tunnels of cubes; collisions by kolize.", "kolize-tunnel");
    tunnel::Options options;
    tunnel::add_options(app, options);
    try {
        app.parse(argc, argv);
        tunnel::run(options);
        return fine;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // --help
        return tunnel::complain(std::string(error.what()) + " (see kolize-tunnel --help)", bad_input);
    } catch (const Error& error) {
        return tunnel::complain(error.what(), bad_input);
    } catch (const std::exception& error) {
        return tunnel::complain(error.what(), failed);
    }
}
