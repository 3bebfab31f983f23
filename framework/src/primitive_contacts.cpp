#include "primitive_contacts.h"

namespace kolize {

namespace {

// Any fixed unit vector will do where geometry gives no direction (coincident centres).
Vec3 direction_or(const Vec3& v, double length, const Vec3& otherwise) {
    return length > 0 ? Vec3(v / length) : otherwise;
}

}  // namespace

void sphere_sphere(double radius_a, double radius_b, const Vec3& b, Regions& regions) {
    const double distance = b.norm();
    const double depth = radius_a + radius_b - distance;
    if (!(depth > 0)) return;
    const Vec3 normal = direction_or(b, distance, Vec3::UnitX());
    regions.push_back(ContactRegion::single(normal, (radius_a - 0.5 * depth) * normal, depth));
}

void sphere_box(double radius, const Vec3& half_b, const Mat3& rotation_b, const Vec3& b, Regions& regions) {
    const Vec3 center = rotation_b.transpose() * -b;  // of the sphere, in the frame of the box
    const Vec3 closest = center.cwiseMin(half_b).cwiseMax(-half_b);
    Vec3 to_box = closest - center;
    double distance = to_box.norm();
    double depth = radius - distance;
    if (!(depth > 0)) return;
    if (distance == 0) {  // centre inside: leave through the nearest face
        int axis = 0;
        (half_b - center.cwiseAbs()).minCoeff(&axis);
        const double side = center[axis] < 0 ? -1.0 : 1.0;
        to_box = -side * Vec3::Unit(axis);
        depth = radius + half_b[axis] - std::abs(center[axis]);
    } else {
        to_box /= distance;
    }
    const Vec3 normal = rotation_b * to_box;
    regions.push_back(ContactRegion::single(normal, (radius - 0.5 * depth) * normal, depth));
}

void sphere_half_space(double radius, const Vec3& normal_b, const Vec3& b, Regions& regions) {
    const double depth = radius + normal_b.dot(b);  // the centre stands -normal.b above the plane
    if (depth > 0) regions.push_back(ContactRegion::single(-normal_b, (0.5 * depth - radius) * normal_b, depth));
}

void box_half_space(const Vec3& half, const Mat3& rotation_a, const Vec3& normal_b, const Vec3& b, Regions& regions) {
    const double plane = normal_b.dot(b);  // corners with normal.p < plane are inside the half-space
    if (!((rotation_a.transpose() * normal_b).cwiseAbs().dot(half) + plane > 0)) return;
    std::array<Vec3, 8> inside;
    std::size_t count = 0;
    ContactRegion region;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const Vec3 p = rotation_a * sign.cwiseProduct(half);
        if (const double depth = plane - normal_b.dot(p); depth > 0) {
            inside[count++] = p;
            region.center += p;
            region.depth = std::max(region.depth, depth);
        }
    }
    if (count == 0) return;
    std::array<std::uint32_t, 4> chosen;
    region.normal = -normal_b;
    for (const std::uint32_t i : spread_points({inside.data(), count}, chosen)) {
        region.depths[region.count] = plane - normal_b.dot(inside[i]);
        region.points[region.count++] = inside[i];
    }
    region.center /= static_cast<double>(count);
    regions.push_back(region);
}

}  // namespace kolize
