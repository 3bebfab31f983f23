// Tunnels and games for tests: made of the project's files, or of a few lines of text.
#pragma once

#include "framework/mesh_files.h"

#include "tunnel/places.h"
#include "tunnel/play.h"
#include "tunnel/tunnel_path.h"

#include "common.h"

namespace kolize::test {

using namespace kolize::tunnel;

inline const PluginLibrary& game_plugins() {
    static const PluginLibrary plugins({KOLIZE_PLUGIN_DIR});
    return plugins;
}

inline const std::unique_ptr<Host>& game_host() {
    static const std::unique_ptr<Host> host = make_host(1);
    return host;
}

// The message of a failure without the folder it speaks of; "" if there is none.
template <class Function>
std::string complaint_of(Function&& function) {
    try {
        function();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

inline Scene game_base(const cli::Settings& set = {}, const std::string& pipeline = "") {
    const Places places = find_places();
    const std::filesystem::path file =
        pipeline.empty() ? std::filesystem::path() : places.pipeline.parent_path() / (pipeline + ".toml");
    return load_scene(places.pipeline, {file, set, cli::plugin_defaults()}, game_plugins());
}

inline const std::filesystem::path tunnel_folder = std::filesystem::path(KOLIZE_SOURCE_DIR) / "demos" / "tunnel";
inline const std::vector<std::string> tunnel_names = {"first_flight", "winding_way", "the_deep"};

inline TunnelScene project_tunnel(const std::string& name, const Scene& base = game_base()) {
    return make_tunnel_scene(read_tunnel(tunnel_folder / "tunnels" / (name + ".txt")), base, find_places().fighter);
}

// Files of bodies are those of the project.
inline TunnelScene tunnel_of(const std::string& text, const Scene& base = game_base()) {
    return make_tunnel_scene(parse_tunnel(text, tunnel_folder / "tunnels" / "test.txt"), base, find_places().fighter);
}

inline Game game_of(const TunnelScene& tunnel) { return Game(std::vector<TunnelScene>{tunnel}); }

inline const std::string short_tunnel =
    "S (0 0 0)(0 1 0) 1.0 END END  I (0 0 -1)(0 0 1) 0 END END  S (0 0 -2)(0 0 1) 0 END END";

// A game that is played by key names, step by step.
class Player {
public:
    explicit Player(std::vector<TunnelScene> tunnels)
        : game(std::move(tunnels)), session(game, game_plugins(), *game_host()) {}
    explicit Player(const TunnelScene& tunnel) : Player(std::vector<TunnelScene>{tunnel}) {}

    void down(Key key) { send(WindowEventKind::key_down, key); }
    void up(Key key) { send(WindowEventKind::key_up, key); }
    void down(char key) { down(static_cast<Key>(key)); }
    void up(char key) { up(static_cast<Key>(key)); }
    template <class K>
    void press(K key) {
        down(key);
        up(key);
    }
    void wait(double seconds) {
        const auto ticks = static_cast<int>(std::lround(seconds / dt()));
        for (int i = 0; i < ticks; ++i) session.tick();
    }
    double dt() const { return game.tunnel().scene.pipeline.step.dt; }
    const World& world() const { return session.simulation().world(); }
    std::uint32_t fighter() const { return game.tunnel().fighter; }
    const Vec3& position() const { return world().position[fighter()]; }
    const Vec3& velocity() const { return world().velocity[fighter()]; }

    Game game;
    Playthrough session;

private:
    void send(WindowEventKind kind, Key key) {
        WindowEvent event;
        event.kind = kind;
        event.key = key;
        game.take(event);
    }
};

}  // namespace kolize::test
