// The part of EventStepping that brings bodies to rest on each other.
#include "event_stepping.h"

#include <algorithm>
#include <array>

namespace kolize {

namespace {

// m/s, > 0 where the bodies approach at the contact.
double approach(const World& world, const Contact& c) {
    return c.normal.dot(world.velocity_at(c.a, c.arm_a) - world.velocity_at(c.b, c.arm_b));
}

// m, by how much the points of a contact close in a time because their bodies turn.
double closed_by_turning(const World& world, const Contact& c, double time) {
    const auto centripetal = [&](std::uint32_t body, const Vec3& arm) {
        const Vec3& spin = world.angular_velocity[body];
        return spin.cross(spin.cross(arm)).eval();
    };
    const double acceleration = c.normal.dot(centripetal(c.b, c.arm_b) - centripetal(c.a, c.arm_a));
    return std::max(0.0, -0.5 * acceleration * time * time);
}

// A bounce that takes less than this share of a step is not worth following.
constexpr double least_bounce = 1.0 / 64;
// Touch distances that bodies at rest are to part by in a step: what rounding does to flush faces is less.
constexpr double parting = 1000;
// Share of the bodies' size: a wider gap is no contact, however soon it closes.
constexpr double widest_reach = 1e-5;

}  // namespace

// Whether every approach at hand is one of bodies that lie on each other: they came no farther than surfaces that touch
// may be apart, or bounce too low to follow, or were let go in this step, or keep meeting.
bool EventStepping::rests(const Pipeline& pipeline, std::size_t candidate, double dt) const {
    if (!keeps_apart()) return false;
    const World& world = pipeline.world;
    const Pair& pair = pipeline.candidates()[candidate];
    const double acceleration = pull(bodies_), fall = acceleration * dt;
    const double touch = touch_distance(world, pair.a, pair.b);
    const double least = std::sqrt(8 * acceleration * touch) + 16 * touch / dt;
    return std::all_of(pipeline.contacts.rows.begin(), pipeline.contacts.rows.end(), [&](const Contact& c) {
        if (c.depth > 0 || c.normal.isZero(0)) return false;
        const double speed = approach(world, c);
        if (speed <= least || impacts_[candidate] > max_impacts_) return true;
        if (is_known_to_rest(world, {c.a, c.b})) return speed <= fall;
        return world.restitution(c.a, c.b) < 1 && speed <= 0.5 * least_bounce * fall;
    });
}

// Shortly before the end of the step all stop, with velocities that are used up when it ends.
void EventStepping::settle(Pipeline& pipeline, std::size_t candidate, double dt) {
    if (impacts_[candidate] == max_impacts_ + 1) ++pipeline.measure.unresolved;
    gather(pipeline, candidate, dt, true);
    const Pair& pair = pipeline.candidates()[candidate];
    const double acceleration = pull(bodies_), left = dt - times_[candidate];
    const double touch = touch_distance(pipeline.world, pair.a, pair.b);
    const double last = acceleration > 0 ? std::sqrt(touch / (2 * acceleration)) : 0;
    const bool is_last = !(left > 2 * last);
    const double length = is_last ? left : left - last, kick = is_last ? left : 0.5 * length;
    for (Contact& c : pipeline.contacts.rows)
        c.depth = is_last ? 0 : c.depth + parting * touch + closed_by_turning(pipeline.world, c, length);
    for (const std::uint32_t body : bodies_) settled_[body] = 1;
    pipeline.kick(bodies_, flow_, kick);
    pipeline.respond(dt, length);
    pipeline.kick(bodies_, flow_, -kick);
}

// The gap (m) up to which a pair's contacts take part in an impact: as high as bodies that are let go rise in a step,
// once they are known to lie on each other; before that not so far that one surface meets another's side.
double EventStepping::reach(const Pipeline& pipeline, std::size_t candidate, double dt, bool settling) const {
    const World& world = pipeline.world;
    const Pair& pair = pipeline.candidates()[candidate];
    const bool known = is_known_to_rest(world, pair);
    if ((!known && !settling) || !pipeline.is_detailed(candidate)) return 0;
    const std::array<std::uint32_t, 2> both{pair.a, pair.b};
    const double rise = pull(both) * dt * dt / 8 + 8 * touch_distance(world, pair.a, pair.b);
    if (known) return rise;
    double size = infinity;
    for (const std::uint32_t body : both)
        if (world.shape_of(body).kind != ShapeKind::half_space) size = std::min(size, world.shape_of(body).radius);
    return std::min(rise, widest_reach * size);
}

// Of contacts with a gap only those that approach no faster than falling takes them: the others are impacts to come.
bool EventStepping::add_resting(Pipeline& pipeline, std::size_t candidate, double reach, double dt) {
    const World& world = pipeline.world;
    auto& rows = pipeline.contacts.rows;
    const auto first = static_cast<std::ptrdiff_t>(rows.size());
    add_contacts(pipeline, candidate, false, reach);
    const double fall = pull(bodies_) * dt;
    const auto is_impact = [&](const Contact& c) { return c.depth < 0 && approach(world, c) > fall; };
    rows.erase(std::remove_if(rows.begin() + first, rows.end(), is_impact), rows.end());
    return rows.begin() + first != rows.end();
}

// Both were let go in this step, or never move.
bool EventStepping::is_known_to_rest(const World& world, const Pair& pair) const {
    return (is_fixed(world, pair.a) || settled_[pair.a]) && (is_fixed(world, pair.b) || settled_[pair.b]);
}

// The strongest of the forces that do not change, m/s^2.
double EventStepping::pull(std::span<const std::uint32_t> bodies) const {
    double most = 0;
    for (const std::uint32_t body : bodies) most = std::max(most, flow_.bound(body).acceleration.norm());
    return most;
}

}  // namespace kolize
