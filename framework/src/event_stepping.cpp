#include "event_stepping.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace kolize {

namespace {

bool same_motion(const BodyState& x, const BodyState& y) {
    return x.velocity == y.velocity && x.angular_velocity == y.angular_velocity;
}

template <class Call>
void follow(const Pipeline& pipeline, Call&& call) {
    try {
        call();
    } catch (const std::runtime_error& e) {
        pipeline.refuse_motion(e.what());
    }
}

}  // namespace

void EventStepping::step(Pipeline& pipeline, double dt) {
    find_first_impacts(pipeline, dt);
    while (!times_.empty()) {
        const std::size_t next = next_impact(pipeline);
        if (!(times_[next] < dt)) break;
        answer(pipeline, next, dt);
    }
    end_step(pipeline, dt);
}

// Room for a dense crowd: a new record of candidates in a long run then costs no allocation.
void EventStepping::reserve(std::size_t bodies) {
    const std::size_t usual_pairs = 16 * bodies;
    times_.reserve(usual_pairs);
    impacts_.reserve(usual_pairs);
    gathered_.reserve(usual_pairs);
    again_.reserve(usual_pairs);
    again_times_.reserve(usual_pairs);
    meetings_.reserve(usual_pairs);
    bodies_.reserve(bodies);
    before_.reserve(bodies);
}

void EventStepping::find_first_impacts(Pipeline& pipeline, double dt) {
    reserve(pipeline.world.size());
    pipeline.contacts.clear();
    follow(pipeline, [&] { flow_.begin_step(pipeline.world, pipeline.integrator(), dt); });
    pipeline.find_candidates(flow_, dt);
    again_.resize(pipeline.candidates().size());
    std::iota(again_.begin(), again_.end(), std::size_t(0));
    times_.assign(again_.size(), infinity);
    impacts_.assign(again_.size(), 0);
    settled_.assign(pipeline.world.size(), 0);
    meetings_.clear();
    find_impacts(pipeline, again_, 0, dt, times_);
}

// Of equal times the pair with the lower ids: which candidates a broadphase adds makes no difference.
std::size_t EventStepping::next_impact(const Pipeline& pipeline) const {
    std::size_t next = 0;
    for (std::size_t i = 1; i < times_.size(); ++i)
        if (times_[i] < times_[next] ||
            (times_[i] == times_[next] && pipeline.candidates()[i] < pipeline.candidates()[next]))
            next = i;
    return next;
}

// The impact of one candidate, and of all that touches the same bodies at that moment.
void EventStepping::answer(Pipeline& pipeline, std::size_t candidate, double dt) {
    const double time = times_[candidate];
    ++impacts_[candidate];
    gather(pipeline, candidate, dt, false);
    const bool at_rest = rests(pipeline, candidate, dt);
    if (at_rest) {
        gather(pipeline, candidate, dt, true);
        settle(pipeline, candidate, dt);
    } else {
        for (Contact& c : pipeline.contacts.rows) c.depth = std::max(c.depth, 0.0);  // what lies on something touches
        pipeline.respond(dt);
        if (leaves_at_rest(pipeline)) settle(pipeline, candidate, dt);
    }
    find_changed(pipeline, time);
    if (bodies_.empty() || impacts_[candidate] > (at_rest ? 2 : 1) * max_impacts_) give_up(pipeline, candidate, time);
    look_again(pipeline, time, dt);
}

// Contacts spread from body to body: what touches a body that may be struck is part of the same impact. So are, with
// their gaps, contacts of bodies that were let go in this step, as they lie on each other; and when all settle those
// that would close within the step, as otherwise one would be let go onto the other.
void EventStepping::gather(Pipeline& pipeline, std::size_t candidate, double dt, bool settling) {
    const double time = times_[candidate];
    const auto add = [&](std::size_t some, bool known) {
        const double gap = reach(pipeline, some, dt, settling);
        return gap > 0 ? add_resting(pipeline, some, known, gap, dt) : add_contacts(pipeline, some, known, 0);
    };
    pipeline.contacts.clear();
    bodies_.clear();
    is_in_.assign(pipeline.world.size(), 0);
    gathered_.assign(pipeline.candidates().size(), 0);
    take_bodies(pipeline, candidate, time);
    gathered_[candidate] = 1;
    add(candidate, true);
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        for (std::size_t other = 0; other < gathered_.size(); ++other) {
            const Pair& pair = pipeline.candidates()[other];
            if (gathered_[other] || (pair.a != bodies_[i] && pair.b != bodies_[i])) continue;
            gathered_[other] = 1;
            if (pipeline.world.removed[pair.a] || pipeline.world.removed[pair.b]) continue;
            if (!comes_close(pipeline, other, time, reach(pipeline, other, dt, settling))) continue;
            for (const std::uint32_t body : {pair.a, pair.b})
                if (!is_in_[body]) pipeline.world.set_state(body, flow_.state(body, time));
            if (add(other, false)) take_bodies(pipeline, other, time);
        }
    pipeline.sort_contacts();
}

