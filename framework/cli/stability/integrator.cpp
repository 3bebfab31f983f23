// Integrators: free rotation against its invariants and the symmetric top, flight against the closed form.
#include "stability/study.h"

#include <kolize/integrator.h>

#include <algorithm>

namespace kolize::cli::stability {
namespace {

constexpr int steps = 1000;
constexpr double dt = 1.0 / 60;  // s

// One body, which gets its moments (kg m^2) and mass 1 kg.
World make_world(const Vec3& moments, Dice& dice) {
    World world;
    world.materials.emplace_back();
    world.shapes.push_back(make_box("box", Vec3::Ones()));
    BodyDescription body;
    body.mass = 1;
    body.orientation = dice.rotation();
    world.add(body);
    world.inverse_inertia[0] = moments.cwiseInverse();
    return world;
}

void advance(const Subject& subject, World& world, double step, Host& host) {
    const auto integrator = make_integrator(subject.name);
    for (int i = 0; i < steps; ++i) integrator->advance(world, step, host);
}

bool finite(const World& world) {
    return world.position[0].allFinite() && world.velocity[0].allFinite() && world.angular_velocity[0].allFinite() &&
           world.orientation[0].coeffs().allFinite();
}

// --- Rotation ------------------------------------------------------------------------------------------------------

enum { spin, conditioning };

Outcome invariants(const Context& context, const Subject& subject, const Point& point) {
    Dice dice(context.seed);
    World world = make_world(Vec3(1 / value(point, conditioning), 0.8, 1), dice);
    world.angular_velocity[0] = value(point, spin) / dt * dice.direction();
    const double energy = world.kinetic_energy(0);
    const Vec3 momentum = world.angular_momentum(0);
    advance(subject, world, dt, context.host);
    if (!finite(world)) return {Failure::not_finite, "the state is not finite"};
    const double energy_off = std::abs(world.kinetic_energy(0) - energy) / energy;
    const double momentum_off = (world.angular_momentum(0) - momentum).norm() / momentum.norm();
    if (energy_off <= 1e-9 && momentum_off <= 1e-9) return {};
    return {Failure::inaccurate,
            "energy is off by " + number(energy_off) + " of the whole, angular momentum by " + number(momentum_off)};
}

// The axis of figure is x. In space the top turns about its angular momentum, and about its own axis within.
Quat symmetric_top(const World& start, const Vec3& moments, double time) {
    const Vec3 momentum = start.angular_momentum(0);
    const double precession = momentum.norm() / moments.y();
    const double along = (start.orientation[0].conjugate() * start.angular_velocity[0]).x();
    const double proper = along * (1 - moments.x() / moments.y());
    return Quat(Eigen::AngleAxisd(precession * time, momentum.normalized())) * start.orientation[0] *
           Quat(Eigen::AngleAxisd(proper * time, Vec3::UnitX()));
}

Outcome attitude(const Context& context, const Subject& subject, const Point& point) {
    constexpr int turns_of_time = 10;  // steps that the attitude is followed for go with the spin
    Dice dice(context.seed);
    const Vec3 moments(0.5 / value(point, conditioning), 1, 1);
    const World start = make_world(moments, dice);
    World world = start;
    world.angular_velocity[0] = value(point, spin) / dt * dice.direction();
    World begun = world;
    const int count = std::clamp(static_cast<int>(turns_of_time / value(point, spin)), 1, 100000);
    const auto integrator = make_integrator(subject.name);
    for (int i = 0; i < count; ++i) integrator->advance(world, dt, context.host);
    if (!finite(world)) return {Failure::not_finite, "the state is not finite"};
    const Quat truth = symmetric_top(begun, moments, count * dt);
    const double off = world.orientation[0].angularDistance(truth);
    if (off <= 1e-3) return {};
    return {Failure::inaccurate,
            "the attitude is off by " + number(off) + " rad after " + std::to_string(count) + " steps"};
}

// --- Flight --------------------------------------------------------------------------------------------------------

enum { distance, drag, step };

// (1 - exp(-z)) / z and (z - 1 + exp(-z)) / z^2 in long double, by their series where these cancel.
long double phi(int order, long double z) {
    if (z > 0.5L) {
        const long double first = -std::expm1(-z) / z;
        return order == 1 ? first : (1 - first) / z;
    }
    long double sum = 0, term = order == 1 ? 1 : 0.5L;
    for (int k = order + 1; k < 40; ++k) {
        sum += term;
        term *= -z / k;
    }
    return sum;
}

Outcome flight(const Context& context, const Subject& subject, const Point& point) {
    Dice dice(context.seed);
    World world = make_world(Vec3::Ones(), dice);
    const double each = value(point, step), time = steps * each, rate = value(point, drag) / each;
    const Vec3 start = value(point, distance) * dice.direction();
    const Vec3 velocity = 10 * dice.direction();
    world.position[0] = start;
    world.velocity[0] = velocity;
    world.forces.gravity = Vec3(0, -9.81, 0);
    world.forces.drag = rate;
    const double z = rate * time;
    const Vec3 way = static_cast<double>(phi(1, z)) * time * velocity +
                     static_cast<double>(phi(2, z)) * time * time * world.forces.gravity;
    advance(subject, world, each, context.host);
    if (!finite(world)) return {Failure::not_finite, "the state is not finite"};
    const double off = ((world.position[0] - start) - way).norm() / way.norm();
    if (off <= 1e-6) return {};
    return {Failure::inaccurate, "the way is off by " + number(off) + " of it"};
}

}  // namespace

std::vector<Study> integrator_studies(const Context& context, const std::vector<Subject>& subjects) {
    const Axis thin{"conditioning", "", "the largest moment of inertia over the smallest", 0, 12, 0.3};
    return {
        {"integrator",
         "invariants",
         "Free rotation over 1000 steps: energy and angular momentum, to 1e-9 of the whole. Oracle: their values at "
         "the start.",
         {{"spin", "rad", "turn in one step", -4, 1, -1}, thin},
         subjects,
         [context](const Subject& subject, const Point& point) { return invariants(context, subject, point); }},
        {"integrator",
         "attitude",
         "A symmetric top turns by ten radians: its attitude, to a milliradian. Oracle: closed form.",
         {{"spin", "rad", "turn in one step", -4, 1, -3}, thin},
         subjects,
         [context](const Subject& subject, const Point& point) { return attitude(context, subject, point); }},
        {"integrator",
         "flight",
         "Fall at 9.81 m/s^2 from 10 m/s over 1000 steps: the way, to a millionth of it. Oracle: closed form.",
         {{"distance", "m", "from the origin", 0, 15, 0},
          {"drag", "", "rate of the drag times the step", -12, 3, -300},
          {"step", "s", "duration of a step", -6, 2, -2}},
         subjects,
         [context](const Subject& subject, const Point& point) { return flight(context, subject, point); }}};
}

}  // namespace kolize::cli::stability
