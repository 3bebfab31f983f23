// A game with the simulation of its present tunnel: one step after the other.
#pragma once

#include "game.h"
#include "key_script.h"

#include <memory>

namespace kolize::tunnel {

// Everything that the game puts into a simulation goes through here.
void put_in(Simulation& simulation, const Input& input);

class Session {
public:
    // All of these have to outlive the session. Throws what Simulation's constructor throws.
    Session(Game& game, const PluginLibrary& plugins, Host& host);

    // Brings game and simulation one step further, into the next tunnel if the player went on to it.
    void tick();

    const Simulation& simulation() const { return *simulation_; }
    std::size_t tunnel_number() const { return number_; }  // of the simulation
    std::uint64_t ticks() const { return ticks_; }
    double time() const;  // simulated, of all ticks, s

private:
    void start();

    Game& game_;
    const PluginLibrary& plugins_;
    Host& host_;
    std::unique_ptr<Simulation> simulation_;
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
