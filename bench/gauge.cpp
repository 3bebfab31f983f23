#include "gauge.h"

#include <algorithm>

namespace bench {
namespace {

using kolize::Pair;
using kolize::Room;
using kolize::Vec3;

bool is_inside(const Room& room, const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!room.open[2 * axis] && !(p[axis] >= room.min[axis])) return false;
        if (!room.open[2 * axis + 1] && !(p[axis] <= room.max[axis])) return false;
    }
    return true;
}

// Keeps NaN, which std::max would lose.
void raise(double& worst, double value) {
    if (!(value <= worst)) worst = value;
}

}  // namespace

Gauge::Gauge(const kolize::World& start, const std::vector<Room>& rooms) : world_(start), rooms_(rooms) {
    for (std::uint32_t body = 0; body < world_.size(); ++body)
        if (!world_.is_static[body]) dynamic_.push_back(body);
    initial_ = totals();
    for (const std::uint32_t body : dynamic_) energy_scale_ += world_.kinetic_energy(body);
    energy_scale_ += fall_energy();
    has_escaped_.assign(world_.size(), false);
}

double Gauge::fall_energy() const {
    double energy = 0;
    for (const std::uint32_t body : dynamic_) {
        double fall = 0;
        for (std::uint32_t floor = 0; floor < world_.size(); ++floor)
            if (world_.is_static[floor])
                fall = std::max(fall, world_.forces.gravity.dot(world_.position[floor] - world_.position[body]));
        energy += fall / world_.inverse_mass[body];
    }
    return energy;
}

Gauge::Totals Gauge::totals() const {
    Totals sum;
    for (const std::uint32_t body : dynamic_) {
        const double height_energy = -world_.forces.gravity.dot(world_.position[body]) / world_.inverse_mass[body];
        sum.energy += world_.kinetic_energy(body) + height_energy;
        sum.spin += world_.angular_momentum(body);
    }
    return sum;
}

void Gauge::look(const Engine& engine, double dt) {
    for (const std::uint32_t body : dynamic_) {
        const kolize::BodyState state = engine.state(body);
        path_ += (state.position - world_.position[body]).norm();
        expected_path_ += state.velocity.norm() * dt;
        world_.set_state(body, state);
    }
    const Totals now = totals();
    reading_.energy_error = (now.energy - initial_.energy) / energy_scale_;
    raise(reading_.worst_energy_error, std::abs(reading_.energy_error));
    raise(reading_.angular_momentum_error, (now.spin - initial_.spin).norm() / initial_.spin.norm());
    count_escapes();
    count_stuck(engine, dt);
}

Reading Gauge::reading() const {
    Reading result = reading_;
    result.path_ratio = path_ / expected_path_;
    return result;
}

void Gauge::count_escapes() {
    for (const std::uint32_t body : dynamic_) {
        const Vec3& p = world_.position[body];
        const auto holds = [&](const Room& room) { return is_inside(room, p); };
        if (has_escaped_[body]) continue;
        if (p.allFinite() && (rooms_.empty() || std::any_of(rooms_.begin(), rooms_.end(), holds))) continue;
        has_escaped_[body] = true;
        ++reading_.escaped;
    }
}

void Gauge::count_stuck(const Engine& engine, double dt) {
    constexpr double limit = 0.5;  // s
    touching_.clear();
    engine.add_touching(touching_);
    std::sort(touching_.begin(), touching_.end());
    touching_.erase(std::unique(touching_.begin(), touching_.end()), touching_.end());
    std::vector<Touch> now;
    auto old = open_.begin();
    for (const Pair& pair : touching_) {
        while (old != open_.end() && old->pair < pair) ++old;
        const double before = old != open_.end() && old->pair == pair ? old->duration : 0;
        now.push_back({pair, before + dt});
        if (before <= limit && before + dt > limit) ++reading_.stuck;
    }
    open_.swap(now);
}

}  // namespace bench
