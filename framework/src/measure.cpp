#include "measure.h"

#include "room.h"

#include <algorithm>

namespace kolize {

void StageClock::reserve(std::uint64_t steps) {
    for (auto& samples : samples_us_) samples.reserve(steps);
}

void StageClock::end_step() {
    for (std::size_t i = 0; i < phases; ++i) {
        samples_us_[i].push_back(std::chrono::duration<float, std::micro>(open_[i]).count());
        open_[i] = {};
    }
}

StageTime StageClock::summary(Phase phase) const {
    std::vector<float> sorted = samples_us_[static_cast<std::size_t>(phase)];
    if (sorted.empty()) return {};
    std::sort(sorted.begin(), sorted.end());
    StageTime time;
    time.median_us = sorted[sorted.size() / 2];
    time.p95_us = sorted[std::min(sorted.size() - 1, sorted.size() * 95 / 100)];
    for (const float sample : sorted) time.total_s += sample * 1e-6;
    return time;
}

double StageClock::latest_us(Phase phase) const {
    const std::vector<float>& samples = samples_us_[static_cast<std::size_t>(phase)];
    return samples.empty() ? 0 : samples.back();
}

namespace {

bool is_live(const World& world, std::uint32_t body) { return !world.is_static[body] && !world.removed[body]; }

template <class Visit>
void for_live(const World& world, Visit&& visit) {
    for (std::uint32_t body = 0; body < world.size(); ++body)
        if (is_live(world, body)) visit(body);
}

}  // namespace

void Measure::start(const World& world, const std::vector<Room>& rooms, std::uint64_t expected_steps) {
    rooms_ = rooms;
    clock.reserve(expected_steps);
    double mass = 0;
    for_live(world, [&](std::uint32_t body) {
        mass += 1 / world.inverse_mass[body];
        reference_ += world.position[body] / world.inverse_mass[body];
        watch(world, body);
    });
    if (mass > 0) reference_ /= mass;
    initial_ = latest_ = totals(world);
    has_escaped_.assign(world.size(), 0);
    touching_.reserve(4 * world.size());
    open_.reserve(4 * world.size());
    next_.reserve(4 * world.size());
    set_scales(world);
}

void Measure::watch(const World& world, std::uint32_t body) {
    has_forces_ = has_forces_ || !force_on(world, body).isZero(0);
    has_losses_ = has_losses_ || world.forces.drag > 0 || !world.constant_torque[body].isZero(0);
}

// Forces may have come that were not there before: potential energy is counted on both sides of the change, or on none.
void Measure::account_for(const World& world, const Totals& before) {
    for_live(world, [&](std::uint32_t body) { watch(world, body); });
    latest_ = totals(world);
    exchange_.work += latest_.energy() - before.energy();
    exchange_.impulse += latest_.momentum - before.momentum;
    exchange_.angular_impulse += latest_.angular_momentum - before.angular_momentum;
}

Vec3 Measure::force_on(const World& world, std::uint32_t body) const {
    return world.forces.gravity / world.inverse_mass[body] + world.constant_force[body];
}

void Measure::add_body(const World& world, std::uint32_t body, const BodyState& state, Totals& sum) const {
    const Vec3 momentum = state.velocity / world.inverse_mass[body];
    const Vec3 arm = state.position - reference_;
    sum.kinetic += world.kinetic_energy(body, state);
    if (has_forces_) sum.potential -= force_on(world, body).dot(arm);
    sum.momentum += momentum;
    sum.angular_momentum += arm.cross(momentum) + world.angular_momentum(body, state);
}

Totals Measure::totals(const World& world) const {
    Totals sum;
    for_live(world, [&](std::uint32_t body) { add_body(world, body, world.state(body), sum); });
    return sum;
}

// Scales of the scene, so that drifts are pure numbers: energy against the kinetic energy at the start and the work the
// forces can do over the height of the scene; momenta against their sums over the bodies.
void Measure::set_scales(const World& world) {
    Aabb extent;
    for (const Room& room : rooms_) {
        extent.include(room.min);
        extent.include(room.max);
    }
    for_live(world, [&](std::uint32_t body) {
        const Aabb box = world_bounds(world, body);
        extent.include(box.min);
        extent.include(box.max);
    });
    double mass = 0, work = 0;
    for_live(world, [&](std::uint32_t body) {
        const double m = 1 / world.inverse_mass[body];
        const Vec3 arm = world.position[body] - reference_;
        mass += m;
        work += force_on(world, body).cwiseAbs().dot(extent.max - extent.min);
        momentum_scale_ += m * world.velocity[body].norm();
        angular_scale_ += m * arm.norm() * world.velocity[body].norm() + world.angular_momentum(body).norm();
    });
    energy_scale_ = initial_.kinetic + work;
    const double speed_scale = std::sqrt(2 * energy_scale_ * mass);  // N s
    if (momentum_scale_ == 0) momentum_scale_ = speed_scale;
    if (angular_scale_ == 0) angular_scale_ = speed_scale * (extent.max - extent.min).norm();
}

void Measure::moved(const World& world, std::uint32_t body, const BodyState& before, const BodyState& after,
                    double time) {
    if (has_losses_) {
        Totals start, end;
        add_body(world, body, before, start);
        add_body(world, body, after, end);
        exchange_.work += end.energy() - start.energy();
        exchange_.impulse += end.momentum - start.momentum;
        exchange_.angular_impulse += end.angular_momentum - start.angular_momentum;
    } else if (has_forces_) {
        const Vec3 impulse = force_on(world, body) * time;
        // Along a parabola the mean of both ends is off by a multiple of the force: no moment about itself.
        const Vec3 arm = 0.5 * (before.position + after.position) - reference_;
        exchange_.impulse += impulse;
        exchange_.angular_impulse += arm.cross(impulse);
    }
}

void Measure::after_response(const World& world, const std::vector<Contact>& rows, double dissipated_J, bool rests) {
    exchange_.work -= dissipated_J;
    for (const Contact& c : rows) {
        max_depth_ = std::max(max_depth_, c.depth);
        const bool overlaps =
            !rests && (c.depth > 0 || c.normal.isZero(0));  // no more than that may have been asked for
        if (overlaps && (touching_.empty() || touching_.back() != Pair{c.a, c.b})) touching_.push_back({c.a, c.b});
        if (world.is_static[c.a] == world.is_static[c.b]) continue;
        const bool on_a = world.is_static[c.b];
        const std::uint32_t body = on_a ? c.a : c.b;
        const double sign = on_a ? -1 : 1;
        const Vec3 impulse = sign * c.total_impulse();
        exchange_.impulse += impulse;
        exchange_.angular_impulse +=
            (world.position[body] - reference_ + (on_a ? c.arm_a : c.arm_b)).cross(impulse) + sign * c.couple;
    }
}

void Measure::before_removal(const World& world, std::uint32_t body) {
    if (!is_live(world, body)) return;
    Totals gone;
    add_body(world, body, world.state(body), gone);
    exchange_.work -= gone.energy();
    exchange_.impulse -= gone.momentum;
    exchange_.angular_impulse -= gone.angular_momentum;
}

void Measure::end_step(const World& world, double dt) {
    ++steps;
    time_ += dt;
    clock.end_step();
    measure_drift(world);
    count_escapes(world);
    count_stuck(dt);
}

namespace {

double relative(double error, double scale) { return scale > 0 ? error / scale : error; }

// Keeps NaN: std::max would lose it.
void raise(double& worst, double value) {
    if (!(value <= worst)) worst = value;
}

}  // namespace

void Measure::measure_drift(const World& world) {
    latest_ = totals(world);
    raise(energy_drift_, relative(std::abs(latest_.energy() - initial_.energy() - exchange_.work), energy_scale_));
    raise(momentum_drift_,
          relative((latest_.momentum - initial_.momentum - exchange_.impulse).norm(), momentum_scale_));
    raise(angular_drift_,
          relative((latest_.angular_momentum - initial_.angular_momentum - exchange_.angular_impulse).norm(),
                   angular_scale_));
}

void Measure::count_escapes(const World& world) {
    for_live(world, [&](std::uint32_t body) {
        if (has_escaped_[body]) return;
        const Vec3& p = world.position[body];
        const bool in_a_room =
            rooms_.empty() || std::any_of(rooms_.begin(), rooms_.end(), [&](const Room& r) { return inside(r, p); });
        if (p.allFinite() && in_a_room) return;
        has_escaped_[body] = 1;
        ++escaped_;
    });
}

// A pair is stuck when it was in contact at every step for more than half a second.
void Measure::count_stuck(double dt) {
    constexpr double limit = 0.5;  // simulated s
    std::sort(touching_.begin(), touching_.end());
    touching_.erase(std::unique(touching_.begin(), touching_.end()), touching_.end());
    next_.clear();
    auto old = open_.begin();
    for (const Pair& pair : touching_) {
        while (old != open_.end() && old->pair < pair) ++old;
        Touch touch = old != open_.end() && old->pair == pair ? *old : Touch{pair, time_ - dt, false};
        if (!touch.counted && time_ - touch.since > limit) {
            touch.counted = true;
            ++stuck_;
        }
        next_.push_back(touch);
    }
    open_.swap(next_);
    touching_.clear();
}

void Measure::write(const World& world, RunResult& result) const {
    result.bodies = world.size();
    result.steps = steps;
    result.time = time_;
    result.integrate = clock.summary(Phase::integrate);
    result.broadphase = clock.summary(Phase::broadphase);
    result.narrowphase = clock.summary(Phase::narrowphase);
    result.response = clock.summary(Phase::response);
    result.step = clock.summary(Phase::step);
    result.pairs = pairs;
    result.contacts = contacts;
    result.triangle_tests = triangle_tests;
    result.failures = failures;
    result.events = events;
    result.unresolved = unresolved;
    result.energy_initial_J = initial_.energy();
    result.energy_final_J = latest_.energy();
    result.energy_drift = energy_drift_;
    result.momentum_drift = momentum_drift_;
    result.angular_momentum_drift = angular_drift_;
    result.max_penetration_m = max_depth_;
    result.escaped = escaped_;
    result.stuck = stuck_;
}

Reading Measure::reading() const {
    return {clock.latest_us(Phase::integrate),
            clock.latest_us(Phase::broadphase),
            clock.latest_us(Phase::narrowphase),
            clock.latest_us(Phase::response),
            clock.latest_us(Phase::step),
            latest_.energy(),
            energy_drift_,
            momentum_drift_,
            angular_drift_};
}

}  // namespace kolize
