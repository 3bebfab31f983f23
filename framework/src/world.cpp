#include <kolize/world.h>

#include <algorithm>
#include <stdexcept>

namespace kolize {
namespace {

std::string label(const BodyDescription& body, std::size_t id) {
    return body.name.empty() ? "body " + std::to_string(id) : "body '" + body.name + "'";
}

[[noreturn]] void refuse(const std::string& who, const std::string& what) {
    throw std::invalid_argument(who + ": " + what);
}

void require_finite(const std::string& who, const BodyDescription& body) {
    const auto check = [&](bool finite, const char* what) {
        if (!finite) refuse(who, std::string(what) + " is not finite");
    };
    check(body.position.allFinite(), "position");
    check(body.orientation.coeffs().allFinite(), "orientation");
    check(body.velocity.allFinite(), "velocity");
    check(body.angular_velocity.allFinite(), "angular velocity");
    check(body.constant_force.allFinite(), "constant force");
    check(body.constant_torque.allFinite(), "constant torque");
    check(std::isfinite(body.mass), "mass");
}

void require_usable(const std::string& who, const BodyDescription& body, const World& world) {
    if (body.shape >= world.shapes.size()) refuse(who, "there is no shape " + std::to_string(body.shape));
    if (body.material >= world.materials.size()) refuse(who, "there is no material " + std::to_string(body.material));
    require_finite(who, body);
    if (!std::isnormal(body.orientation.squaredNorm()))
        refuse(who, "orientation has no usable length; a quaternion w, x, y, z of length 1 is needed");
    if (body.mass < 0) refuse(who, "mass must be positive, or 0 to take it from the material's density");
    if (body.is_static && !(body.velocity.isZero(0) && body.angular_velocity.isZero(0)))
        refuse(who, "a static body never moves; leave out its velocities or make it dynamic");
    if (!body.is_static && world.shapes[body.shape].kind == ShapeKind::half_space)
        refuse(who, "a half_space has no mass; make it static");
    const Mesh* mesh = world.shapes[body.shape].mesh.get();
    if (!body.is_static && mesh && !mesh->closed) refuse(who, "an open surface has no mass; make the body static");
}

double mass_of(const std::string& who, const BodyDescription& body, const World& world) {
    const double mass =
        body.mass > 0 ? body.mass : world.materials[body.material].density * world.shapes[body.shape].volume;
    if (!(mass > 0) || !std::isnormal(1 / mass))
        refuse(who, "the mass in kg, given or density times volume, is 0 or beyond what can be computed with");
    return mass;
}

Vec3 inverse_inertia_of(const std::string& who, double mass, const Shape& shape) {
    const Vec3 inverse = (mass * shape.moments).cwiseInverse();
    if (!inverse.allFinite() || inverse.minCoeff() <= 0)
        refuse(who, "mass and size give an inertia that a double cannot hold; check the units");
    return inverse;
}

}  // namespace

std::uint32_t World::add(const BodyDescription& body) {
    const std::uint32_t id = static_cast<std::uint32_t>(size());
    const std::string who = label(body, id);
    require_usable(who, body, *this);
    const Shape& its_shape = shapes[body.shape];
    const bool moves = !body.is_static;
    const double mass = moves ? mass_of(who, body, *this) : infinity;
    const Vec3 its_inverse_inertia = moves ? inverse_inertia_of(who, mass, its_shape) : Vec3::Zero();
    const Quat model_to_world = body.orientation.normalized();

    position.push_back(body.position + model_to_world * its_shape.center_in_model);
    orientation.push_back((model_to_world * its_shape.body_to_model).normalized());
    velocity.push_back(body.velocity);
    angular_velocity.push_back(body.angular_velocity);
    inverse_mass.push_back(1 / mass);
    inverse_inertia.push_back(its_inverse_inertia);
    constant_force.push_back(body.constant_force);
    constant_torque.push_back(body.constant_torque);
    shape.push_back(body.shape);
    material.push_back(body.material);
    kind.push_back(intern_kind(body.kind));
    is_static.push_back(body.is_static);
    removed.push_back(0);
    asleep.push_back(0);
    is_reference.push_back(body.is_reference);
    name.push_back(body.name);
    return id;
}

Vec3 World::model_position(std::uint32_t body) const {
    return position[body] - model_orientation(body) * shape_of(body).center_in_model;
}

Quat World::model_orientation(std::uint32_t body) const {
    return orientation[body] * shape_of(body).body_to_model.conjugate();
}

Mat3 World::world_inverse_inertia(std::uint32_t body) const {
    const Mat3 rotation = orientation[body].toRotationMatrix();
    return rotation * inverse_inertia[body].asDiagonal() * rotation.transpose();
}

Vec3 World::angular_momentum(std::uint32_t body) const { return angular_momentum(body, state(body)); }

double World::kinetic_energy(std::uint32_t body) const { return kinetic_energy(body, state(body)); }

Vec3 World::angular_momentum(std::uint32_t body, const BodyState& state) const {
    if (is_static[body]) return Vec3::Zero();
    const Mat3 rotation = state.orientation.toRotationMatrix();
    return rotation * (rotation.transpose() * state.angular_velocity).cwiseQuotient(inverse_inertia[body]);
}

double World::kinetic_energy(std::uint32_t body, const BodyState& state) const {
    if (is_static[body]) return 0;
    return 0.5 * (state.velocity.squaredNorm() / inverse_mass[body] +
                  state.angular_velocity.dot(angular_momentum(body, state)));
}

std::uint32_t World::intern_kind(const std::string& kind_name) {
    const auto index = std::find(kinds.begin(), kinds.end(), kind_name) - kinds.begin();
    if (static_cast<std::size_t>(index) == kinds.size()) kinds.push_back(kind_name);
    return static_cast<std::uint32_t>(index);
}

Aabb world_bounds(const World& world, std::uint32_t body) {
    const Shape& shape = world.shape_of(body);
    const Vec3& position = world.position[body];
    switch (shape.kind) {
    case ShapeKind::sphere: {
        const Vec3 half = Vec3::Constant(shape.radius);
        return {position - half, position + half};
    }
    case ShapeKind::half_space: return {Vec3::Constant(-infinity), Vec3::Constant(infinity)};
    case ShapeKind::capsule: {
        const Vec3 axis = world.orientation[body] * (shape.half_height * Vec3::UnitY());
        const Vec3 half = axis.cwiseAbs() + Vec3::Constant(shape.cap_radius);
        return {position - half, position + half};
    }
    case ShapeKind::box:
    case ShapeKind::hull:
    case ShapeKind::mesh: break;
    }
    // A turned box reaches |R| h along the world axes: Arvo, "Transforming axis-aligned bounding boxes", Graphics Gems.
    const Mat3 rotation = world.orientation[body].toRotationMatrix();
    const Vec3 center = position + rotation * shape.bounds.center();
    const Vec3 half = rotation.cwiseAbs() * shape.bounds.half_extents();
    return {center - half, center + half};
}

}  // namespace kolize
