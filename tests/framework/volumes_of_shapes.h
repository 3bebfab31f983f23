// One shape of every kind, for tests of what encloses them, and points of each.
#pragma once

#include "framework/solids.h"
#include "narrowphase/solids.h"

#include <kolize/shape.h>

#include <random>

namespace kolize::test {

// Built by hand, so that nothing but the volumes is under test.
inline Shape hand_made(ShapeKind kind, const TriangleSoup& soup, double cap_radius = 0, double half_height = 0) {
    Shape shape;
    shape.kind = kind;
    if (kind == ShapeKind::capsule) {
        shape.cap_radius = cap_radius;
        shape.half_height = half_height;
        shape.radius = cap_radius + half_height;
    } else {
        shape.mesh = build_mesh(soup);
        shape.radius = shape.mesh->radius;
    }
    return shape;
}

inline std::vector<Shape> bounded_shapes() {
    return {make_sphere("sphere", 0.7),
            make_box("box", Vec3(0.9, 0.4, 0.25)),
            hand_made(ShapeKind::capsule, {}, 0.3, 0.6),
            make_mesh("u", u_bar()),
            make_mesh("cone", cone(48, 1, 1.5)),
            hand_made(ShapeKind::hull, corner_tetrahedron())};
}

// A point of the solid's surface or inside it, body frame.
inline Vec3 point_in(const Shape& shape, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Vec3 unit;
    do unit = Vec3(uniform(random), uniform(random), uniform(random));
    while (unit.norm() > 1);
    if (random() % 2) unit.normalize();
    switch (shape.kind) {
    case ShapeKind::sphere: return shape.radius * unit;
    case ShapeKind::capsule: return shape.cap_radius * unit + uniform(random) * shape.half_height * Vec3::UnitY();
    case ShapeKind::half_space: return unit - (unit.dot(shape.normal) + std::abs(uniform(random))) * shape.normal;
    default: {
        const Triangle& t = shape.mesh->triangles[random() % shape.mesh->triangles.size()];
        const auto& v = shape.mesh->vertices;
        const double s = 0.5 * (1 + uniform(random)), r = (1 - s) * 0.5 * (1 + uniform(random));
        return random() % 3 ? Vec3((1 - s - r) * v[t[0]] + s * v[t[1]] + r * v[t[2]]) : v[t[random() % 3]];
    }
    }
}

inline Mat3 any_rotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return Quat(Eigen::Vector4d(normal(random), normal(random), normal(random), normal(random)).normalized())
        .toRotationMatrix();
}

}  // namespace kolize::test
