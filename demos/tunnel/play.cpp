#include "play.h"

#include "hud.h"

#include "film/view.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace kolize::tunnel {
namespace {

Played played(const Game& game, const Playthrough& session) {
    const Simulation& simulation = session.simulation();
    return {session.ticks(), session.time(), simulation.state_hash(),
            simulation.world().position[game.tunnel().fighter]};
}

void tell(const Game& game, std::size_t& told) {
    for (; told < game.reports().size(); ++told) {
        const FlightReport& flight = game.reports()[told];
        std::printf("flight %zu of %zu, %s: finished in %.3f s, %llu missiles, %llu explosions\n", told + 1,
                    game.tunnels(), flight.file.c_str(), flight.time, static_cast<unsigned long long>(flight.missiles),
                    static_cast<unsigned long long>(flight.explosions));
        std::fflush(stdout);
    }
}

// The simulated time at which a scripted game is over.
class Closing {
public:
    Closing(const std::vector<TimedEvent>& script, const PlayOptions& options)
        : latest_(options.time.value_or((script.empty() ? 0 : script.back().time) + after_script)),
          waits_(!options.time) {}

    bool is_over(const Game& game, double time) {
        constexpr double rounding = 1e-9;
        if (waits_ && game.phase() == Phase::done) {
            latest_ = std::min(latest_, time + after_flight);
            waits_ = false;
        }
        return game.phase() == Phase::ended || time >= latest_ - rounding;
    }

private:
    static constexpr double after_script = 30, after_flight = 3;  // s

    double latest_;
    bool waits_;
};

}  // namespace

Played play_script(Game& game, const std::vector<TimedEvent>& script, const PlayOptions& options,
                   const PluginLibrary& plugins, Host& host) {
    constexpr std::uint64_t no_last_step = 1ull << 40;
    Playthrough session(game, plugins, host, options.record);
    ScriptPlayer player(script);
    Closing closing(script, options);
    std::optional<cli::Film> film;
    const auto director = [&game](const Simulation& simulation, double, cli::Shot& shot) {
        direct(game, simulation.world(), shot);
    };
    if (options.film.wanted())
        film.emplace(options.film, game.tunnel().scene, session.simulation(), plugins, host, no_last_step, director);
    if (film) film->look(session.simulation());
    std::size_t told = 0, filmed = session.tunnel_number();
    while (!closing.is_over(game, session.time())) {
        player.play(session.time(), game);
        session.tick();
        if (film && filmed != session.tunnel_number()) film->cut(game.tunnel().scene, session.simulation());
        filmed = session.tunnel_number();
        if (film) film->look(session.simulation());
        if (options.tells) tell(game, told);
    }
    if (film) film->finish();
    session.write_recording();
    return played(game, session);
}

namespace {

// Pictures of a game in a window.
class Screen {
public:
    Screen(const Game& game, const Playthrough& session, const PluginLibrary& plugins, Host& host)
        : renderer_(plugins.make<Renderer>(game.tunnel().scene.render.stage, host)), window_(open(game)) {
        cut(game, session);
    }

    Window& window() { return window_; }
    // Another tunnel from here on.
    void cut(const Game& game, const Playthrough& session) {
        number_ = session.tunnel_number();
        explosions_.clear();
        cli::prepare(*renderer_, game.tunnel().scene, session.simulation().world());
    }
    // After each tick.
    void look(const Game& game, const Playthrough& session) {
        if (session.tunnel_number() != number_) cut(game, session);
        if (!game.runs()) return;
        cli::take_explosions(session.simulation(), session.time(), explosions_);
    }
    void show(const Game& game, const Playthrough& session) {
        const World& world = session.simulation().world();
        direct(game, world, shot_);
        renderer_->draw({world, session.time(), shot_.camera, shot_.lights, explosions_, shot_.lines, shot_.captions});
        window_.present(nullptr);
    }

private:
    Window& open(const Game& game) const {
        try {
            return renderer_->open_window("Tunnel transit", 1280, 720);
        } catch (const std::exception& failure) {
            throw Error("renderer '" + game.tunnel().scene.render.stage.plugin + "': " + failure.what() +
                        "; without a window the game is played by --keys");
        }
    }

    StagePtr<Renderer> renderer_;
    Window& window_;
    cli::Shot shot_;
    std::vector<Explosion> explosions_;
    std::size_t number_ = 0;
};

WindowEvent size_of(const Window& window) {
    WindowEvent event;
    event.kind = WindowEventKind::resized;
    event.x = window.width();
    event.y = window.height();
    return event;
}

void play(Game& game, Playthrough& session, Screen& screen, const PlayOptions& options) {
    using Clock = std::chrono::steady_clock;
    constexpr int most_ticks = 8;  // a picture: what takes longer than it lasts is shown in slow motion
    const double dt = game.tunnel().scene.pipeline.step.dt;
    std::vector<WindowEvent> events;
    std::size_t told = 0;
    double owed = 0;  // s of simulated time
    game.take(size_of(screen.window()));
    for (Clock::time_point last = Clock::now(); game.phase() != Phase::ended;) {
        events.clear();
        screen.window().poll(events);
        for (const WindowEvent& event : events) game.take(event);
        const Clock::time_point now = Clock::now();
        owed = std::min(owed + std::chrono::duration<double>(now - last).count(), most_ticks * dt);
        last = now;
        for (; owed >= dt && game.phase() != Phase::ended; owed -= dt) {
            session.tick();
            screen.look(game, session);
        }
        if (options.tells) tell(game, told);
        screen.show(game, session);
        if (options.time && session.time() >= *options.time) break;
    }
}

}  // namespace

Played play_in_window(Game& game, const PlayOptions& options, const PluginLibrary& plugins, Host& host) {
    Playthrough session(game, plugins, host, options.record);
    Screen screen(game, session, plugins, host);
    play(game, session, screen, options);
    session.write_recording();
    return played(game, session);
}

}  // namespace kolize::tunnel
