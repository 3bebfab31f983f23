// A game with the simulation of its present tunnel: one step after the other.
#pragma once

#include "game.h"
#include "key_script.h"

#include "session.h"

#include <filesystem>
#include <memory>

namespace kolize::tunnel {

class Playthrough {
public:
    // All of these have to outlive it. Each tunnel is recorded into a file of its own, unless `record` is empty: of
    // flights.rec the second one into flights.2.rec. Throws what Simulation's constructor throws.
    Playthrough(Game& game, const PluginLibrary& plugins, Host& host, std::filesystem::path record = {});

    // Brings game and simulation one step further, into the next tunnel if the player went on to it.
    void tick();
    // The recording of the present tunnel; those before were written when the next one began. Throws Error.
    void write_recording() const;

    const Simulation& simulation() const { return session_->simulation(); }
    std::size_t tunnel_number() const { return number_; }  // of the simulation
    std::uint64_t ticks() const { return ticks_; }
    double time() const;  // simulated, of all ticks, s

private:
    void start();

    Game& game_;
    const PluginLibrary& plugins_;
    Host& host_;
    std::filesystem::path record_;
    std::unique_ptr<cli::Session> session_;  // of the present tunnel
    std::size_t number_ = 0;
    std::uint64_t ticks_ = 0;
    std::vector<Input> inputs_;
};

// Hands a script to a game.
class ScriptPlayer {
public:
    // `events` in the order of their times; they have to outlive the player.
    explicit ScriptPlayer(const std::vector<TimedEvent>& events);

    // All that is due by now; to be called before each tick.
    void play(double time, Game& game);
    bool at_end() const { return next_ == events_.size(); }

private:
    const std::vector<TimedEvent>& events_;
    std::size_t next_ = 0;
};

}  // namespace kolize::tunnel
