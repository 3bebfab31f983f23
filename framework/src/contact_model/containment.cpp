#include "contact_model/containment.h"

#include <algorithm>

namespace kolize {

namespace {

bool bounds_hold(const Mesh& outer, const Mesh& inner, const Transform& to_outer) {
    const Aabb& box = outer.bounds;
    return std::all_of(inner.vertices.begin(), inner.vertices.end(), [&](const Vec3& v) {
        const Vec3 p = to_outer * v;
        return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
    });
}

// A vertex on the outer surface does not tell; where all are, the surfaces are the same.
bool is_inside(const Mesh& outer, const Mesh& inner, const Transform& to_outer, MeshScratch& scratch) {
    for (const Vec3& v : inner.vertices) {
        const NearestPoint nearest = nearest_on_mesh(outer, to_outer * v, scratch);
        if (nearest.at.distance > 0) return nearest.height < 0;
    }
    return false;
}

// The way out for the inner solid, in the outer one's frame: the normal points outward.
ContactRegion way_out(const Mesh& outer, const Mesh& inner, const Transform& to_outer, MeshScratch& scratch) {
    Vec3 start = to_outer * inner.bounds.center();
    NearestPoint nearest = nearest_on_mesh(outer, start, scratch);
    if (nearest.height >= 0) {  // the centre of the box may lie outside both solids
        start = to_outer * inner.vertices.front();
        nearest = nearest_on_mesh(outer, start, scratch);
    }
    const Vec3& exit = nearest.at.point;
    const Vec3 straight = exit - start;
    const bool on_face = nearest.at.feature == SurfacePoint::Feature::face;
    const Vec3 normal = on_face || straight.isZero(0) ? nearest.outward : Vec3(straight.normalized());
    double lowest = infinity;
    for (const Vec3& v : inner.vertices) lowest = std::min(lowest, normal.dot(to_outer * v - exit));
    return ContactRegion::single(normal, exit, std::max(-lowest, std::numeric_limits<double>::min()));
}

}  // namespace

std::optional<ContactRegion> contained_region(const MeshPair& pair, MeshScratch& scratch) {
    if (&pair.a == &pair.b) return std::nullopt;  // nothing fits inside its like
    const Transform a_to_b = pair.b_to_a.inverse();
    if (bounds_hold(pair.a, pair.b, pair.b_to_a) && is_inside(pair.a, pair.b, pair.b_to_a, scratch))
        return way_out(pair.a, pair.b, pair.b_to_a, scratch);
    if (!bounds_hold(pair.b, pair.a, a_to_b) || !is_inside(pair.b, pair.a, a_to_b, scratch)) return std::nullopt;
    ContactRegion region = way_out(pair.b, pair.a, a_to_b, scratch);
    region.normal = -(pair.b_to_a.rotation * region.normal);
    region.center = region.points[0] = pair.b_to_a * region.center;
    return region;
}

}  // namespace kolize
