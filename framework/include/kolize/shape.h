// Shapes and materials: immutable, shared by all bodies that name them.
#pragma once

#include <kolize/mesh.h>

#include <span>

namespace kolize {

enum class ShapeKind : std::uint32_t { sphere, box, half_space, mesh, capsule, hull };

inline constexpr std::uint32_t bit(ShapeKind kind) { return 1u << static_cast<std::uint32_t>(kind); }
inline constexpr std::uint32_t all_shape_kinds = 0b101111;  // but capsules, which a plugin has to name

KOLIZE_API const char* to_string(ShapeKind);

// Geometry in the body frame: origin at the centre of mass, axes along the principal axes of inertia.
// The model frame is the one of the scene (a mesh file's origin and axes).
struct Shape {
    std::string name;
    ShapeKind kind = ShapeKind::sphere;
    double radius = 0;                    // sphere: m. Every bounded kind: largest distance from the body origin, m
    Vec3 half_extents = Vec3::Zero();     // box, m
    double cap_radius = 0;                // capsule: of its cylinder and its two caps, m
    double half_height = 0;               // capsule: the axis goes from -half_height to half_height along y, m
    Vec3 normal = Vec3::UnitY();          // half_space: unit, points out of the solid
    std::shared_ptr<const Mesh> mesh;     // mesh; for a box: its twelve triangles; for a hull: its surface
    Aabb bounds;                          // in the body frame; infinite for a half_space
    double volume = 0;                    // m^3; infinite for a half_space
    Vec3 moments = Vec3::Zero();          // principal moments over mass, m^2
    Vec3 center_in_model = Vec3::Zero();  // centre of mass in the model frame, m
    Quat body_to_model = Quat::Identity();
};

KOLIZE_API Shape make_sphere(std::string name, double radius);
KOLIZE_API Shape make_box(std::string name, const Vec3& half_extents);
// All points within `radius` of the segment from (0, -half_height, 0) to (0, half_height, 0).
KOLIZE_API Shape make_capsule(std::string name, double radius, double half_height);
// The smallest convex solid around the points, which must not lie in one plane: throws std::invalid_argument if they
// do.
KOLIZE_API Shape make_hull(std::string name, std::span<const Vec3> points);
// The solid {p : normal . p <= offset} of the model frame; the body origin is the plane's point normal * offset.
KOLIZE_API Shape make_half_space(std::string name, const Vec3& normal, double offset);
// The soup must be closed (see inspect): throws std::invalid_argument with the defect otherwise.
KOLIZE_API Shape make_mesh(std::string name, const TriangleSoup& closed_surface);

// Any triangles: a surface without thickness that is solid from both sides. It has no mass, so only static bodies can
// have it, and no inside, so only stepping `continuous`, in which nothing overlaps, can deal with it. The body frame is
// the model's, moved to the middle of the bounds. Throws std::invalid_argument if there is no triangle.
KOLIZE_API Shape make_surface(std::string name, const TriangleSoup& triangles);

struct Material {
    std::string name = "default";
    double restitution = 1.0;  // 0..1; of two bodies the larger one counts
    double friction = 0.0;     // >= 0; of two bodies the geometric mean counts
    double density = 1000.0;   // kg/m^3, used where a body gives no mass
};

}  // namespace kolize
