// A response plugin under test, with the worlds and contacts that it is shown.
#pragma once

#include "oracle/rigid_bodies.h"

#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

#include <catch2/catch.hpp>

#include <algorithm>

class ResponsePlugin {
public:
    using Settings = std::vector<std::pair<std::string, kolize::Value>>;

    // Parameters that are not set have their defaults.
    explicit ResponsePlugin(const std::string& name, const Settings& settings = {})
        : host_(kolize::make_host(1)), stage_(make(name, settings, *host_)) {}

    // Answers the contacts; what comes out stands in the members below. Without `hit`, both bodies fit the rule.
    void respond(kolize::World& world, std::vector<kolize::Contact>& contacts, std::vector<std::uint8_t> hit = {}) {
        hit.resize(contacts.size(), 3);
        run({contacts, hit, 1 / 240.0}, world);
    }
    void run(const kolize::ResponseInput& input, kolize::World& world) {
        events.clear();
        kolize::ResponseOutput output{events};
        stage_->respond(input, world, output);
        dissipated_J = output.dissipated_J;
        unresolved = output.unresolved;
    }

    std::vector<kolize::Event> events;
    double dissipated_J = 0;
    std::uint64_t unresolved = 0;

private:
    static const kolize::PluginLibrary& plugins() {
        static const kolize::PluginLibrary library({KOLIZE_PLUGIN_DIR});
        return library;
    }

    static kolize::StagePtr<kolize::Response> make(const std::string& name, const Settings& settings,
                                                   kolize::Host& host) {
        kolize::StageConfig config;
        config.plugin = name;
        for (const auto& [parameter, value] : settings) config.settings[parameter].value = value;
        return plugins().make<kolize::Response>(config, host);
    }

    std::unique_ptr<kolize::Host> host_;
    kolize::StagePtr<kolize::Response> stage_;
};

// The contact of a and b at a point of the world, with the normal from a to b.
inline kolize::Contact contact_at(const kolize::World& world, std::uint32_t a, std::uint32_t b,
                                  const kolize::Vec3& point, const kolize::Vec3& normal) {
    kolize::Contact contact;
    contact.a = a;
    contact.b = b;
    contact.normal = normal;
    contact.arm_a = point - world.position[a];
    contact.arm_b = point - world.position[b];
    return contact;
}

// Velocity of B against A at the contact, along the normal; negative where they approach.
inline double normal_velocity(const kolize::World& world, const kolize::Contact& c) {
    return c.normal.dot(world.velocity_at(c.b, c.arm_b) - world.velocity_at(c.a, c.arm_a));
}

// Orders the contacts as a narrowphase has to.
inline void sort_canonically(std::vector<kolize::Contact>& contacts) {
    std::stable_sort(contacts.begin(), contacts.end(), [](const kolize::Contact& c, const kolize::Contact& d) {
        return kolize::Pair{c.a, c.b} < kolize::Pair{d.a, d.b};
    });
}

// The largest of the speeds that the normal velocities of the contacts are differences of, m/s.
inline double contact_speed(const kolize::World& world, const std::vector<kolize::Contact>& contacts) {
    double speed = 0;
    for (const kolize::Contact& c : contacts)
        speed = std::max(speed, world.velocity[c.a].norm() + world.angular_velocity[c.a].norm() * c.arm_a.norm() +
                                    world.velocity[c.b].norm() + world.angular_velocity[c.b].norm() * c.arm_b.norm());
    return speed;
}

// m/s; 0 where no contact approaches.
inline double fastest_approach(const kolize::World& world, const std::vector<kolize::Contact>& contacts) {
    double approach = 0;
    for (const kolize::Contact& c : contacts) approach = std::max(approach, -normal_velocity(world, c));
    return approach;
}

// Contacts of bodies 0 and 1 at random points, with normals that lean from a common one by `spread` at most (as a
// tangent; below a right angle at 1).
inline std::vector<kolize::Contact> random_contacts(const kolize::World& world, Random& random, int count,
                                                    double spread, double reach = 1) {
    const kolize::Vec3 lead = random.direction();
    std::vector<kolize::Contact> contacts;
    for (int i = 0; i < count; ++i) {
        const kolize::Vec3 normal = (lead + 0.999 * spread * random.direction()).normalized();
        contacts.push_back(contact_at(world, 0, 1, reach * random.normal(), normal));
    }
    return contacts;
}

// A solid sphere of radius 1.
inline std::uint32_t add_ball(kolize::World& world, const kolize::Vec3& position, const kolize::Vec3& velocity,
                              double mass = 1) {
    kolize::BodyDescription body;
    body.mass = mass;
    body.position = position;
    body.velocity = velocity;
    return add_body(world, kolize::Vec3::Constant(0.4), body);
}

inline std::uint32_t add_obstacle(kolize::World& world, const kolize::Vec3& position = kolize::Vec3::Zero()) {
    kolize::BodyDescription body;
    body.is_static = true;
    body.position = position;
    return add_body(world, kolize::Vec3::Ones(), body);
}

inline std::uint32_t add_random_body(kolize::World& world, Random& random) {
    kolize::BodyDescription body;
    body.mass = random.uniform(0.1, 10);
    body.position = random.normal();
    body.orientation = random.rotation();
    body.velocity = random.normal();
    body.angular_velocity = random.normal();
    return add_body(world, random.moments(), body);
}

// Sums over all bodies; angular momentum is about the world's origin.
struct Invariants {
    double energy = 0;
    kolize::Vec3 momentum = kolize::Vec3::Zero();
    kolize::Vec3 angular_momentum = kolize::Vec3::Zero();
    double momentum_scale = 0;  // what momentum and angular momentum are sums of: to compare their rounding with

    explicit Invariants(const kolize::World& world) {
        for (std::uint32_t i = 0; i < world.size(); ++i) {
            if (world.is_static[i]) continue;
            const kolize::Vec3 p = world.velocity[i] / world.inverse_mass[i];
            energy += world.kinetic_energy(i);
            momentum += p;
            angular_momentum += world.position[i].cross(p) + world.angular_momentum(i);
            momentum_scale += (1 + world.position[i].norm()) * p.norm() + world.angular_momentum(i).norm();
        }
    }
};
