#include "bounding_volumes/slab_reach.h"

#include <kolize/bounding_volumes.h>

#include <algorithm>
#include <stdexcept>

namespace kolize {

namespace {

// The vertices that belong to triangles.
std::vector<Vec3> vertices_in_use(const Mesh& mesh) {
    std::vector<std::uint8_t> used(mesh.vertices.size(), 0);
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t v : triangle) used[v] = 1;
    std::vector<Vec3> points;
    for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v]) points.push_back(mesh.vertices[v]);
    return points;
}

// How far p is at most from the convex hull of the points: E. G. Gilbert, "An iterative procedure for computing the
// minimum of a quadratic form on a convex set", SIAM J. Control 4(1), 1966. Ends as soon as it is within `enough`.
double distance_to_hull(const Vec3& p, const std::vector<Vec3>& points, double enough) {
    constexpr int most_steps = 32;
    Vec3 nearest = points.front();
    for (int step = 0; step < most_steps && (p - nearest).norm() > enough; ++step) {
        const Vec3 towards = p - nearest;
        const Vec3& farthest = *std::max_element(points.begin(), points.end(), [&](const Vec3& u, const Vec3& v) {
            return towards.dot(u) < towards.dot(v);
        });
        const Vec3 way = farthest - nearest;
        const double gain = towards.dot(way);
        if (!(gain > 0)) break;
        nearest += std::min(gain / way.squaredNorm(), 1.0) * way;
    }
    return (p - nearest).norm();
}

// A few points of a mesh, as few as a hull that may be a little too large allows: they are turned in every step.
void fit_points(const Mesh& mesh, ShapeVolume& volume) {
    constexpr std::size_t few = 16;
    constexpr double share = 0.005;  // of the radius
    std::vector<Vec3> points = vertices_in_use(mesh);
    const double enough = share * mesh.radius;
    // Far points first: those within are mostly found to be so by them.
    std::stable_sort(points.begin(), points.end(),
                     [](const Vec3& u, const Vec3& v) { return u.squaredNorm() > v.squaredNorm(); });
    for (const Vec3& p : points) {
        const double off = volume.points.size() < few ? infinity : distance_to_hull(p, volume.points, enough);
        if (off > enough)
            volume.points.push_back(p);
        else
            volume.margin = std::max(volume.margin, off);
    }
}

void fit_points(const Shape& shape, ShapeVolume& volume) {
    switch (shape.kind) {
    case ShapeKind::sphere:
        volume.points = {Vec3::Zero()};
        volume.margin = shape.radius;
        return;
    case ShapeKind::capsule:
        volume.points = {Vec3(0, shape.half_height, 0), Vec3(0, -shape.half_height, 0)};
        volume.margin = shape.cap_radius;
        return;
    case ShapeKind::box:
        for (int corner = 0; corner < 8; ++corner)
            volume.points.push_back(
                Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1).cwiseProduct(shape.half_extents));
        return;
    default: return fit_points(*shape.mesh, volume);
    }
}

BoundingSphere sphere_around(const Shape& shape) {
    const bool by_points = shape.kind == ShapeKind::mesh || shape.kind == ShapeKind::hull;
    return by_points ? smallest_enclosing_sphere(vertices_in_use(*shape.mesh))
                     : BoundingSphere{Vec3::Zero(), shape.radius};
}

OrientedBox box_around(const Shape& shape) {
    switch (shape.kind) {
    case ShapeKind::sphere: return {Vec3::Zero(), Mat3::Identity(), Vec3::Constant(shape.radius)};
    case ShapeKind::capsule: {
        const double r = shape.cap_radius;
        return {Vec3::Zero(), Mat3::Identity(), Vec3(r, shape.half_height + r, r)};
    }
    case ShapeKind::box: return {Vec3::Zero(), Mat3::Identity(), shape.half_extents};
    default: return oriented_box(vertices_in_use(*shape.mesh));
    }
}

int slabs_of(VolumeKind kind) { return kind == VolumeKind::aabb ? 3 : kind == VolumeKind::kdop18 ? 9 : 13; }

}  // namespace

VolumeKind volume_kind(const std::string& word) {
    constexpr const char* words[] = {"sphere", "aabb", "obb", "kdop18", "kdop26"};
    const auto found = std::find(std::begin(words), std::end(words), word);
    if (found == std::end(words))
        throw std::invalid_argument("a bounding volume is sphere, aabb, obb, kdop18 or kdop26, not '" + word + "'");
    return static_cast<VolumeKind>(found - std::begin(words));
}

ShapeVolume fit_volume(const Shape& shape, VolumeKind kind) {
    ShapeVolume volume;
    volume.kind = shape.kind == ShapeKind::half_space ? VolumeKind::half_space : kind;
    switch (volume.kind) {
    case VolumeKind::sphere: volume.sphere = sphere_around(shape); break;
    case VolumeKind::obb: volume.box = box_around(shape); break;
    case VolumeKind::half_space: volume.normal = shape.normal; break;
    default: fit_points(shape, volume);
    }
    return volume;
}

PlacedVolume place_volume(const ShapeVolume& volume, const Vec3& position, const Mat3& rotation) {
    PlacedVolume placed;
    placed.kind = volume.kind;
    placed.position = position;
    switch (volume.kind) {
    case VolumeKind::sphere:
        placed.center = rotation * volume.sphere.center;
        placed.radius = volume.sphere.radius;
        placed.extent = placed.center.norm() + placed.radius;
        return placed;
    case VolumeKind::obb:
        placed.center = rotation * volume.box.center;
        placed.axes = rotation * volume.box.axes;
        placed.half_extents = volume.box.half_extents;
        break;
    case VolumeKind::half_space: placed.normal = rotation * volume.normal; return placed;
    default: {
        placed.reach = slab_reach(volume.points, volume.margin, rotation, slabs_of(volume.kind));
        const auto& reach = placed.reach;
        placed.center = 0.5 * Vec3(reach[0] - reach[1], reach[2] - reach[3], reach[4] - reach[5]);
        placed.half_extents = 0.5 * Vec3(reach[0] + reach[1], reach[2] + reach[3], reach[4] + reach[5]);
    }
    }
    placed.extent = placed.center.norm() + placed.half_extents.norm();
    return placed;
}

}  // namespace kolize
