#include "sweep/convex_gap.h"

#include <algorithm>

namespace kolize {

namespace {

using Tie = FeatureGap::Tie;

// Shares of the features' size and distance.
constexpr double rounding = 1e-15;
constexpr double direction_lost = 1e-12;    // nearer than that the line between nearest points says nothing
constexpr double direction_blurred = 1e-7;  // nearer than that it is worse than the direction of a face

struct SegmentPoints {
    double s = 0, t = 0;  // along the segments, 0..1
};

// Ericson 2005, 5.1.9.
SegmentPoints nearest_on_segments(const Vec3& p, const Vec3& d, const Vec3& q, const Vec3& e) {
    const Vec3 r = p - q;
    const double dd = d.squaredNorm(), ee = e.squaredNorm(), er = e.dot(r);
    if (dd == 0 && ee == 0) return {};
    if (dd == 0) return {0, std::clamp(er / ee, 0.0, 1.0)};
    const double dr = d.dot(r);
    if (ee == 0) return {std::clamp(-dr / dd, 0.0, 1.0), 0};
    const double de = d.dot(e), determinant = dd * ee - de * de;
    double s = determinant > 0 ? std::clamp((de * er - dr * ee) / determinant, 0.0, 1.0) : 0;
    double t = (de * s + er) / ee;
    if (t < 0) {
        t = 0;
        s = std::clamp(-dr / dd, 0.0, 1.0);
    } else if (t > 1) {
        t = 1;
        s = std::clamp((de - dr) / dd, 0.0, 1.0);
    }
    return {s, t};
}

bool is_inner(double s) { return s > 0 && s < 1; }

class GapSearch {
public:
    GapSearch(const ConvexFeature& a, const ConvexFeature& b) : a_(a), b_(b), size_(size()) {}

    FeatureGap run() {
        for (int i = 0; i < a_.edges(); ++i)
            for (int j = 0; j < b_.edges(); ++j) try_edges(i, j);
        if (b_.count == 3)
            for (int i = 0; i < a_.count; ++i) try_corner_over_face(a_.corners[i], b_, true);
        if (a_.count == 3)
            for (int j = 0; j < b_.count; ++j) try_corner_over_face(b_.corners[j], a_, false);
        best_.distance = (best_.on_b - best_.on_a).norm();
        if (best_.distance > 0 && best_.tie_count < 2) best_.normal = (best_.on_b - best_.on_a) / best_.distance;
        const bool lost = best_.distance < direction_lost * size_;
        best_.projected = lost ? -infinity : projected_gap(a_, b_, best_.normal);
        // Between nearest points stands a plane that shows their distance. Where it does not, as when the foot of a
        // corner is next to an edge, the points are not quite the nearest.
        if (best_.distance < direction_blurred * size_ || best_.projected < 0.5 * best_.distance) look_along_features();
        return best_;
    }

private:
    double size() const {
        return (a_.corners[0] - b_.corners[0]).norm() + (a_.count > 1 ? a_.edge(0).norm() + a_.edge(1).norm() : 0.0) +
               (b_.count > 1 ? b_.edge(0).norm() + b_.edge(1).norm() : 0.0);
    }

    void take(double squared, const Vec3& on_a, const Vec3& on_b) {
        best_squared_ = squared;
        best_.on_a = on_a;
        best_.on_b = on_b;
        best_.tie_count = 0;
    }

    void tie(const Vec3& direction, bool of_a) { best_.ties[best_.tie_count++] = {direction, of_a}; }

    void try_edges(int i, int j) {
        const Vec3 d = a_.count > 1 ? a_.edge(i) : Vec3::Zero(), e = b_.count > 1 ? b_.edge(j) : Vec3::Zero();
        const auto [s, t] = nearest_on_segments(a_.corners[i], d, b_.corners[j], e);
        const Vec3 p = a_.corners[i] + s * d, q = b_.corners[j] + t * e;
        const double squared = (q - p).squaredNorm();
        if (!(squared < best_squared_)) return;
        take(squared, p, q);
        if (is_inner(s)) tie(d, true);
        if (is_inner(t)) tie(e, false);
        if (best_.tie_count == 2) set_normal(d.cross(e));
    }

