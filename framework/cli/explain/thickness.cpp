#include "thickness.h"

#include <algorithm>
#include <numeric>

namespace kolize::cli {

namespace {

constexpr std::size_t most_rays = 256;

// From the middle of a triangle inward to the first of the others. Moller and Trumbore 1997.
double way_through(const Mesh& mesh, std::uint32_t from) {
    const auto corner = [&](std::uint32_t triangle, int k) -> const Vec3& {
        return mesh.vertices[mesh.triangles[triangle][k]];
    };
    const Vec3 start = (corner(from, 0) + corner(from, 1) + corner(from, 2)) / 3, inward = -mesh.normals[from];
    double nearest = infinity;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (t == from) continue;
        const Vec3 e = corner(t, 1) - corner(t, 0), f = corner(t, 2) - corner(t, 0);
        const Vec3 p = inward.cross(f);
        const double determinant = e.dot(p);
        if (determinant == 0) continue;
        const Vec3 s = start - corner(t, 0);
        const double u = s.dot(p) / determinant;
        const Vec3 q = s.cross(e);
        const double v = inward.dot(q) / determinant, way = f.dot(q) / determinant;
        if (u >= 0 && v >= 0 && u + v <= 1 && way > 0) nearest = std::min(nearest, way);
    }
    return nearest;
}

double thickness(const Mesh& mesh) {
    if (!mesh.closed) return 0;  // a surface
    const std::size_t count = mesh.triangles.size(), rays = std::min(count, most_rays);
    double least = infinity;
    for (std::size_t i = 0; i < rays; ++i)
        least = std::min(least, way_through(mesh, static_cast<std::uint32_t>(i * count / rays)));
    return least;
}

}  // namespace

double thickness(const Shape& shape) {
    switch (shape.kind) {
    case ShapeKind::sphere: return 2 * shape.radius;
    case ShapeKind::box: return 2 * shape.half_extents.minCoeff();
    case ShapeKind::capsule: return 2 * shape.cap_radius;
    case ShapeKind::half_space: return infinity;
    case ShapeKind::mesh:
    case ShapeKind::hull: break;
    }
    return thickness(*shape.mesh);
}

LeapWatch::LeapWatch(const World& world, double dt) : dt_(dt) {
    std::vector<double> of_shape;
    for (const Shape& shape : world.shapes) of_shape.push_back(thickness(shape));
    for (const std::uint32_t shape : world.shape) thickness_.push_back(of_shape[shape]);
    thinnest_two_.resize(world.size());
    std::iota(thinnest_two_.begin(), thinnest_two_.end(), 0u);
    const std::size_t two = std::min<std::size_t>(2, world.size());
    std::partial_sort(thinnest_two_.begin(), thinnest_two_.begin() + static_cast<std::ptrdiff_t>(two),
                      thinnest_two_.end(),
                      [&](std::uint32_t a, std::uint32_t b) { return thickness_[a] < thickness_[b]; });
    thinnest_two_.resize(two);
}

Leap LeapWatch::largest(const World& world) const {
    Leap largest;
    if (thinnest_two_.size() < 2) return largest;
    const auto travel = [&](std::uint32_t body) {
        const double turning = world.shape_of(body).kind == ShapeKind::sphere
                                   ? 0
                                   : world.angular_velocity[body].norm() * world.shape_of(body).radius;
        return dt_ * (world.velocity[body].norm() + turning);
    };
    double first = 0, second = 0;  // the farthest
    std::uint32_t farthest = 0;
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        if (world.is_static[body] || world.removed[body]) continue;
        const double t = travel(body);
        if (t > first) {
            second = std::exchange(first, t);
            farthest = body;
        } else {
            second = std::max(second, t);
        }
    }
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        if (world.is_static[body] || world.removed[body]) continue;
        const std::uint32_t other = thinnest_two_[thinnest_two_[0] == body];
        // The thinnest other may stand still; whether it is the fastest one too is not worth a look at every pair.
        const double others = world.is_static[other] ? 0 : body == farthest ? second : first;
        const Leap leap{body, travel(body) + others, thickness_[body] + thickness_[other]};
        if (leap.room < infinity && leap.share() > largest.share()) largest = leap;
    }
    return largest;
}

}  // namespace kolize::cli
