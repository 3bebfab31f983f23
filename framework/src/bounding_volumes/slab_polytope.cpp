#include "bounding_volumes/local_points.h"
#include "bounding_volumes/slab_reach.h"

#include <kolize/bounding_volumes.h>
#include <kolize/error.h>

#include <algorithm>
#include <string>

namespace kolize {

namespace {

// The points p with normal . p <= offset; the normal is a unit vector.
struct HalfSpace {
    Vec3 normal;
    double offset;

    double height(const Vec3& p) const { return normal.dot(p) - offset; }
};

using Polygon = std::vector<Vec3>;  // counter-clockwise seen from outside

// The point of an edge at height 0. It depends on the ends only, so that both faces of the edge get the same bits.
Vec3 crossing(const Vec3& inside, const Vec3& outside, const HalfSpace& space) {
    const double from = space.height(inside), to = space.height(outside);
    return inside + (outside - inside) * (from / (from - to));
}

// Keeps the part in the half-space (Sutherland & Hodgman 1974) and adds the ends of the cut to the rim.
Polygon clip(const Polygon& polygon, const HalfSpace& space, Polygon& rim) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3& p = polygon[i];
        const Vec3& q = polygon[(i + 1) % polygon.size()];
        const bool p_inside = space.height(p) <= 0, q_inside = space.height(q) <= 0;
        if (p_inside) kept.push_back(p);
        if (p_inside == q_inside) continue;
        kept.push_back(p_inside ? crossing(p, q, space) : crossing(q, p, space));
        rim.push_back(kept.back());
    }
    return kept;
}

// The corners of a convex face in their order round the normal.
Polygon face_within(Polygon rim, const Vec3& normal) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : rim) middle += p / static_cast<double>(rim.size());
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const auto angle = [&](const Vec3& p) { return std::atan2(v.dot(p - middle), u.dot(p - middle)); };
    std::sort(rim.begin(), rim.end(), [&](const Vec3& p, const Vec3& q) { return angle(p) < angle(q); });
    return rim;
}

// Cuts a convex polyhedron. Nothing is decided by a tolerance: a plane that passes through an edge or a vertex may or
// may not cut off a sliver, but faces that share a corner agree about it, and the surface stays closed.
void cut(std::vector<Polygon>& faces, const HalfSpace& space) {
    Polygon rim;
    for (Polygon& face : faces) face = clip(face, space, rim);
    faces.push_back(face_within(std::move(rim), space.normal));
    std::erase_if(faces, [](const Polygon& face) { return face.size() < 3; });
}

// The cube from -1 to 1.
std::vector<Polygon> cube() {
    std::vector<Polygon> faces;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const Vec3 normal = side * Vec3::Unit(axis), u = Vec3::Unit((axis + 1) % 3), v = normal.cross(u);
            faces.push_back({normal - u - v, normal + u - v, normal + u + v, normal - u + v});
        }
    return faces;
}

// By the divergence theorem: pyramids from the origin to the faces, negative where a face looks towards it.
double volume_within(const std::vector<Polygon>& faces) {
    double sum = 0;
    for (const Polygon& face : faces)
        for (std::size_t i = 2; i < face.size(); ++i)
            sum += face[0].dot((face[i - 1] - face[0]).cross(face[i] - face[0]));
    return std::max(sum / 6, 0.0);
}

}  // namespace

SlabPolytope slab_polytope(std::span<const Vec3> points, int planes) {
    if (planes != 6 && planes != 18 && planes != 26)
        throw Error("a slab polytope has 6, 18 or 26 planes, not " + std::to_string(planes));
    require_points(points);
    SlabPolytope polytope;
    for (int i = 0; i < planes / 2; ++i) {
        const Vec3 direction = slab_direction(i);
        double minimum = infinity, maximum = -infinity;
        for (const Vec3& p : points) {
            minimum = std::min(minimum, direction.dot(p));
            maximum = std::max(maximum, direction.dot(p));
        }
        polytope.directions.push_back(direction);
        polytope.minima.push_back(minimum);
        polytope.maxima.push_back(maximum);
    }
    return polytope;
}

// The first three slabs are the box along the axes, and the others cut it. All is stretched until that box is the cube
// from -1 to 1, so that the volume of a needle is as exact as any.
double SlabPolytope::volume() const {
    const Vec3 min(minima[0], minima[1], minima[2]), max(maxima[0], maxima[1], maxima[2]);
    const Vec3 center = 0.5 * (min + max), half = 0.5 * (max - min);
    if (half.minCoeff() <= 0) return 0;
    const double scale = half.maxCoeff();
    std::vector<Polygon> faces = cube();
    for (std::size_t i = 3; i < directions.size(); ++i) {
        const Vec3 normal = directions[i].cwiseProduct(half / scale);
        const double length = normal.norm(), middle = directions[i].dot(center);
        cut(faces, {normal / length, (maxima[i] - middle) / scale / length});
        cut(faces, {-normal / length, (middle - minima[i]) / scale / length});
    }
    return half.prod() * volume_within(faces);
}

}  // namespace kolize
