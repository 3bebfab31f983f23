// The state of a scene: one contiguous column per quantity, addressed by a dense body id.
#pragma once

#include <kolize/shape.h>

#include <cstdint>
#include <string>
#include <vector>

namespace kolize {

struct Forces {
    Vec3 gravity = Vec3::Zero();  // m/s^2
    Vec3 wind = Vec3::Zero();     // velocity of the medium, m/s
    double drag = 0;              // linear and angular, 1/s: dv/dt = -drag (v - wind), dL/dt = -drag L
};

struct BodyDescription {
    std::string name;
    std::uint32_t shape = 0;
    std::uint32_t material = 0;
    std::string kind = "body";  // free word that response rules refer to
    bool is_static = false;
    bool is_reference = false;             // its bounds are a subspace for broadphases that divide space by bodies
    double mass = 0;                       // kg; 0: density times volume
    Vec3 position = Vec3::Zero();          // of the model frame's origin, m
    Quat orientation = Quat::Identity();   // model frame to world
    Vec3 velocity = Vec3::Zero();          // of the centre of mass, m/s
    Vec3 angular_velocity = Vec3::Zero();  // world axes, rad/s
    Vec3 constant_force = Vec3::Zero();    // world axes, at the centre of mass, N
    Vec3 constant_torque = Vec3::Zero();   // world axes, N m
};

// What moves of one body. Frames as in World.
struct BodyState {
    Vec3 position = Vec3::Zero();          // m
    Quat orientation = Quat::Identity();   // body frame to world
    Vec3 velocity = Vec3::Zero();          // m/s
    Vec3 angular_velocity = Vec3::Zero();  // world axes, rad/s
};

// Frames: a body's own frame has its origin at the centre of mass and its axes along the principal axes of inertia, so
// the inertia tensor is diagonal there and the world tensor is always derived from the orientation, never accumulated.
struct KOLIZE_API World {
    // State of body i; all columns have size() rows.
    std::vector<Vec3> position;          // centre of mass, world, m
    std::vector<Quat> orientation;       // body frame to world
    std::vector<Vec3> velocity;          // of the centre of mass, world, m/s
    std::vector<Vec3> angular_velocity;  // world axes, rad/s

    // Constants of body i.
    std::vector<double> inverse_mass;     // 1/kg; 0 for a static body
    std::vector<Vec3> inverse_inertia;    // principal, body frame, 1/(kg m^2); 0 for a static body
    std::vector<Vec3> constant_force;     // world axes, N
    std::vector<Vec3> constant_torque;    // world axes, N m
    std::vector<std::uint32_t> shape;     // into shapes
    std::vector<std::uint32_t> material;  // into materials
    std::vector<std::uint32_t> kind;      // into kinds
    std::vector<std::uint8_t> is_static;  // 1: never moves
    std::vector<std::uint8_t> removed;    // 1: taken out by a response; takes part in nothing any more
    // 1: at rest until something touches it: not integrated, and two of them are no pair. Set and cleared by a response
    // that sleeps, and cleared by whatever is put in between two steps. Its velocities are 0.
    std::vector<std::uint8_t> asleep;
    std::vector<std::uint8_t> is_reference;  // see BodyDescription
    std::vector<std::string> name;

    std::vector<Shape> shapes;
    std::vector<Material> materials;
    std::vector<std::string> kinds;
    Forces forces;

    std::size_t size() const { return position.size(); }

    // Appends a body; converts from the model frame. Throws std::invalid_argument: non-finite values, mass <= 0, ...
    std::uint32_t add(const BodyDescription& body);

    const Shape& shape_of(std::uint32_t body) const { return shapes[shape[body]]; }
    BodyState state(std::uint32_t body) const {
        return {position[body], orientation[body], velocity[body], angular_velocity[body]};
    }
    void set_state(std::uint32_t body, const BodyState& state) {
        position[body] = state.position;
        orientation[body] = state.orientation;
        velocity[body] = state.velocity;
        angular_velocity[body] = state.angular_velocity;
    }
    Transform pose(std::uint32_t body) const { return {orientation[body].toRotationMatrix(), position[body]}; }
    // Placement of the body's model frame: what scene files and printed results speak of.
    Vec3 model_position(std::uint32_t body) const;
    Quat model_orientation(std::uint32_t body) const;

    // R diag(inverse_inertia) R^T.
    Mat3 world_inverse_inertia(std::uint32_t body) const;
    Vec3 angular_momentum(std::uint32_t body) const;  // about the body's centre of mass, kg m^2/s; 0 if static
    double kinetic_energy(std::uint32_t body) const;  // J; 0 if static
    // The same for a state that the body has at another time.
    Vec3 angular_momentum(std::uint32_t body, const BodyState& state) const;
    double kinetic_energy(std::uint32_t body, const BodyState& state) const;

    Vec3 velocity_at(std::uint32_t body, const Vec3& arm) const {
        return velocity[body] + angular_velocity[body].cross(arm);
    }
    double restitution(std::uint32_t a, std::uint32_t b) const {
        return std::max(materials[material[a]].restitution, materials[material[b]].restitution);
    }
    // Index of a kind, added if new.
    std::uint32_t intern_kind(const std::string& kind_name);
};

// World-frame box of a body at its present pose; infinite for a half-space.
KOLIZE_API Aabb world_bounds(const World& world, std::uint32_t body);

}  // namespace kolize
