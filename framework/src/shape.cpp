#include <kolize/shape.h>

#include <kolize/convex_hull.h>
#include <kolize/mass_properties.h>

#include <numbers>
#include <stdexcept>

namespace kolize {

namespace {

void require(bool fine, const std::string& message) {
    if (!fine) throw std::invalid_argument(message);
}

bool positive(double x) { return x > 0 && x < infinity; }

}  // namespace

const char* to_string(ShapeKind kind) {
    switch (kind) {
    case ShapeKind::sphere: return "sphere";
    case ShapeKind::box: return "box";
    case ShapeKind::half_space: return "half_space";
    case ShapeKind::mesh: return "mesh";
    case ShapeKind::capsule: return "capsule";
    case ShapeKind::hull: return "hull";
    }
    return "unknown";
}

Shape make_sphere(std::string name, double radius) {
    require(positive(radius), "the radius of a sphere must be positive and finite, is " + std::to_string(radius));
    Shape shape;
    shape.name = std::move(name);
    shape.kind = ShapeKind::sphere;
    shape.radius = radius;
    shape.bounds = {Vec3::Constant(-radius), Vec3::Constant(radius)};
    shape.volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    shape.moments = Vec3::Constant(0.4 * radius * radius);
    return shape;
}

Shape make_box(std::string name, const Vec3& half_extents) {
    for (const double h : half_extents)
        require(positive(h), "the half extents of a box must be positive and finite, one is " + std::to_string(h));
    const Vec3 squares = half_extents.cwiseProduct(half_extents);
    Shape shape;
    shape.name = std::move(name);
    shape.kind = ShapeKind::box;
    shape.radius = half_extents.norm();
    shape.half_extents = half_extents;
    shape.mesh = build_mesh(box_soup(half_extents));
    shape.bounds = {-half_extents, half_extents};
    shape.volume = 8 * half_extents.prod();
    shape.moments = Vec3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()) / 3;
    return shape;
}

Shape make_half_space(std::string name, const Vec3& normal, double offset) {
    const double length = normal.norm();
    require(positive(length), "the normal of a half space must have a positive and finite length");
    require(std::isfinite(offset), "the offset of a half space must be finite");
    Shape shape;
    shape.name = std::move(name);
    shape.kind = ShapeKind::half_space;
    shape.radius = infinity;
    shape.normal = normal / length;
    shape.bounds = {Vec3::Constant(-infinity), Vec3::Constant(infinity)};
    shape.volume = infinity;
    shape.center_in_model = shape.normal * (offset / length);
    return shape;
}

Shape make_mesh(std::string name, const TriangleSoup& closed_surface) {
    const MeshDefects defects = inspect(closed_surface);
    require(defects.closed(), "the mesh must be the closed surface of a solid, but " + defects.first);
    const MassProperties mass = mass_properties(closed_surface);
    const PrincipalFrame frame = principal_frame(mass.inertia_over_mass);
    TriangleSoup body = closed_surface;
    const Mat3 model_to_body = frame.axes.toRotationMatrix().transpose();
    for (Vec3& vertex : body.vertices) vertex = model_to_body * (vertex - mass.center_of_mass);
    Shape shape;
    shape.name = std::move(name);
    shape.kind = ShapeKind::mesh;
    shape.mesh = build_mesh(body, defects.closed());
    shape.radius = shape.mesh->radius;
    shape.bounds = shape.mesh->bounds;
    shape.volume = mass.volume;
    shape.moments = frame.moments;
    shape.center_in_model = mass.center_of_mass;
    shape.body_to_model = frame.axes;
    return shape;
}

Shape make_capsule(std::string name, double radius, double half_height) {
    require(positive(radius), "the radius of a capsule must be positive and finite, is " + std::to_string(radius));
    require(half_height >= 0 && half_height < infinity,
            "the half height of a capsule must be finite and not below 0, is " + std::to_string(half_height));
    Shape shape;
    shape.name = std::move(name);
    shape.kind = ShapeKind::capsule;
    shape.radius = radius + half_height;
    shape.cap_radius = radius;
    shape.half_height = half_height;
    const Vec3 reach(radius, radius + half_height, radius);
    shape.bounds = {-reach, reach};
    // A cylinder and a ball, whose halves stand at its ends: their centres of mass are 3/8 r farther out.
    const double r2 = radius * radius, h = half_height;
    const double cylinder = 2 * std::numbers::pi * r2 * h, ball = 4.0 / 3.0 * std::numbers::pi * r2 * radius;
    shape.volume = cylinder + ball;
    const double along = cylinder * r2 / 2 + ball * 0.4 * r2;
    const double across = cylinder * (r2 / 4 + h * h / 3) + ball * (0.4 * r2 + h * h + 0.75 * h * radius);
    shape.moments = Vec3(across, along, across) / shape.volume;
    return shape;
}

Shape make_hull(std::string name, std::span<const Vec3> points) {
    Shape shape = make_mesh(std::move(name), convex_hull(points));
    shape.kind = ShapeKind::hull;
    return shape;
}

Shape make_surface(std::string name, const TriangleSoup& triangles) {
    require(!triangles.triangles.empty(), "the surface has no triangle");
    Aabb bounds;
    for (const Triangle& triangle : triangles.triangles)
        for (const std::uint32_t v : triangle) bounds.include(triangles.vertices[v]);
    TriangleSoup body = triangles;
    for (Vec3& vertex : body.vertices) vertex -= bounds.center();
    Shape shape;
    shape.name = std::move(name);
    shape.kind = ShapeKind::mesh;
    shape.mesh = build_mesh(body, false);
    shape.radius = shape.mesh->radius;
    shape.bounds = shape.mesh->bounds;
    shape.center_in_model = bounds.center();
    return shape;
}

}  // namespace kolize
