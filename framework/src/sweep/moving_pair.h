// Two bodies in motion, seen from the first.
//
// Everything stands in the frame of A as it is at the moment looked at: origin at A's centre of mass, axes of A's body
// frame. Differences of positions are taken before anything else, so nothing is lost far from the world's origin.
#pragma once

#include "sweep/convex_gap.h"

#include <kolize/narrowphase.h>

namespace kolize {

// A body as the sweep sees it: triangles, a point or a segment with a radius, or a half-space.
struct SweptBody {
    std::uint32_t id = 0;
    const Mesh* mesh = nullptr;        // none of a sphere, a capsule, a half-space
    double radius = 0;                 // m, of a sphere or capsule
    Vec3 core = Vec3::Zero();          // capsule: its axis goes from -core to core, body frame
    HierarchyNode core_box;            // of a sphere or capsule without its radius
    double reach = 0;                  // m, farthest corner from the centre of mass: what turning can move
    Vec3 plane_normal = Vec3::Zero();  // half-space: out of the solid, body frame

    bool is_point() const { return radius > 0 && reach == 0; }
    bool is_plane() const { return !mesh && radius == 0; }
    // Boxes over the features; of a half-space one without size.
    bool empty() const { return mesh && mesh->hierarchy.nodes.empty(); }
    const HierarchyNode& node(std::uint32_t i) const { return mesh ? mesh->hierarchy.nodes[i] : core_box; }
    // The i-th feature in the order of the boxes' leaves: a triangle's number, or 0.
    std::uint32_t feature_at(std::uint32_t i) const { return mesh ? mesh->hierarchy.order[i] : 0; }
    ConvexFeature feature(std::uint32_t number) const;
};

SweptBody swept_body(const World& world, std::uint32_t body);

// Poses and velocities at one time.
struct PairMoment {
    double time = 0;
    Transform b_to_a;
    Vec3 linear_a, angular_a, linear_b, angular_b;  // m/s of the centres of mass (of B relative to A), rad/s
    double speeds = 0;                              // m/s: sum of the bodies' speeds in the world

    Vec3 velocity_a(const Vec3& p) const { return linear_a + angular_a.cross(p); }
    Vec3 velocity_b(const Vec3& p) const { return linear_b + angular_b.cross(p - b_to_a.translation); }
};

// Bounds on how the distance of two points of the bodies can change until the end of the step: its second derivative is
// at most `acceleration`, its first is known to `velocity_error`.
struct PairBound {
    double of_centers = 0;      // m/s^2, relative, of the centres of mass
    double acceleration = 0;    // m/s^2, relative, of any two corners
    double velocity_error = 0;  // m/s
    double turning = 0;         // m/s: how much the velocity of a corner may differ from its body's, of both bodies
    double angular_speed = 0;   // rad/s, of both bodies
};

class MovingPair {
public:
    // B is the half-space if there is one.
    MovingPair(const World& world, const Flow& flow, std::uint32_t a, std::uint32_t b);

    PairMoment at(double time) const;

    // From when until when, in s after the moment, the bounding spheres may touch; begin > end: not within the horizon.
    struct Span {
        double begin = 0, end = 0;
    };
    Span near_span(const PairMoment& moment, double horizon) const;

    // Whether a plane that a glance finds stands between the features, at least `touch` away, from the moment on for
    // `span` seconds. Quick; safe_time would say so more often.
    bool clearly_apart(const PairMoment& moment, const ConvexFeature& fa, const ConvexFeature& fb, double span) const;

    // A moment at which the gap of two features is at least `target`, not later than `horizon` seconds after `moment`,
    // such that it does not fall below `target` before. 0: the gap is below already, or may fall at once.
    double safe_time(const PairMoment& moment, const ConvexFeature& fa, const ConvexFeature& fb, const FeatureGap& gap,
                     double target, double horizon) const;
    // The speed at which the nearest points approach (> 0) along the normal of the gap.
    double approach(const PairMoment& moment, const FeatureGap& gap) const;
    // Below this an approach speed is rounding.
    double approach_noise(const PairMoment& moment) const;

    FeatureGap gap(const PairMoment& moment, const ConvexFeature& fa, const ConvexFeature& fb) const;
    // The plane's normal, from A into the half-space B.
    Vec3 plane_normal(const PairMoment& moment) const { return -(moment.b_to_a.rotation * b.plane_normal); }

    SweptBody a, b;
    double radii = 0;  // m, of both
    double touch = 0;  // m, see touch_distance
    PairBound bound;

private:
    Vec3 axis_turn(const PairMoment& moment, const FeatureGap& gap) const;

    const Flow& flow_;
};

}  // namespace kolize
