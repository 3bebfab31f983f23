#include "session.h"

namespace kolize::tunnel {

void put_in(Simulation& simulation, const Input& input) { simulation.apply(input); }

Session::Session(Game& game, const PluginLibrary& plugins, Host& host) : game_(game), plugins_(plugins), host_(host) {
    start();
}

void Session::start() {
    constexpr std::uint64_t expected_steps = 1u << 14;
    number_ = game_.tunnel_number();
    simulation_.reset();
    simulation_ = std::make_unique<Simulation>(game_.tunnel().scene, plugins_, host_, expected_steps);
}

void Session::tick() {
    if (game_.tunnel_number() != number_) start();
    if (game_.runs()) {
        inputs_.clear();
        game_.decide(simulation_->world(), inputs_);
        for (const Input& input : inputs_) put_in(*simulation_, input);
        simulation_->step();
    }
    game_.observe(*simulation_);
    ++ticks_;
}

double Session::time() const { return static_cast<double>(ticks_) * game_.tunnel().scene.pipeline.step.dt; }

ScriptPlayer::ScriptPlayer(const std::vector<TimedEvent>& events) : events_(events) {}

void ScriptPlayer::play(double time, Game& game) {
    constexpr double rounding = 1e-9;  // s
    for (; next_ < events_.size() && events_[next_].time <= time + rounding; ++next_) game.take(events_[next_].event);
}

}  // namespace kolize::tunnel
