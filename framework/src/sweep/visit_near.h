// The walk of sweep/impact_search.h over two hierarchies.
#pragma once

#include "sweep/impact_search.h"

namespace kolize {

// One of the directions along which boxes are compared, and what the bodies' turning does along it.
struct SweepAxis {
    Vec3 direction;       // frame of A
    Vec3 on_a, on_b;      // |direction| seen in the body axes of A and of B: how far a box reaches along it
    Vec3 turn_a, turn_b;  // m/s per m of the box's half size, likewise
};

template <class Visit>
class NearWalk {
public:
    NearWalk(const MovingPair& pair, const PairMoment& moment, double reach, double span, ImpactScratch& scratch,
             Visit& visit)
        : pair_(pair), moment_(moment), reach_(reach + pair.radii), span_(span), scratch_(scratch), visit_(visit) {
        bend_ = span * (0.5 * pair.bound.acceleration * span + pair.bound.velocity_error);
        if (pair.b.is_plane()) {
            add_axis(pair.plane_normal(moment));
            return;
        }
        for (int k = 0; k < 3; ++k) add_axis(Vec3::Unit(k));
        if (!pair.b.is_point())
            for (int k = 0; k < 3; ++k) add_axis(moment.b_to_a.rotation.col(k));
    }

    void run() {
        if (pair_.a.empty() || pair_.b.empty()) return;
        auto& stack = scratch_.stack;
        stack.assign(1, {0, 0});
        while (!stack.empty()) {
            const auto [i, j] = stack.back();
            stack.pop_back();
            const HierarchyNode &a = pair_.a.node(i), &b = pair_.b.node(j);
            if (stays_away(a, b)) continue;
            if (a.is_leaf() && b.is_leaf()) {
                if (!visit_leaves(a, b)) return;
            } else if (b.is_leaf() || (!a.is_leaf() && a.half.squaredNorm() > b.half.squaredNorm())) {
                stack.emplace_back(a.first + 1, j);
                stack.emplace_back(a.first, j);
            } else {
                stack.emplace_back(i, b.first + 1);
                stack.emplace_back(i, b.first);
            }
        }
    }

private:
    void add_axis(const Vec3& n) {
        SweepAxis& axis = axes_[axis_count_++];
        const Mat3 to_b = moment_.b_to_a.rotation.transpose();
        axis.direction = n;
        axis.on_a = n.cwiseAbs();
        axis.on_b = (to_b * n).cwiseAbs();
        axis.turn_a = n.cross(moment_.angular_a).cwiseAbs();
        axis.turn_b = (to_b * n.cross(moment_.angular_b)).cwiseAbs();
    }

    // Both the gap now and the gap at the end of the span are wide enough, and in between it is concave in time.
    bool stays_away(const HierarchyNode& a, const HierarchyNode& b) const {
        const Vec3 center_a = a.center.template cast<double>(), half_a = a.half.template cast<double>();
        const Vec3 half_b = b.half.template cast<double>();
        const Vec3 center_b = moment_.b_to_a * b.center.template cast<double>();
        const Vec3 between = center_b - center_a;
        const Vec3 velocity = moment_.velocity_b(center_b) - moment_.velocity_a(center_a);
        for (int k = 0; k < axis_count_; ++k) {
            const SweepAxis& axis = axes_[k];
            const double along = axis.direction.dot(between);
            const bool one_sided = pair_.b.is_plane();
            const double gap =
                (one_sided ? along : std::abs(along)) - axis.on_a.dot(half_a) - axis.on_b.dot(half_b) - reach_;
            if (!(gap > 0)) continue;
            const double speed =
                axis.direction.dot(velocity) * (along < 0 ? -1 : 1) - axis.turn_a.dot(half_a) - axis.turn_b.dot(half_b);
            if (gap + span_ * speed - bend_ > 0) return true;
        }
        return false;
    }

    bool visit_leaves(const HierarchyNode& a, const HierarchyNode& b) {
        for (std::uint32_t i = a.first; i < a.first + a.count; ++i)
            for (std::uint32_t j = b.first; j < b.first + b.count; ++j)
                if (!visit_(pair_.a.feature_at(i), pair_.b.feature_at(j))) return false;
        return true;
    }

    const MovingPair& pair_;
    const PairMoment& moment_;
    double reach_, span_, bend_ = 0;
    ImpactScratch& scratch_;
    Visit& visit_;
    std::array<SweepAxis, 6> axes_;
    int axis_count_ = 0;
};

template <class Visit>
void visit_near(const MovingPair& pair, const PairMoment& moment, double reach, double span, ImpactScratch& scratch,
                Visit&& visit) {
    NearWalk<std::remove_reference_t<Visit>>(pair, moment, reach, span, scratch, visit).run();
}

}  // namespace kolize
