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

// m/s, what responses take for rounding in the approach of a contact, tenfold.
double rounding_of(const World& world, const Contact& c) {
    return 1e-11 * (world.velocity_at(c.a, c.arm_a).norm() + world.velocity_at(c.b, c.arm_b).norm());
}

// A bounce that takes less than this share of a step is not worth following.
constexpr double least_bounce = 1.0 / 64;
// Touch distances that bodies at rest are to part by in a step: what rounding does to flush faces is less.
constexpr double parting = 1000;
// Touch distances that rounding may have let bodies at rest sink into each other; they part again by as much.
constexpr double hairline = 1000;
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
        if (c.depth > hairline * touch || c.normal.isZero(0)) return false;
        const double speed = approach(world, c);
        if (speed <= least || impacts_[candidate] > max_impacts_) return true;
        if (is_known_to_rest(world, {c.a, c.b})) return speed <= fall;
        return world.restitution(c.a, c.b) < 1 && speed <= 0.5 * least_bounce * fall;
    });
}

// Whether an impact left bodies together that could sink into each other by what rounding left of their approach.
bool EventStepping::leaves_at_rest(const Pipeline& pipeline) const {
    const World& world = pipeline.world;
    const auto stays = [&](const Contact& c) {
        if (c.depth > 0 || c.normal.isZero(0)) return false;
        return approach(world, c) >= (world.restitution(c.a, c.b) < 1 ? -rounding_of(world, c) : 0);
    };
    return keeps_apart() && std::any_of(pipeline.contacts.rows.begin(), pipeline.contacts.rows.end(), stays);
}

// Shortly before the end of the step all stop, with velocities that are used up when it ends.
void EventStepping::settle(Pipeline& pipeline, std::size_t candidate, double dt) {
    if (impacts_[candidate] == max_impacts_ + 1) ++pipeline.measure.unresolved;
    const Pair& pair = pipeline.candidates()[candidate];
    const double acceleration = pull(bodies_), left = dt - times_[candidate];
    const double touch = touch_distance(pipeline.world, pair.a, pair.b);
    const double last = acceleration > 0 ? std::sqrt(touch / (2 * acceleration)) : 0;
    const bool is_last = !(left > 2 * last);
    const double length = is_last ? left : left - last, kick = is_last ? left : 0.5 * length;
    measure_closing(pipeline, candidate);
    for (Contact& c : pipeline.contacts.rows) {
        Meeting& meeting = meeting_of({c.a, c.b});
        const double speed = (is_last ? 0 : parting * touch / dt) + 2 * path_error(pipeline.world, {c.a, c.b});
        c.depth = (is_last ? 0 : c.depth) + length * (speed + 0.5 * meeting.closing * length);
        meeting.since = times_[candidate];
        meeting.length = length;
    }
    let_go(pipeline, kick, length, dt);
    for (Contact& c : pipeline.contacts.rows) c.depth = 0;
}

// Bodies wedged between others cannot part from all of them, and the impulses that try grow without bound: such bodies
// are only stopped.
void EventStepping::let_go(Pipeline& pipeline, double kick, double length, double dt) {
    double fastest = pull(bodies_) * dt;
    for (const Contact& c : pipeline.contacts.rows) fastest = std::max(fastest, c.depth / length);
    before_.clear();
    for (const std::uint32_t body : bodies_) before_.push_back(pipeline.world.state(body));
    pipeline.measure.save();
    const auto respond = [&] {
        pipeline.kick(bodies_, flow_, kick);
        pipeline.respond(dt, length);
        pipeline.kick(bodies_, flow_, -kick);
    };
    respond();
    if (gained_energy(pipeline.world) > energy_to_spare(pipeline.world, fastest)) {
        for (std::size_t i = 0; i < bodies_.size(); ++i) pipeline.world.set_state(bodies_[i], before_[i]);
        pipeline.measure.restore();
        for (Contact& c : pipeline.contacts.rows) c.depth = 0;
        respond();
    }
    for (const std::uint32_t body : bodies_) settled_[body] = 1;
}

double EventStepping::gained_energy(const World& world) const {
    double gained = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        gained += world.kinetic_energy(bodies_[i]) - world.kinetic_energy(bodies_[i], before_[i]);
    return gained;
}

// J: more than bodies gain whose speeds change by a few times the given one.
double EventStepping::energy_to_spare(const World& world, double change) const {
    double energy = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const double radius = world.shape_of(bodies_[i]).radius;
        const double speed = before_[i].velocity.norm() + before_[i].angular_velocity.norm() * radius;
        energy += 4 * change * (speed + 4 * change) / world.inverse_mass[bodies_[i]];
    }
    return energy;
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
bool EventStepping::add_resting(Pipeline& pipeline, std::size_t candidate, bool known, double reach, double dt) {
    const World& world = pipeline.world;
    auto& rows = pipeline.contacts.rows;
    const auto first = static_cast<std::ptrdiff_t>(rows.size());
    add_contacts(pipeline, candidate, known, reach);
    const double fall = pull(bodies_) * dt;
    const auto is_impact = [&](const Contact& c) { return c.depth < 0 && approach(world, c) > fall; };
    rows.erase(std::remove_if(rows.begin() + first, rows.end(), is_impact), rows.end());
    return rows.begin() + first != rows.end();
}

// Bodies that turn close faster than what pulls them: a contact that meets again slowly and long before it should shows
// by how much, and is let go accordingly.
void EventStepping::measure_closing(const Pipeline& pipeline, std::size_t candidate) {
    const Pair& pair = pipeline.candidates()[candidate];
    Meeting& meeting = meeting_of(pair);
    const double time = times_[candidate] - meeting.since;
    if (!(time < 0.5 * meeting.length) || !(time > 0)) return;
    const double fall = pull(bodies_) * meeting.length;
    double most = meeting.closing;
    for (const Contact& c : pipeline.contacts.rows) {
        if (Pair{c.a, c.b} != pair || approach(pipeline.world, c) > least_bounce * fall) continue;
        const double pulled = c.normal.dot(flow_.bound(c.a).acceleration - flow_.bound(c.b).acceleration);
        most = std::max(most, 2 * approach(pipeline.world, c) / time - pulled);
    }
    meeting.closing = std::min(fastest_closing(pipeline.world, pair), 2 * most);
}

// m/s^2: no turn of the two makes the gap between them close faster.
double EventStepping::fastest_closing(const World& world, const Pair& pair) const {
    double spin = 0, size = 0;
    for (const std::uint32_t body : {pair.a, pair.b}) {
        if (is_fixed(world, body)) continue;
        spin += world.angular_velocity[body].norm();
        size += world.shape_of(body).radius;
    }
    return 4 * spin * ((world.velocity[pair.b] - world.velocity[pair.a]).norm() + spin * size);
}

EventStepping::Meeting& EventStepping::meeting_of(const Pair& pair) {
    const auto place = std::lower_bound(meetings_.begin(), meetings_.end(), pair,
                                        [](const Meeting& m, const Pair& p) { return m.pair < p; });
    if (place != meetings_.end() && place->pair == pair) return *place;
    return *meetings_.insert(place, {pair, 0, 0, 0});
}

// By how much the speed at which two bodies part may be other than their velocities say, m/s.
double EventStepping::path_error(const World& world, const Pair& pair) const {
    double error = 0;
    for (const std::uint32_t body : {pair.a, pair.b}) {
        if (is_fixed(world, body)) continue;
        const MotionBound bound = flow_.bound(body);
        error += bound.velocity_error + bound.angular_velocity_error * world.shape_of(body).radius;
    }
    return error;
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
