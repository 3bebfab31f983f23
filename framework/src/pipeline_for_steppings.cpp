// What the steppings ask of a pipeline besides its stages: candidates along the way, looking back, putting back.
#include "pipeline.h"

#include <algorithm>

namespace kolize {

namespace {

// A box around everything that a body covers on its way. Between two times the path of the centre leaves its chord by
// at most an eighth of the acceleration times the time squared; a body that turns stays inside its own radius.
Aabb swept_bounds(const World& world, std::uint32_t body, const Flow& flow, double from, double until) {
    const BodyState start = flow.at(body, from), end = flow.at(body, until);
    const MotionBound bound = flow.bound(body);
    const Shape& shape = world.shape_of(body);
    const double time = until - from;
    const double bulge =
        (bound.acceleration.norm() + bound.further_acceleration) * time * time / 8 + bound.velocity_error * time;
    Vec3 half = Vec3::Constant(shape.radius);
    Vec3 center = Vec3::Zero();
    if (shape.kind != ShapeKind::sphere) {
        const Mat3 rotation = start.orientation.toRotationMatrix();
        const double turn = (bound.angular_speed + bound.angular_velocity_error) * time * shape.radius;
        const Vec3 turned = rotation.cwiseAbs() * shape.bounds.half_extents() + Vec3::Constant(turn);
        if ((turned.array() < shape.radius).all()) {
            half = turned;
            center = rotation * shape.bounds.center();
        }
    }
    half += Vec3::Constant(bulge + 2 * touch_distance(world, body, body));
    return {start.position.cwiseMin(end.position) + center - half,
            start.position.cwiseMax(end.position) + center + half};
}

}  // namespace

void Pipeline::find_candidates(const Flow& flow, double until) {
    update_swept_bounds(flow, until);
    find_pairs();
    route_pairs();
}

void Pipeline::update_swept_bounds(const Flow& flow, double until) {
    constexpr std::size_t grain = 256;
    host_.parallel_for(rows_.size(), grain, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            if (!row_is_static_[row]) bounds_[row] = swept_bounds(world, rows_[row], flow, 0, until);
    });
    for (std::size_t row = 0; row < rows_.size(); ++row)
        if (!bounds_[row].finite()) refuse_path(rows_[row], flow.at(rows_[row], until));
}

void Pipeline::add_candidates_of(std::uint32_t body, const Flow& flow, double from, double until) {
    const std::uint32_t own = row_of_[body];
    if (own == no_row) return;
    bounds_[own] = swept_bounds(world, body, flow, from, until);
    if (!bounds_[own].finite()) refuse_path(body, flow.at(body, until));
    is_partner_.assign(world.size(), 0);
    for (const Pair& pair : routed_)
        if (pair.a == body || pair.b == body) is_partner_[pair.a] = is_partner_[pair.b] = 1;
    const auto add = [&](std::uint32_t other) {
        if (is_partner_[other] || other == body) return;
        if (route({std::min(body, other), std::max(body, other)})) ++measure.pairs;
    };
    for (std::size_t row = 0; row < rows_.size(); ++row)
        if (bounds_[row].overlaps(bounds_[own])) add(rows_[row]);
    for (const std::uint32_t wall : unbounded_)
        if (reaches_behind(bounds_[own], wall)) add(wall);
}

void Pipeline::kick(std::span<const std::uint32_t> bodies, const Flow& flow, double time) {
    for (const std::uint32_t body : bodies) {
        const double before = world.kinetic_energy(body);
        world.velocity[body] += time * flow.bound(body).acceleration;
        measure.add_work(world.kinetic_energy(body) - before);
    }
}

// By insertion: stable without a buffer, and the rows are few.
void Pipeline::sort_contacts() {
    const auto before = [](const Contact& x, const Contact& y) { return Pair{x.a, x.b} < Pair{y.a, y.b}; };
    for (auto row = contacts.rows.begin(); row != contacts.rows.end(); ++row)
        std::rotate(std::upper_bound(contacts.rows.begin(), row, *row, before), row, row + 1);
}

bool Pipeline::approaching() const {
    return std::any_of(contacts.rows.begin(), contacts.rows.end(), [&](const Contact& c) {
        if (rules[c.rule].detail == Detail::overlap) return true;
        const Vec3 a = world.velocity_at(c.a, c.arm_a), b = world.velocity_at(c.b, c.arm_b);
        // Below rounding of the two velocities the sign says nothing.
        return c.normal.dot(b - a) < -1e-12 * (a.norm() + b.norm());
    });
}

void Pipeline::save() {
    saved_.position = world.position;  // assignment re-uses the buffers
    saved_.velocity = world.velocity;
    saved_.angular_velocity = world.angular_velocity;
    saved_.orientation = world.orientation;
    measure.save();
}

void Pipeline::restore() {
    world.position = saved_.position;
    world.velocity = saved_.velocity;
    world.angular_velocity = saved_.angular_velocity;
    world.orientation = saved_.orientation;
    measure.restore();
}

void Pipeline::put_back(std::uint32_t body) {
    const BodyState before = world.state(body);
    const Quat turned_back = saved_.orientation[body] * world.orientation[body].conjugate();
    world.angular_velocity[body] = turned_back * world.angular_velocity[body];
    world.position[body] = saved_.position[body];
    world.orientation[body] = saved_.orientation[body];
    if (ledger) ledger->after_motion(world, body, before, world.state(body), 0, "stepping", "rollback");
}

}  // namespace kolize
