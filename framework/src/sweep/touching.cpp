#include "sweep/touching.h"

#include <algorithm>

namespace kolize {

namespace {

constexpr double same_place = 1e-9;  // share of the bodies' size

// The corners of a feature that lie in the plane of contact, in the view along its normal.
struct Support {
    std::array<Vec3, 3> points;
    int count = 0;
};

Support support(const ConvexFeature& feature, const Vec3& outward, double depth) {
    double farthest = -infinity;
    for (int i = 0; i < feature.count; ++i) farthest = std::max(farthest, outward.dot(feature.corners[i]));
    Support result;
    for (int i = 0; i < feature.count; ++i)
        if (outward.dot(feature.corners[i]) >= farthest - depth) result.points[result.count++] = feature.corners[i];
    return result;
}

class TouchingSearch {
public:
    TouchingSearch(const MovingPair& pair, const PairMoment& moment, double reach, std::vector<TouchingPoint>& points)
        : pair_(pair), moment_(moment), points_(points), first_(points.size()), reach_(reach) {
        near_ = same_place * (pair.a.reach + pair.b.reach + pair.radii);
    }

    void visit(const ConvexFeature& fa, const ConvexFeature& fb) {
        const FeatureGap gap = pair_.gap(moment_, fa, fb);
        width_ = gap.projected - pair_.radii;
        if (!(width_ > -pair_.touch && width_ <= reach_)) return;
        normal_ = gap.normal;
        if (fa.count == 1 || (!pair_.b.is_plane() && fb.count == 1)) {
            add(gap.on_a + (pair_.a.radius + 0.5 * width_) * normal_, width_);
            return;
        }
        surface_a_ = -infinity;
        for (int i = 0; i < fa.count; ++i) surface_a_ = std::max(surface_a_, normal_.dot(fa.corners[i]));
        // What touches, and then what nearly lies in the plane of contact: with that the nearest points alone could be
        // taken for the corners of an area.
        const double touching = 4 * pair_.touch;
        if (width_ <= touching) add_points(fa, fb, gap, touching);
        if (reach_ > touching) add_points(fa, fb, gap, reach_);
    }

private:
    void add_points(const ConvexFeature& fa, const ConvexFeature& fb, const FeatureGap& gap, double depth) {
        const Support a = support(fa, normal_, depth);
        if (pair_.b.is_plane() || a.count == 1) {
            for (int i = 0; i < a.count; ++i) add_corner_of_a(a.points[i]);
            return;
        }
        const Support b = support(fb, -normal_, depth);
        if (b.count == 1)
            add_corner_of_b(b.points[0]);
        else if (!add_shared_area(a, b))
            add(gap.on_a + (pair_.a.radius + 0.5 * width_) * normal_, width_);
    }

    void add(const Vec3& point, double width) {
        if (!(width <= reach_)) return;
        const double gap = width <= 4 * pair_.touch ? 0 : width;
        for (std::size_t i = first_; i < points_.size(); ++i)
            if ((points_[i].point - point).norm() <= near_ && (points_[i].normal - normal_).norm() <= same_place) {
                points_[i].gap = std::min(points_[i].gap, gap);
                return;
            }
        points_.push_back({point, normal_, gap});
    }
    // The other surface is no nearer than its foremost point.
    void add_corner_of_a(const Vec3& point) {
        add(point + pair_.a.radius * normal_, surface_a_ + width_ - normal_.dot(point));
    }
    void add_corner_of_b(const Vec3& point) {
        add(point - pair_.b.radius * normal_, normal_.dot(point) - surface_a_ - pair_.radii);
    }

    // Signed area of (p, q, r) in the view along the normal, times two.
    double turn(const Vec3& p, const Vec3& q, const Vec3& r) const { return normal_.dot((q - p).cross(r - p)); }

    bool covers(const Support& s, const Vec3& p) const {
        if (s.count == 2) {
            const Vec3 d = s.points[1] - s.points[0];
            const double along = d.dot(p - s.points[0]), length = d.norm();
            return std::abs(turn(s.points[0], s.points[1], p)) <= near_ * length && along >= -near_ * length &&
                   along <= (length + near_) * length;
        }
        double low = infinity, high = -infinity;
        for (int k = 0; k < 3; ++k) {
            const Vec3 &u = s.points[k], &v = s.points[(k + 1) % 3];
            const double side = turn(u, v, p) / std::max((v - u).norm(), std::numeric_limits<double>::min());
            low = std::min(low, side);
            high = std::max(high, side);
        }
        return low >= -near_ || high <= near_;
    }

    bool add_shared_area(const Support& a, const Support& b) {
        bool any = false;
        for (int i = 0; i < a.count; ++i)
            if (covers(b, a.points[i])) any = true, add_corner_of_a(a.points[i]);
        for (int j = 0; j < b.count; ++j)
            if (covers(a, b.points[j])) any = true, add_corner_of_b(b.points[j]);
        for (int i = 0; i < (a.count == 2 ? 1 : 3); ++i)
            for (int j = 0; j < (b.count == 2 ? 1 : 3); ++j)
                if (add_crossing(a.points[i], a.points[(i + 1) % a.count], b.points[j], b.points[(j + 1) % b.count]))
                    any = true;
        return any;
    }

    bool add_crossing(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
        const double at_p = turn(r, s, p), at_q = turn(r, s, q), at_r = turn(p, q, r), at_s = turn(p, q, s);
        const bool across = (at_p > 0) != (at_q > 0) && (at_r > 0) != (at_s > 0);
        if (!across || at_p == at_q) return false;
        add(p + (at_p / (at_p - at_q)) * (q - p) + pair_.a.radius * normal_, width_);
        return true;
    }

    const MovingPair& pair_;
    const PairMoment& moment_;
    std::vector<TouchingPoint>& points_;
    std::size_t first_;
    double reach_, near_;
    Vec3 normal_ = Vec3::Zero();
    double width_ = 0;      // m, of the gap between the features at hand
    double surface_a_ = 0;  // where the foremost point of A's feature is, along the normal
};

}  // namespace

void find_touching_points(const MovingPair& pair, const PairMoment& moment, double reach, ImpactScratch& scratch,
                          std::vector<TouchingPoint>& points) {
    reach = std::max(reach, 4 * pair.touch);
    TouchingSearch search(pair, moment, reach, points);
    visit_near(pair, moment, reach, 0, scratch, [&](std::uint32_t a, std::uint32_t b) {
        ConvexFeature fb;
        if (!pair.b.is_plane()) fb = pair.b.feature(b);
        for (Vec3& corner : fb.corners) corner = moment.b_to_a * corner;
        search.visit(pair.a.feature(a), fb);
        return true;
    });
}

}  // namespace kolize
