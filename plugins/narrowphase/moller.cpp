// Triangle-triangle test by planes and intervals, with exact answers.
//
// Each triangle meets the other's plane in an interval of the line in which the two planes cross; the triangles
// intersect exactly when both intervals exist and overlap. A plane that has the other triangle certainly on one side
// rejects most pairs at once; which intervals overlap is left to kolize/predicates.h, coplanar triangles too.
//
// Source:   T. Moller, "A fast triangle-triangle intersection test", Journal of Graphics Tools 2(2), 1997.
// Cost:     a plane and three distances for a pair that the first plane separates; eight determinants for a hit.
// Accuracy: exact for the corners as they come; triangles are closed, so that a touch counts. The segment, which the
//           contact model `averaged` uses, is computed in double.
// Choose it when meshes collide: with the contact model `contour` it is the default of this project.
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin.h>
#include <kolize/predicates.h>

#include <algorithm>

namespace {

using namespace kolize;

// Where a triangle meets the line: parameters along it, and the points.
struct Interval {
    double from = 0, to = 0;
    Vec3 first, last;
};

struct Plane {
    Vec3 normal;
    Vec3 origin;
    Vec3 extent;  // largest coordinates of the sides, seen from the origin
    explicit Plane(const Vec3 (&t)[3]) : origin(t[0]) {
        const Vec3 u = t[1] - t[0], v = t[2] - t[0];
        normal = u.cross(v);
        extent = u.cwiseAbs().cwiseMax(v.cwiseAbs());
    }
    double height(const Vec3& p) const { return normal.dot(p - origin); }

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

// The part of the triangle in the plane over which its corners have the heights h, measured along `line`.
Interval interval_on(const Vec3 (&t)[3], const double (&h)[3], const Vec3& line) {
    Interval found{infinity, -infinity, t[0], t[0]};
    const auto add = [&](const Vec3& p) {
        const double s = line.dot(p);
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

// Where on the common line both triangles are, by the heights of each over the other's plane.
TriangleSegment common_segment(const TrianglePair& pair, const Plane& plane_a, const Plane& plane_b) {
    const double ha[3] = {plane_b.height(pair.a[0]), plane_b.height(pair.a[1]), plane_b.height(pair.a[2])};
    const double hb[3] = {plane_a.height(pair.b[0]), plane_a.height(pair.b[1]), plane_a.height(pair.b[2])};
    if (ha[0] == 0 && ha[1] == 0 && ha[2] == 0) return {pair.a[0], pair.a[0]};
    const Vec3 line = plane_a.normal.cross(plane_b.normal);
    const Interval a = interval_on(pair.a, ha, line), b = interval_on(pair.b, hb, line);
    return {a.from > b.from ? a.first : b.first, a.to < b.to ? a.last : b.last};
}

bool intersect(const TrianglePair& pair, TriangleSegment* segment) {
    const Plane plane_b(pair.b);
    if (plane_b.separates(pair.a)) return false;
    const Plane plane_a(pair.a);
    if (plane_a.separates(pair.b)) return false;
    if (!triangles_intersect(pair.a, pair.b)) return false;
    if (segment) *segment = common_segment(pair, plane_a, plane_b);
    return true;
}

class Moller final : public TriangleNarrowphase {
public:
    static void parameters(Parameters<Moller>& p) { mesh_parameters<Moller>(p); }

private:
    void intersect_triangles(std::span<const TrianglePair> pairs, std::span<std::uint8_t> hit,
                             std::span<TriangleSegment> segments) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i)
            hit[i] = intersect(pairs[i], segments.empty() ? nullptr : &segments[i]);
    }
};

}  // namespace

KOLIZE_PLUGIN(Moller, .name = "moller",
              .summary = "exact triangle-triangle test by intervals on the planes' common line",
              .source = "Moller, Journal of Graphics Tools 2(2), 1997", .capabilities = {.time_of_impact = true, .crossings = true})
