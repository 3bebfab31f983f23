#include "sweep/moving_pair.h"

#include <algorithm>

namespace kolize {

namespace {

// Largest s in [0, horizon] such that gap + speed s - acceleration s^2 / 2 stays at or above 0 until then.
double time_above_zero(double gap, double speed, double acceleration, double horizon) {
    if (!(gap > 0)) return 0;
    const double end = gap + horizon * (speed - 0.5 * acceleration * horizon);
    if (end >= 0) return horizon;
    const double root = std::sqrt(speed * speed + 2 * acceleration * gap);
    return std::min(horizon, speed > 0 ? (speed + root) / acceleration : 2 * gap / (root - speed));
}

}  // namespace

ConvexFeature SweptBody::feature(std::uint32_t number) const {
    if (!mesh) return {{-core, core, Vec3::Zero()}, is_point() ? 1 : 2};
    const Triangle& t = mesh->triangles[number];
    return {{mesh->vertices[t[0]], mesh->vertices[t[1]], mesh->vertices[t[2]]}, 3};
}

SweptBody swept_body(const World& world, std::uint32_t body) {
    const Shape& shape = world.shape_of(body);
    SweptBody swept;
    swept.id = body;
    swept.core_box.count = 1;
    switch (shape.kind) {
    case ShapeKind::sphere: swept.radius = shape.radius; break;
    case ShapeKind::half_space: swept.plane_normal = shape.normal; break;
    case ShapeKind::capsule:
        swept.radius = shape.cap_radius;
        swept.core = Vec3(0, shape.half_height, 0);
        swept.reach = shape.half_height;
        swept.core_box.half.y() =
            std::nextafter(static_cast<float>(shape.half_height), std::numeric_limits<float>::infinity());
        break;
    case ShapeKind::box:
    case ShapeKind::hull:
    case ShapeKind::mesh:
        swept.mesh = shape.mesh.get();
        swept.reach = shape.radius;
        break;
    }
    return swept;
}

MovingPair::MovingPair(const World& world, const Flow& flow, std::uint32_t body_a, std::uint32_t body_b)
    : a(swept_body(world, body_a)), b(swept_body(world, body_b)), flow_(flow) {
    radii = a.radius + b.radius;
    touch = touch_distance(world, body_a, body_b);
    const MotionBound ma = flow.bound(body_a), mb = flow.bound(body_b);
    const auto centripetal = [](const MotionBound& m, double reach) {
        return (m.angular_acceleration + m.angular_speed * m.angular_speed) * reach;
    };
    bound.of_centers = (mb.acceleration - ma.acceleration).norm() + ma.further_acceleration + mb.further_acceleration;
    bound.acceleration = bound.of_centers + centripetal(ma, a.reach) + centripetal(mb, b.reach);
    bound.velocity_error = ma.velocity_error + mb.velocity_error + ma.angular_velocity_error * a.reach +
                           mb.angular_velocity_error * b.reach;
    bound.turning = ma.angular_speed * a.reach + mb.angular_speed * b.reach;
    bound.angular_speed = (a.reach > 0 ? ma.angular_speed : 0) + (b.reach > 0 ? mb.angular_speed : 0);
}

PairMoment MovingPair::at(double time) const {
    const BodyState sa = flow_.at(a.id, time), sb = flow_.at(b.id, time);
    const Mat3 to_a = sa.orientation.toRotationMatrix().transpose();
    PairMoment moment;
    moment.time = time;
    moment.b_to_a.rotation = to_a * sb.orientation.toRotationMatrix();
    moment.b_to_a.translation = to_a * (sb.position - sa.position);
    moment.speeds = sa.velocity.norm() + sb.velocity.norm();
    moment.linear_a = Vec3::Zero();
    moment.linear_b = to_a * (sb.velocity - sa.velocity);
    moment.angular_a = a.reach > 0 ? Vec3(to_a * sa.angular_velocity) : Vec3::Zero();
    moment.angular_b = b.reach > 0 ? Vec3(to_a * sb.angular_velocity) : Vec3::Zero();
    return moment;
}

MovingPair::Span MovingPair::near_span(const PairMoment& moment, double horizon) const {
    const double slack = horizon * (0.5 * bound.of_centers * horizon + bound.velocity_error);
    const double reach = a.reach + b.reach + radii + 2 * touch + slack;
    const Vec3 &d = moment.b_to_a.translation, &v = moment.linear_b;
    if (b.is_plane()) {
        const Vec3 normal = plane_normal(moment);
        const double gap = normal.dot(d) - reach, speed = normal.dot(v);
        if (gap > 0 && gap + horizon * speed > 0) return {1, 0};
        return {gap > 0 ? gap / -speed : 0, horizon};
    }
    const double vv = v.squaredNorm(), dv = d.dot(v), far = d.squaredNorm() - reach * reach;
    if (vv == 0) return far > 0 ? Span{1, 0} : Span{0, horizon};
    const double root = dv * dv - vv * far + 1e-12 * vv * d.squaredNorm();  // of which rounding takes less
    if (root < 0) return {1, 0};
    const double width = std::sqrt(root);
    return {std::max(0.0, (-dv - width) / vv), std::min(horizon, (-dv + width) / vv)};
}

bool MovingPair::clearly_apart(const PairMoment& moment, const ConvexFeature& fa, const ConvexFeature& fb,
                               double span) const {
    if (b.is_plane()) return false;
    std::array<Vec3, 3> a_then, b_then;
    for (int i = 0; i < fa.count; ++i) a_then[i] = fa.corners[i] + span * moment.velocity_a(fa.corners[i]);
    for (int j = 0; j < fb.count; ++j) b_then[j] = fb.corners[j] + span * moment.velocity_b(fb.corners[j]);
    const double now = radii + touch, then = now + span * (0.5 * bound.acceleration * span + bound.velocity_error);
    const auto lowest = [](const std::array<Vec3, 3>& points, int count, const Vec3& n) {
        double low = n.dot(points[0]);
        for (int i = 1; i < count; ++i) low = std::min(low, n.dot(points[i]));
        return low;
    };
    const auto between = [&](const Vec3& along) {
        const double length = along.norm();
        const auto gap = [&](const auto& p, const auto& q) {
            return lowest(q, fb.count, along) + lowest(p, fa.count, -along);
        };
        return length > 0 && gap(fa.corners, fb.corners) > now * length && gap(a_then, b_then) > then * length;
    };
    const auto middle = [](const ConvexFeature& f) {
        Vec3 sum = f.corners[0];
        for (int i = 1; i < f.count; ++i) sum += f.corners[i];
        return Vec3(sum / f.count);
    };
    const Vec3 across = middle(fb) - middle(fa);
    if (between(across)) return true;
    for (const ConvexFeature* f : {&fa, &fb}) {
        if (f->count < 3) continue;
        const Vec3 face = f->edge(0).cross(f->edge(1));
        if (between(face.dot(across) < 0 ? Vec3(-face) : face)) return true;
    }
    return false;
}

FeatureGap MovingPair::gap(const PairMoment& moment, const ConvexFeature& fa, const ConvexFeature& fb) const {
    if (!b.is_plane()) return gap_between(fa, fb);
    FeatureGap gap;
    gap.normal = plane_normal(moment);
    int lowest = 0;
    for (int i = 1; i < fa.count; ++i)
        if (gap.normal.dot(fa.corners[i] - fa.corners[lowest]) > 0) lowest = i;
    gap.on_a = fa.corners[lowest];
    gap.distance = gap.projected = gap.normal.dot(moment.b_to_a.translation - gap.on_a);
    gap.on_b = gap.on_a + gap.distance * gap.normal;
    return gap;
}

// d(normal)/dt that keeps the separating plane along the features as they turn: for each tied direction d with angular
// velocity w, n'.d = -n.(w x d).
Vec3 MovingPair::axis_turn(const PairMoment& moment, const FeatureGap& gap) const {
    const auto tilt = [&](const FeatureGap::Tie& tie) {
        const Vec3& w = tie.of_a ? moment.angular_a : moment.angular_b;
        return -gap.normal.dot(w.cross(tie.direction));
    };
    if (gap.tie_count == 0) return Vec3::Zero();
    const Vec3& d = gap.ties[0].direction;
    const double dd = d.squaredNorm(), first = tilt(gap.ties[0]);
    if (gap.tie_count == 1) return (first / dd) * d;
    const Vec3& e = gap.ties[1].direction;
    const double ee = e.squaredNorm(), de = d.dot(e), second = tilt(gap.ties[1]);
    const double determinant = dd * ee - de * de;
    if (!(determinant > 0)) return (first / dd) * d;
    return ((ee * first - de * second) / determinant) * d + ((dd * second - de * first) / determinant) * e;
}

// The separating plane may be turned as one likes: as long as all corners stay on their sides of it the features are
// apart. With a normal that turns at the constant rate w the gap of two corners r apart with relative velocity v has
// the derivative n.v + n'.r and a second derivative of at most |r''| + 2 w |v| + w^2 |r|.
double MovingPair::safe_time(const PairMoment& moment, const ConvexFeature& fa, const ConvexFeature& fb,
                             const FeatureGap& gap, double target, double horizon) const {
    const Vec3 turn = b.is_plane() ? Vec3::Zero() : axis_turn(moment, gap);
    const double rate = turn.norm();
    const double speed = moment.linear_b.norm() + bound.turning + bound.acceleration * horizon;
    double safe = horizon;
    for (int i = 0; i < fa.count; ++i)
        for (int j = 0; j < (b.is_plane() ? 1 : fb.count); ++j) {
            const Vec3& p = fa.corners[i];
            const Vec3 q =
                b.is_plane() ? Vec3(p + gap.normal.dot(moment.b_to_a.translation - p) * gap.normal) : fb.corners[j];
            const Vec3 r = q - p, v = moment.velocity_b(q) - moment.velocity_a(p);
            const double acceleration = bound.acceleration + rate * (2 * speed + rate * (r.norm() + speed * horizon));
            safe = std::min(
                safe, time_above_zero(gap.normal.dot(r) - radii - target,
                                      gap.normal.dot(v) + turn.dot(r) - bound.velocity_error, acceleration, horizon));
        }
    return safe;
}

double MovingPair::approach(const PairMoment& moment, const FeatureGap& gap) const {
    const Vec3 at_a = gap.on_a + a.radius * gap.normal, at_b = gap.on_b - b.radius * gap.normal;
    return -gap.normal.dot(moment.velocity_b(at_b) - moment.velocity_a(at_a));
}

double MovingPair::approach_noise(const PairMoment& moment) const {
    constexpr double relative = 1e-11;  // ten times the share that responses take for rounding
    return relative * (moment.speeds + bound.turning);
}

}  // namespace kolize
