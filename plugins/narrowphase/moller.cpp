// Triangle-triangle test by planes and intervals.
//
// Each triangle meets the other's plane in an interval of the line in which the two planes cross; the triangles
// intersect exactly when both intervals exist and overlap. In double a plane that has the other triangle certainly on
// one side rejects most pairs at once; which intervals overlap is left to kolize/predicates.h, coplanar triangles too.
// In float, for comparison, plain arithmetic decides throughout, on corners relative to the first one of the pair;
// only what it takes for coplanar goes to the predicates.
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin.h>
#include <kolize/predicates.h>

#include <algorithm>

namespace {

using namespace kolize;

template <class Real>
using Point = Eigen::Matrix<Real, 3, 1>;

// Where a triangle meets the line: parameters along it, and the points.
template <class Real>
struct Interval {
    Real from, to;
    Point<Real> first, last;
};

template <class Real>
struct Plane {
    Point<Real> normal;
    Point<Real> origin;
    Point<Real> extent;  // largest coordinates of the sides, seen from the origin
    explicit Plane(const Point<Real> (&t)[3]) : origin(t[0]) {
        const Point<Real> u = t[1] - t[0], v = t[2] - t[0];
        normal = u.cross(v);
        extent = u.cwiseAbs().cwiseMax(v.cwiseAbs());
    }
    Real height(const Point<Real>& p) const { return normal.dot(p - origin); }

    // Whether the triangle lies on one side, beyond doubt. A height is the determinant of three differences. Each of
    // its six products is wrong by eight roundings at most and no larger than the product of the largest coordinates;
    // underflow adds less than the second term of the bound.
    bool separates(const Vec3 (&t)[3]) const {
        constexpr double rounding = 49 * 0x1p-53, underflow = 1e-300, may_overflow = 1e100;
        Vec3 largest = extent;
        for (const Vec3& p : t) largest = largest.cwiseMax((p - origin).cwiseAbs());
        if (!(largest.maxCoeff() < may_overflow)) return false;
        const double bound = rounding * largest.prod() + underflow * (1 + largest.sum());
        const double h[3] = {height(t[0]), height(t[1]), height(t[2])};
        return std::min({h[0], h[1], h[2]}) > bound || std::max({h[0], h[1], h[2]}) < -bound;
    }
};

// Two triangles, each with its corners' heights over the other's plane.
template <class Real>
struct Crossing {
    using Corners = Point<Real>[3];
    const Corners &a, &b;
    const Plane<Real>&plane_a, &plane_b;
    Real of_a[3] = {plane_b.height(a[0]), plane_b.height(a[1]), plane_b.height(a[2])};
    Real of_b[3] = {plane_a.height(b[0]), plane_a.height(b[1]), plane_a.height(b[2])};

    bool apart() const { return on_one_side(of_a) || on_one_side(of_b); }
    bool in_one_plane() const { return all_zero(of_a) || all_zero(of_b); }

    // Both intervals, along the planes' common line.
    std::pair<Interval<Real>, Interval<Real>> intervals() const {
        const Point<Real> line = plane_a.normal.cross(plane_b.normal);
        return {interval_on(a, of_a, line), interval_on(b, of_b, line)};
    }

private:
    static bool on_one_side(const Real (&h)[3]) {
        return std::min({h[0], h[1], h[2]}) > 0 || std::max({h[0], h[1], h[2]}) < 0;
    }
    static bool all_zero(const Real (&h)[3]) { return h[0] == 0 && h[1] == 0 && h[2] == 0; }

    // The part of the triangle in the plane over which its corners have the heights h, measured along `line`.
    static Interval<Real> interval_on(const Corners& t, const Real (&h)[3], const Point<Real>& line) {
        constexpr Real beyond = std::numeric_limits<Real>::infinity();
        Interval<Real> found{beyond, -beyond, t[0], t[0]};
        const auto add = [&](const Point<Real>& p) {
            const Real s = line.dot(p);
            if (s < found.from) found.from = s, found.first = p;
            if (s > found.to) found.to = s, found.last = p;
        };
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            if (h[i] == 0) add(t[i]);
            if ((h[i] > 0 && h[j] < 0) || (h[i] < 0 && h[j] > 0)) add(t[i] + (t[j] - t[i]) * (h[i] / (h[i] - h[j])));
        }
        return found;
    }
};