void EventStepping::take_bodies(Pipeline& pipeline, std::size_t candidate, double time) {
    const Pair& pair = pipeline.candidates()[candidate];
    for (const std::uint32_t body : {pair.a, pair.b}) {
        if (is_in_[body] || is_fixed(pipeline.world, body)) continue;
        is_in_[body] = 1;
        bodies_.push_back(body);
        pipeline.world.set_state(body, flow_.state(body, time));
    }
}

bool EventStepping::comes_close(const Pipeline& pipeline, std::size_t candidate, double time, double reach) const {
    const Pair& pair = pipeline.candidates()[candidate];
    const World& world = pipeline.world;
    const Shape &a = world.shape_of(pair.a), &b = world.shape_of(pair.b);
    if (a.kind == ShapeKind::half_space || b.kind == ShapeKind::half_space) return true;
    const double far = a.radius + b.radius + reach + 8 * touch_distance(world, pair.a, pair.b);
    return (flow_.at(pair.a, time).position - flow_.at(pair.b, time).position).squaredNorm() <= far * far;
}

// Leaves in bodies_ those whose motion the response has changed, and begins their new motion.
void EventStepping::find_changed(Pipeline& pipeline, double time) {
    std::size_t kept = 0;
    for (const std::uint32_t body : bodies_) {
        const BodyState before = flow_.state(body, time), after = pipeline.world.state(body);
        if (same_motion(before, after) && !pipeline.world.removed[body]) continue;
        pipeline.moved(body, flow_.start(body), before, flow_.is_held(body) ? 0 : time - flow_.begin_of(body));
        follow(pipeline, [&] { flow_.begin(body, time, after); });
        bodies_[kept++] = body;
    }
    bodies_.resize(kept);
}

// Nothing that the response does parts these two for longer than an instant. Held bodies do not overlap, whatever
// comes.
void EventStepping::give_up(Pipeline& pipeline, std::size_t candidate, double time) {
    const Pair pair = pipeline.candidates()[candidate];
    const bool overlaps =
        std::any_of(pipeline.contacts.rows.begin(), pipeline.contacts.rows.end(), [&](const Contact& c) {
            return Pair{c.a, c.b} == pair && c.depth > 0;
        });
    times_[candidate] = infinity;
    impacts_[candidate] = max_impacts_ + 1;
    if (overlaps || !keeps_apart() || !pipeline.is_detailed(candidate)) return;
    ++pipeline.measure.unresolved;
    for (const std::uint32_t body : {pair.a, pair.b}) {
        if (is_fixed(pipeline.world, body) || flow_.is_held(body)) continue;
        pipeline.moved(body, flow_.start(body), flow_.state(body, time), time - flow_.begin_of(body));
        flow_.hold(body, time);
        if (std::find(bodies_.begin(), bodies_.end(), body) == bodies_.end()) bodies_.push_back(body);
    }
}

// Nothing can come of this pair until the end of the step.
bool EventStepping::is_done(const Pipeline& pipeline, std::size_t candidate) const {
    const Pair& pair = pipeline.candidates()[candidate];
    const World& world = pipeline.world;
    const auto still = [&](std::uint32_t body) { return flow_.is_held(body) || is_fixed(world, body); };
    if (world.removed[pair.a] || world.removed[pair.b] || (still(pair.a) && still(pair.b))) return true;
    return impacts_[candidate] > max_impacts_ && !(keeps_apart() && pipeline.is_detailed(candidate));
}

void EventStepping::look_again(Pipeline& pipeline, double time, double dt) {
    changed_.assign(pipeline.world.size(), 0);
    bool removed = false;
    for (const std::uint32_t body : bodies_) {
        changed_[body] = 1;
        removed = removed || pipeline.world.removed[body];
    }
    if (removed) pipeline.update_swept_bounds(flow_, dt);
    for (const std::uint32_t body : bodies_) pipeline.add_candidates_of(body, flow_, time, dt);
    times_.resize(pipeline.candidates().size(), infinity);
    impacts_.resize(times_.size(), 0);
    again_.clear();
    for (std::size_t i = 0; i < times_.size(); ++i) {
        const Pair& pair = pipeline.candidates()[i];
        if (!changed_[pair.a] && !changed_[pair.b]) continue;
        times_[i] = infinity;
        if (!is_done(pipeline, i)) again_.push_back(i);
    }
    again_times_.assign(again_.size(), infinity);
    find_impacts(pipeline, again_, time, dt, again_times_);
    for (std::size_t i = 0; i < again_.size(); ++i) times_[again_[i]] = again_times_[i];
}

void EventStepping::end_step(Pipeline& pipeline, double dt) {
    World& world = pipeline.world;
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        if (is_fixed(world, body)) continue;
        const BodyState end = flow_.state(body, dt);
        if (!flow_.is_held(body)) pipeline.moved(body, flow_.start(body), end, dt - flow_.begin_of(body));
        world.set_state(body, end);
    }
    finish(pipeline, dt);
}

}  // namespace kolize