    void try_corner_over_face(const Vec3& p, const ConvexFeature& face, bool face_is_b) {
        const Vec3 n = face.edge(0).cross(-face.edge(2));
        const double squared = n.squaredNorm();
        if (squared == 0) return;
        const double height = n.dot(p - face.corners[0]);
        if (!(height * height < best_squared_ * squared)) return;
        for (int k = 0; k < 3; ++k)
            if (!(n.dot(face.edge(k).cross(p - face.corners[k])) > 0)) return;
        const Vec3 foot = p - (height / squared) * n;
        take(height * height / squared, face_is_b ? p : foot, face_is_b ? foot : p);
        tie(face.edge(0), !face_is_b);
        tie(face.edge(1), !face_is_b);
        set_normal(face_is_b ? Vec3(-n) : n);
    }

    // Of the direction of `along`, or of the nearest points if that is too short to tell.
    void set_normal(const Vec3& along) {
        const double length = along.norm();
        const double needed = 1e-12 * best_.ties[0].direction.norm() * best_.ties[1].direction.norm();
        if (!(length > needed)) {
            best_.tie_count = 1;
            return;
        }
        best_.normal = oriented(along / length);
    }

    // The side on which B lies as a whole. Where rounding hides it, faces know it by their orientation.
    Vec3 oriented(const Vec3& unit) const {
        Vec3 from = Vec3::Zero(), to = Vec3::Zero();
        for (int i = 0; i < a_.count; ++i) from += a_.corners[i] / a_.count;
        for (int j = 0; j < b_.count; ++j) to += b_.corners[j] / b_.count;
        return unit.dot(to - from) < -rounding * size_ ? Vec3(-unit) : unit;
    }

    // Separating axes of two triangles; the one that shows the widest gap. Faces come first, outward: of two axes that
    // show the same to rounding, as those of coplanar triangles do, the first is taken.
    void look_along_features() {
        if (a_.count == 3) try_plane({a_.edge(0), true}, {a_.edge(1), true}, 1);
        if (b_.count == 3) try_plane({b_.edge(0), false}, {b_.edge(1), false}, -1);
        if (a_.count > 1 && b_.count > 1)
            for (int i = 0; i < a_.edges(); ++i)
                for (int j = 0; j < b_.edges(); ++j) try_plane({a_.edge(i), true}, {b_.edge(j), false}, 1);
    }

    void try_plane(const Tie& first, const Tie& second, double first_sign) {
        const Vec3 along = first.direction.cross(second.direction);
        const double length = along.norm();
        if (!(length > 1e-9 * first.direction.norm() * second.direction.norm())) return;
        for (const double sign : {first_sign, -first_sign}) {
            const Vec3 normal = (sign / length) * along;
            const double projected = projected_gap(a_, b_, normal);
            if (!(projected > best_.projected + rounding * size_)) continue;
            best_.projected = projected;
            best_.normal = normal;
            best_.ties = {first, second};
            best_.tie_count = 2;
        }
    }

    const ConvexFeature &a_, &b_;
    double size_;
    FeatureGap best_;
    double best_squared_ = infinity;
};

}  // namespace

double projected_gap(const ConvexFeature& a, const ConvexFeature& b, const Vec3& normal) {
    double low = infinity;
    for (int i = 0; i < a.count; ++i)
        for (int j = 0; j < b.count; ++j) low = std::min(low, normal.dot(b.corners[j] - a.corners[i]));
    return low;
}

FeatureGap gap_between(const ConvexFeature& a, const ConvexFeature& b) { return GapSearch(a, b).run(); }

}  // namespace kolize