// Where on the common line both triangles are.
template <class Real>
TriangleSegment common_part(const Interval<Real>& a, const Interval<Real>& b) {
    const Point<Real>&p = a.from > b.from ? a.first : b.first, &q = a.to < b.to ? a.last : b.last;
    return {p.template cast<double>(), q.template cast<double>()};
}

bool intersect_in_double(const TrianglePair& pair, TriangleSegment* segment) {
    const Plane<double> plane_b(pair.b);
    if (plane_b.separates(pair.a)) return false;
    const Plane<double> plane_a(pair.a);
    if (plane_a.separates(pair.b)) return false;
    if (!triangles_intersect(pair.a, pair.b)) return false;
    if (!segment) return true;
    const Crossing<double> crossing{pair.a, pair.b, plane_a, plane_b};
    const auto [a, b] = crossing.intervals();
    *segment = crossing.in_one_plane() ? TriangleSegment{pair.a[0], pair.a[0]} : common_part(a, b);
    return true;
}

bool intersect_in_float(const TrianglePair& pair, TriangleSegment* segment) {
    const Vec3& origin = pair.a[0];
    TrianglePair narrowed;
    Point<float> a[3], b[3];
    for (int k = 0; k < 3; ++k) {
        a[k] = (pair.a[k] - origin).cast<float>();
        b[k] = (pair.b[k] - origin).cast<float>();
        narrowed.a[k] = a[k].cast<double>();
        narrowed.b[k] = b[k].cast<double>();
    }
    const Plane<float> plane_a(a), plane_b(b);
    const Crossing<float> crossing{a, b, plane_a, plane_b};
    if (crossing.apart()) return false;
    if (crossing.in_one_plane()) {
        if (segment) *segment = {origin, origin};
        return triangles_intersect(narrowed.a, narrowed.b);
    }
    const auto [on_a, on_b] = crossing.intervals();
    if (on_a.from > on_b.to || on_b.from > on_a.to) return false;
    if (!segment) return true;
    *segment = common_part(on_a, on_b);
    segment->p += origin;
    segment->q += origin;
    return true;
}

class Moller final : public TriangleNarrowphase {
public:
    static void parameters(Parameters<Moller>& p) {
        mesh_parameters<Moller>(p);
        p.add("precision", &Moller::precision_)
            .choices({"double", "float"})
            .doc("Arithmetic of the test: double, with exact decisions, or plain float.");
    }

    void attach(Host& host) override {
        TriangleNarrowphase::attach(host);
        intersect_ = precision_ == "float" ? intersect_in_float : intersect_in_double;
    }

private:
    void intersect_triangles(std::span<const TrianglePair> pairs, std::span<std::uint8_t> hit,
                             std::span<TriangleSegment> segments) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i)
            hit[i] = intersect_(pairs[i], segments.empty() ? nullptr : &segments[i]);
    }

    std::string precision_ = "double";
    bool (*intersect_)(const TrianglePair&, TriangleSegment*) = nullptr;
};

}  // namespace

KOLIZE_PLUGIN(
    Moller, .name = "moller",
    .summary = "triangle-triangle test by intervals on the planes' common line, exact in double",
    .source = "Moller, Journal of Graphics Tools 2(2), 1997",
    .cost = "A plane and three heights for a pair that the first plane separates; up to eight determinants for a hit.",
    .accuracy =
        "Double: exact for the corners as they come; triangles are closed, so that a touch counts. Float: wrong "
        "where triangles touch, share an edge, are slivers or nearly coplanar (docs/accuracy.md). Segments, "
        "which the contact model averaged uses, are computed in plain arithmetic.",
    .choose = "When meshes collide: with the contact model contour it is the default of this project.",
    .capabilities = {.shape_kinds = all_shape_kinds | bit(ShapeKind::capsule),
                     .time_of_impact = true,
                     .exact = true,
                     .crossings = true})
