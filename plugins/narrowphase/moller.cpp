// Triangle-triangle test by intervals on the common line of the two planes.
//
// Each triangle meets the other's plane in an interval of the line in which the two planes cross; the triangles
// intersect exactly when both intervals exist and overlap. Coplanar triangles are compared edge by edge in their plane.
//
// Source:   T. Moller, "A fast triangle-triangle intersection test", Journal of Graphics Tools 2(2), 1997.
// Cost:     two planes, six distances and at most four divisions; a pair that the first plane separates ends after three.
// Accuracy: double, no epsilon: right for triangles in general position, undecided within rounding of a touch.
// Choose it when meshes collide: with the contact model `contour` it is the default of this project.
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin.h>

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
    explicit Plane(const Vec3 (&t)[3]) : normal((t[1] - t[0]).cross(t[2] - t[0])), origin(t[0]) {}
    double height(const Vec3& p) const { return normal.dot(p - origin); }
};

bool same_side(const double (&h)[3]) {
    return (h[0] > 0 && h[1] > 0 && h[2] > 0) || (h[0] < 0 && h[1] < 0 && h[2] < 0);
}

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

// Signed area of (p, q, r) seen along `axis`, times two.
double turn(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& axis) { return axis.dot((q - p).cross(r - p)); }

bool edges_cross(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, const Vec3& axis) {
    const double a = turn(p, q, r, axis), b = turn(p, q, s, axis), c = turn(r, s, p, axis), d = turn(r, s, q, axis);
    const bool across = (a <= 0 && b >= 0) || (a >= 0 && b <= 0);
    return across && ((c <= 0 && d >= 0) || (c >= 0 && d <= 0)) && !(a == 0 && b == 0 && c == 0 && d == 0);
}

bool contains(const Vec3 (&t)[3], const Vec3& p, const Vec3& axis) {
    const double a = turn(t[0], t[1], p, axis), b = turn(t[1], t[2], p, axis), c = turn(t[2], t[0], p, axis);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

bool coplanar_overlap(const TrianglePair& pair, const Vec3& axis) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (edges_cross(pair.a[i], pair.a[(i + 1) % 3], pair.b[j], pair.b[(j + 1) % 3], axis)) return true;
    for (int k = 0; k < 3; ++k)
        if (contains(pair.a, pair.b[k], axis) || contains(pair.b, pair.a[k], axis)) return true;
    return false;
}

bool intersect(const TrianglePair& pair, TriangleSegment* segment) {
    const Plane plane_b(pair.b);
    const double ha[3] = {plane_b.height(pair.a[0]), plane_b.height(pair.a[1]), plane_b.height(pair.a[2])};
    if (same_side(ha)) return false;
    const Plane plane_a(pair.a);
    const double hb[3] = {plane_a.height(pair.b[0]), plane_a.height(pair.b[1]), plane_a.height(pair.b[2])};
    if (same_side(hb)) return false;
    if (ha[0] == 0 && ha[1] == 0 && ha[2] == 0) {
        const bool hit = coplanar_overlap(pair, plane_a.normal);
        if (hit && segment) *segment = {pair.a[0], pair.a[0]};
        return hit;
    }
    const Vec3 line = plane_a.normal.cross(plane_b.normal);
    const Interval a = interval_on(pair.a, ha, line), b = interval_on(pair.b, hb, line);
    if (!(a.from <= b.to && b.from <= a.to)) return false;
    if (segment) *segment = {a.from > b.from ? a.first : b.first, a.to < b.to ? a.last : b.last};
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

KOLIZE_PLUGIN(Moller, .name = "moller", .summary = "triangle-triangle test by intervals on the planes' common line",
              .source = "Moller, Journal of Graphics Tools 2(2), 1997")
