#include "game.h"

#include <algorithm>
#include <cmath>

namespace kolize::tunnel {
namespace {

constexpr double gravity = 9.81;       // m/s^2, downward along y
constexpr double drag_rate = 0.4;      // 1/s a second, while the key is held
constexpr double most_drag = 2;        // 1/s
constexpr double pointer_rest = 0.06;  // around the middle of the window nothing is asked for
constexpr double pointer_turn = 1.2;   // rad/s, with the pointer at the border

Key letter(char key) { return static_cast<Key>(key); }

double beyond_rest(double pointer) {
    const double size = std::max(0.0, std::abs(pointer) - pointer_rest) / (1 - pointer_rest);
    return std::copysign(std::min(1.0, size), pointer);
}

bool same(const Forces& a, const Forces& b) { return a.gravity == b.gravity && a.wind == b.wind && a.drag == b.drag; }

bool same(const LoadInput& a, const LoadInput& b) { return a.force == b.force && a.torque == b.torque; }

}  // namespace

const char* to_string(Phase phase) {
    static constexpr const char* names[] = {"ready", "flying", "arrived", "done", "ended"};
    return names[static_cast<int>(phase)];
}

Game::Game(std::vector<TunnelScene> tunnels)
    : tunnels_(std::move(tunnels)), dt_(tunnels_.at(0).scene.pipeline.step.dt) {
    begin_flight();
}

void Game::begin_flight() {
    cell_ = 0;
    steps_ = flight_steps_ = explosions_ = 0;
    forces_ = forces_put_ = tunnel().scene.world.forces;
    load_put_.reset();
    magazine_ = Magazine(tunnel().missiles);
    camera_.start(subject(tunnel().scene.world, tunnel().fighter));
}

// --- What the player does ------------------------------------------------------------------------------------------

void Game::take(const WindowEvent& event) {
    switch (event.kind) {
    case WindowEventKind::key_down:
        held_.insert(event.key);
        press(event.key);
        break;
    case WindowEventKind::key_up: held_.erase(event.key); break;
    case WindowEventKind::button_down:
        trigger_ |= event.button == 0;
        fires_ |= event.button == 0;
        break;
    case WindowEventKind::button_up: trigger_ &= event.button != 0; break;
    case WindowEventKind::pointer:
        pointer_ = {std::clamp(2 * event.x / width_ - 1, -1.0, 1.0), std::clamp(1 - 2 * event.y / height_, -1.0, 1.0),
                    0};
        break;
    case WindowEventKind::resized:
        width_ = std::max(event.x, 1.0);
        height_ = std::max(event.y, 1.0);
        break;
    case WindowEventKind::closed: phase_ = Phase::ended; break;
    case WindowEventKind::scroll: break;
    }
}

void Game::press(Key key) {
    if (key == Key::escape) phase_ = Phase::ended;
    if (key == Key::enter) press_enter();
    if (key == letter('F')) fires_ = true;
    if (key == Key::f1 || key == letter('H')) help_ = !help_;
    if (key == letter('1')) control_ = Control::relative;
    if (key == letter('2')) control_ = Control::autopilot;
    if (key == letter('M')) mouse_ = !mouse_;
    if (key == letter('V')) next_view_ = true;
    if (key == Key::tab) camera_.change_aim();
    if (held_.contains(letter('G')) && key == Key::down && forces_.gravity.isZero(0)) {
        const Vec3& usual = tunnel().scene.world.forces.gravity;
        forces_.gravity = usual.isZero(0) ? Vec3(0, -gravity, 0) : usual;
    }
    if (held_.contains(letter('G')) && key == Key::up) forces_.gravity.setZero();
}

void Game::press_enter() {
    if (phase_ == Phase::ready) phase_ = Phase::flying;
    if (phase_ != Phase::arrived) return;
    ++number_;
    phase_ = Phase::flying;
    begin_flight();
}

Demand Game::demand() const {
    Demand demand = demand_of(held_);
    if (!mouse_) return demand;
    const double aside = beyond_rest(pointer_.x()), up = beyond_rest(pointer_.y());
    const bool rolls = held_.contains(Key::control);
    const Vec3 turn(rolls ? aside : 0, rolls ? 0 : -aside, up);
    if (control_ == Control::autopilot)
        demand.turn_rate = pointer_turn * turn;
    else
        demand.turn = (demand.turn + turn).cwiseMax(-1).cwiseMin(1);
    return demand;
}

// --- What becomes of it --------------------------------------------------------------------------------------------

void Game::put_forces(std::vector<Input>& inputs) {
    const double change = (held_.contains(letter('T')) ? 1 : 0) - (held_.contains(letter('R')) ? 1 : 0);
    forces_.drag = std::clamp(forces_.drag + change * drag_rate * dt_, 0.0, std::max(most_drag, forces_put_.drag));
    if (same(forces_, forces_put_)) return;
    forces_put_ = forces_;
    inputs.push_back(ForcesInput{forces_});
}

void Game::decide(const World& world, std::vector<Input>& inputs) {
    put_forces(inputs);
    const bool has_pilot = phase_ == Phase::flying && camera_.view() != View::free;
    Demand asked = has_pilot ? demand() : Demand{};
    asked.full_stop |= phase_ != Phase::flying;
    const std::uint32_t fighter = tunnel().fighter;
    const Motion motion{axes_of(world, fighter), world.velocity[fighter], world.angular_velocity[fighter]};
    const Load load = engine_load(tunnel().engines, asked, control_, motion);
    const LoadInput input{fighter, load.force, load.torque};
    if (!load_put_ || !same(*load_put_, input)) inputs.push_back(input);
    load_put_ = input;
    const bool fires = phase_ == Phase::flying && (fires_ || trigger_ || held_.contains(letter('F')));
    fires_ = false;
    magazine_.decide(tunnel(), world, fires, dt_ * static_cast<double>(steps_), inputs);
}

void Game::observe(const Simulation& simulation) {
    const World& world = simulation.world();
    magazine_.observe(world);
    const Subject fighter = subject(world, tunnel().fighter);
    const std::optional<Subject> followed = missile(world);
    if (next_view_) camera_.next_view(fighter, followed ? &*followed : nullptr);
    next_view_ = false;
    const double zoom = (held_.contains(letter('C')) ? 1 : 0) - (held_.contains(letter('X')) ? 1 : 0);
    camera_.follow(fighter, followed ? &*followed : nullptr, demand_of(held_), zoom, dt_);
    if (!runs()) return;
    ++steps_;
    for (const Event& event : simulation.events()) explosions_ += event.kind == EventKind::explosion;
    if (const std::optional<std::size_t> now = cell_at(tunnel().tunnel, fighter.position)) cell_ = *now;
    if (phase_ != Phase::flying) return;
    flight_steps_ = steps_;
    if (cell_ + 1 < tunnel().tunnel.cells.size()) return;
    reports_.push_back({tunnel().scene.file, flight_time(), magazine_.fired(), explosions_});
    phase_ = number_ + 1 < tunnels_.size() ? Phase::arrived : Phase::done;
}

Subject Game::subject(const World& world, std::uint32_t body) const {
    return {axes_of(world, body), world.position[body]};
}

std::optional<Subject> Game::missile(const World& world) const {
    const std::optional<std::uint32_t> body = magazine_.latest();
    return body ? std::optional(subject(world, *body)) : std::nullopt;
}

Camera Game::camera(const World& world) const {
    const std::optional<Subject> followed = missile(world);
    return camera_.camera(subject(world, tunnel().fighter), followed ? &*followed : nullptr);
}

}  // namespace kolize::tunnel
