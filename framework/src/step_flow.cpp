#include "step_flow.h"

#include <algorithm>
#include <stdexcept>

namespace kolize {

namespace {

constexpr double part_angle = 0.5;  // rad; what the integrator does in one go
constexpr double most_parts = 1 << 24;  // of one body in one step
constexpr std::size_t most_knots = 4096;

bool stands(const World& world, std::uint32_t body) { return world.is_static[body] || world.removed[body]; }

}  // namespace

void StepFlow::begin_step(const World& world, const Integrator& integrator, double dt) {
    world_ = &world;
    integrator_ = &integrator;
    end_ = dt;
    if (segments_.size() != world.size()) {
        segments_.resize(world.size());
        for (Segment& segment : segments_) segment.knots.reserve(4);
    }
    for (std::uint32_t body = 0; body < world.size(); ++body) begin(body, 0, world.state(body));
}

void StepFlow::begin(std::uint32_t body, double time, const BodyState& state) {
    Segment& segment = segments_[body];
    segment.begin = time;
    segment.knots.assign(1, state);
    segment.stride = 1;
    segment.held = false;
    segment.bound = {};
    if (stands(*world_, body)) return;
    const double left = end_ - time;
    segment.bound = integrator_->bound(*world_, body, state, left, left);
    const double angle = segment.bound.angular_acceleration > 0 ? segment.bound.angular_speed * left : 0;
    const double parts = std::max(1.0, std::ceil(angle / part_angle));
    if (!(parts <= most_parts))
        throw std::runtime_error("body " + std::to_string(body) + " turns by up to " + std::to_string(angle) +
                                 " rad in a step; continuous stepping follows up to " +
                                 std::to_string(static_cast<int>(part_angle * most_parts)));
    segment.spacing = left / parts;
    if (parts > 1) lay_out(segment, body, static_cast<std::size_t>(parts));
}

void StepFlow::lay_out(Segment& segment, std::uint32_t body, std::size_t parts) {
    BodyState state = segment.knots.front();
    segment.bound = integrator_->bound(*world_, body, state, end_ - segment.begin, segment.spacing);
    segment.stride = (parts + most_knots - 1) / most_knots;
    for (std::size_t k = 1; k < parts; ++k) {
        integrator_->advance_body(*world_, body, segment.spacing, state);
        if (k % segment.stride == 0) segment.knots.push_back(state);
    }
}

void StepFlow::hold(std::uint32_t body, double time) {
    Segment& segment = segments_[body];
    if (segment.held || stands(*world_, body)) return;
    segment.knots.assign(1, moving_at(segment, body, time));
    segment.begin = time;
    segment.held = true;
    segment.bound = {};
}

BodyState StepFlow::moving_at(const Segment& segment, std::uint32_t body, double time) const {
    const double since = time - segment.begin;
    if (!(since > 0) || stands(*world_, body)) return segment.knots.front();
    const auto part = static_cast<std::size_t>(since / segment.spacing);
    const std::size_t knot = std::min(segment.knots.size() - 1, part / segment.stride);
    BodyState state = segment.knots[knot];
    double rest = since - static_cast<double>(knot * segment.stride) * segment.spacing;
    for (std::size_t k = knot * segment.stride; k < part && k + 1 < (knot + 1) * segment.stride; ++k) {
        integrator_->advance_body(*world_, body, segment.spacing, state);
        rest -= segment.spacing;
    }
    if (rest > 0) integrator_->advance_body(*world_, body, rest, state);
    return state;
}

BodyState StepFlow::at(std::uint32_t body, double time) const {
    BodyState now = state(body, time);
    if (segments_[body].held) now.velocity = now.angular_velocity = Vec3::Zero();
    return now;
}

BodyState StepFlow::state(std::uint32_t body, double time) const {
    const Segment& segment = segments_[body];
    return segment.held ? segment.knots.front() : moving_at(segment, body, time);
}

}  // namespace kolize
