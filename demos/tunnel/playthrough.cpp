#include "playthrough.h"

namespace kolize::tunnel {

Playthrough::Playthrough(Game& game, const PluginLibrary& plugins, Host& host, std::filesystem::path record)
    : game_(game), plugins_(plugins), host_(host), record_(std::move(record)) {
    start();
}

void Playthrough::start() {
    constexpr std::uint64_t expected_steps = 1u << 14;
    if (session_) write_recording();
    number_ = game_.tunnel_number();
    session_.reset();
    session_ = std::make_unique<cli::Session>(cli::Subject{game_.tunnel().scene, {}}, plugins_, host_, expected_steps);
    if (!record_.empty()) session_->record();
}

void Playthrough::write_recording() const {
    if (record_.empty()) return;
    std::filesystem::path file = record_;
    if (number_ > 0)
        file.replace_filename(file.stem().string() + "." + std::to_string(number_ + 1) + file.extension().string());
    session_->write_recording(file);
}

void Playthrough::tick() {
    if (game_.tunnel_number() != number_) start();
    if (game_.runs()) {
        inputs_.clear();
        game_.decide(simulation().world(), inputs_);
        for (const Input& input : inputs_) session_->put_in(input);
        session_->step();
    }
    game_.observe(simulation());
    ++ticks_;
}

double Playthrough::time() const { return static_cast<double>(ticks_) * game_.tunnel().scene.pipeline.step.dt; }

ScriptPlayer::ScriptPlayer(const std::vector<TimedEvent>& events) : events_(events) {}

void ScriptPlayer::play(double time, Game& game) {
    constexpr double rounding = 1e-9;  // s
    for (; next_ < events_.size() && events_[next_].time <= time + rounding; ++next_) game.take(events_[next_].event);
}

}  // namespace kolize::tunnel
