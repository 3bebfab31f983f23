// Worlds whose bodies have chosen inertia, and random numbers for them.
#pragma once

#include <kolize/world.h>

#include <random>

// A shape that has nothing but moments over mass (m^2): enough for motion and impulses.
inline kolize::Shape inertia_shape(const kolize::Vec3& moments) {
    kolize::Shape shape;
    shape.kind = kolize::ShapeKind::box;
    shape.volume = 1;
    shape.moments = moments;
    return shape;
}

inline kolize::World empty_world() {
    kolize::World world;
    world.materials.emplace_back();
    return world;
}

// Adds the body with an inertia shape of its own; its mass is 1 kg unless it says otherwise.
inline std::uint32_t add_body(kolize::World& world, const kolize::Vec3& moments, kolize::BodyDescription body = {}) {
    body.shape = static_cast<std::uint32_t>(world.shapes.size());
    world.shapes.push_back(inertia_shape(moments));
    if (body.mass == 0) body.mass = 1;
    return world.add(body);
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    double uniform(double min, double max) { return std::uniform_real_distribution<double>(min, max)(engine_); }
    kolize::Vec3 normal() {
        std::normal_distribution<double> d;
        const double x = d(engine_), y = d(engine_), z = d(engine_);
        return {x, y, z};
    }
    kolize::Vec3 direction() { return normal().normalized(); }
    kolize::Quat rotation() {
        const kolize::Vec3 axis = direction();
        return kolize::Quat(Eigen::AngleAxisd(uniform(-3, 3), axis));
    }
    // Principal moments that a real body can have: none is larger than the sum of the others.
    kolize::Vec3 moments() {
        const kolize::Vec3 spread = normal().cwiseAbs2() + kolize::Vec3::Constant(1e-3);
        return kolize::Vec3::Constant(spread.sum()) - spread;
    }
    std::mt19937& engine() { return engine_; }

private:
    std::mt19937 engine_;
};
