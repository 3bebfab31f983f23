#include "oracle/euler_top.h"
#include "oracle/rigid_bodies.h"

#include <kolize/integrator.h>
#include <kolize/simulation.h>

#include <catch2/catch.hpp>

#include <cstring>

using namespace kolize;

namespace {

const Vec3 fighter(2817, 3939, 6427);  // moments of the fighter for which the thesis lost energy

World spinning(const Vec3& moments, const Vec3& angular_velocity, const Quat& orientation = Quat::Identity()) {
    World world = empty_world();
    BodyDescription body;
    body.angular_velocity = angular_velocity;
    body.orientation = orientation;
    add_body(world, moments, body);
    return world;
}

void advance(World& world, const std::string& integrator, double dt, long steps, int threads = 1) {
    const auto host = make_host(threads);
    const auto strategy = make_integrator(integrator);
    for (long i = 0; i < steps; ++i) strategy->advance(world, dt, *host);
}

struct Drift {
    double energy = 0, momentum = 0;  // largest relative deviations seen
};

Drift rotational_drift(World& world, const std::string& integrator, double dt, long steps) {
    const auto host = make_host(1);
    const auto strategy = make_integrator(integrator);
    const double energy = world.kinetic_energy(0);
    const Vec3 momentum = world.angular_momentum(0);
    Drift drift;
    for (long i = 0; i < steps; ++i) {
        strategy->advance(world, dt, *host);
        drift.energy = std::max(drift.energy, std::abs(world.kinetic_energy(0) / energy - 1));
        drift.momentum = std::max(drift.momentum, (world.angular_momentum(0) - momentum).norm() / momentum.norm());
    }
    return drift;
}

Vec3 body_angular_velocity(const World& world) { return world.orientation[0].conjugate() * world.angular_velocity[0]; }

double attitude_error_after(double time, long steps, const Vec3& moments, const Vec3& spin) {
    World world = spinning(moments, spin);
    advance(world, "pdmv4", time / steps, steps);
    EulerTop reference(moments, Quat::Identity(), spin);
    reference.advance(time, 20000);
    return attitude_error(world.orientation[0], reference.attitude());
}

bool same_bits(const Vec3& a, const Vec3& b) { return std::memcmp(a.data(), b.data(), sizeof(Vec3)) == 0; }

}  // namespace

TEST_CASE("I2 fighter-spin, I6 stable axis: pdmv4 keeps energy and angular momentum of a tumbling body to rounding",
          "[integrator]") {
    // Tumbling, about the unstable axis, fast, and needing sub-steps (10 rad a step).
    for (const Vec3& spin : {Vec3(2, 1, 1), Vec3(0.02, 3, 0.02), Vec3(20, 20, 20), Vec3(300, 400, 300)}) {
        CAPTURE(spin.transpose());
        World world = spinning(fighter, spin);
        const Drift drift = rotational_drift(world, "pdmv4", 1 / 60.0, 36000);
        CHECK(drift.energy < 1e-12);
        CHECK(drift.momentum < 1e-12);
    }
}

TEST_CASE("I1 dzhanibekov: pdmv4 turns a body over with the period of the Jacobi functions", "[integrator]") {
    const Vec3 moments(1, 2, 3), spin(0.01, 1, 0.01);
    // w(t) in body axes has the period 4 K(k) / lambda: Landau & Lifshitz, Mechanics, section 37, for L^2 > 2 E I2.
    const double energy = 0.5 * spin.dot(moments.cwiseProduct(spin));
    const double momentum_squared = moments.cwiseProduct(spin).squaredNorm();
    REQUIRE(momentum_squared > 2 * energy * moments.y());
    const double above_1 = momentum_squared - 2 * energy * moments.x();
    const double below_3 = 2 * energy * moments.z() - momentum_squared;
    const double modulus_squared = (moments.y() - moments.x()) * below_3 / ((moments.z() - moments.y()) * above_1);
    const double lambda = std::sqrt((moments.z() - moments.y()) * above_1 / moments.prod());
    const double period = 4 * std::comp_ellint_1(std::sqrt(modulus_squared)) / lambda;

    double previous_error = 0;
    for (const long steps : {1000, 2000, 4000, 8000}) {
        CAPTURE(steps);
        World world = spinning(moments, spin);
        advance(world, "pdmv4", period / steps, steps);
        const double error = (body_angular_velocity(world) - spin).norm();
        if (previous_error > 0) CHECK(previous_error / error == Approx(16).epsilon(0.1));
        previous_error = error;
    }
    World world = spinning(moments, spin);
    advance(world, "pdmv4", period / 80000, 80000);
    CHECK((body_angular_velocity(world) - spin).norm() < 1e-9);
}

TEST_CASE("pdmv4 follows the true attitude with order 4", "[integrator]") {
    CHECK(attitude_error_after(10, 600, fighter, Vec3(0.02, 3, 0.02)) < 1e-5);
    const Vec3 spin(2, 1, 1);
    const double coarse = attitude_error_after(10, 300, fighter, spin);
    const double fine = attitude_error_after(10, 600, fighter, spin);
    CHECK(fine < 1e-5);
    CHECK(coarse / fine == Approx(16).epsilon(0.05));
}

// Decades in quarters: the largest angle per step at which ten seconds of tumbling are followed to 1e-3 rad.
TEST_CASE("I7 h-w sweep: pdmv4 follows the attitude to 1e-3 rad up to a tenth of a radian per step at least",
          "[integrator]") {
    const Vec3 spin(0.02, 3, 0.02);
    double largest = 0;
    for (double angle = 1e-3; angle < 10; angle *= std::pow(10, 0.25)) {
        const int steps = static_cast<int>(std::ceil(10 * spin.norm() / angle));
        const double error = attitude_error_after(10, steps, fighter, spin);
        CHECK(std::isfinite(error));
        if (error < 1e-3) largest = angle;
    }
    INFO("largest: " << largest << " rad a step");
    CHECK(largest >= 0.1);
}

TEST_CASE("I4 symmetric top: pdmv4 precesses a symmetric top at the closed-form rates", "[integrator]") {
    const Vec3 moments(1, 1, 2), spin(1, 0, 5);
    World world = spinning(moments, spin);
    const double time = 10;
    advance(world, "pdmv4", time / 4800, 4800);
    // The axis goes round L at |L| / I1 while the body turns about its axis at w3 (1 - I3 / I1).
    const Vec3 momentum = moments.cwiseProduct(spin);
    const double space_rate = momentum.norm() / moments.x();
    CHECK(space_rate == Approx(std::sqrt(101)));
    const double body_rate = spin.z() * (1 - moments.z() / moments.x());
    const Quat expected = Quat(Eigen::AngleAxisd(space_rate * time, momentum.normalized())) *
                          Quat(Eigen::AngleAxisd(body_rate * time, Vec3::UnitZ()));
    CHECK(attitude_error(world.orientation[0], expected) < 1e-6);
}

TEST_CASE("I3 cube-spin: a body with three equal moments keeps its angular velocity bit for bit and turns exactly",
          "[integrator]") {
    const Vec3 spin(1, 2, 3);
    World world = spinning(Vec3::Ones(), spin, Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX())));
    advance(world, "pdmv4", 1e-3, 100000);
    CHECK(same_bits(world.angular_velocity[0], spin));
    const Quat expected =
        Quat(Eigen::AngleAxisd(100 * spin.norm(), spin.normalized())) * Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
    CHECK(attitude_error(world.orientation[0], expected) < 5e-13);  // rounding of 100 000 products
}

TEST_CASE("I8 reversal: pdmv4 comes back to the start when time is reversed", "[integrator]") {
    const Vec3 spin(0.02, 3, 0.02);
    World world = spinning(fighter, spin);
    advance(world, "pdmv4", 1 / 60.0, 100000);
    CHECK(attitude_error(world.orientation[0], Quat::Identity()) > 1e-3);
    world.angular_velocity[0] *= -1;
    advance(world, "pdmv4", 1 / 60.0, 100000);
    CHECK((world.angular_velocity[0] + spin).norm() < 1e-9);
    CHECK(attitude_error(world.orientation[0], Quat::Identity()) < 1e-9);
}

TEST_CASE("pdmv4 keeps a spin of any size finite", "[integrator]") {
    for (const double size : {0.0, 1e-300, 1e-160, 1e6, 1e160, 1e300}) {
        CAPTURE(size);
        World world = spinning(Vec3(1, 2, 2.5), size * Vec3(1, 0.5, 0.25));
        advance(world, "pdmv4", 0.01, 10);
        CHECK(world.angular_velocity[0].allFinite());
        CHECK(std::abs(world.orientation[0].norm() - 1) < 1e-15);
    }
}

TEST_CASE("I5 parabola: gravity and a constant force give the exact parabola at any step", "[integrator]") {
    for (const long steps : {1, 7, 600, 10000}) {
        CAPTURE(steps);
        World world = empty_world();
        world.forces.gravity = Vec3(0, -9.81, 0);
        BodyDescription body;
        body.mass = 2;
        body.velocity = Vec3(3, 20, 0);
        body.constant_force = Vec3(0, 0, 0.5);
        add_body(world, fighter, body);
        advance(world, "pdmv4", 10.0 / steps, steps);
        CHECK(world.position[0].x() == Approx(30).epsilon(1e-12));
        CHECK(world.position[0].y() == Approx(-290.5).epsilon(1e-12));
        CHECK(world.position[0].z() == Approx(12.5).epsilon(1e-12));
        CHECK(world.velocity[0].y() == Approx(20 - 98.1).epsilon(1e-12));
    }
}

TEST_CASE("semi_implicit_euler falls g t h / 2 too deep and keeps w instead of L", "[integrator]") {
    const double h = 1 / 60.0;
    World world = empty_world();
    world.forces.gravity = Vec3(0, -9.81, 0);
    BodyDescription body;
    body.velocity = Vec3(3, 20, 0);
    body.angular_velocity = Vec3(2, 1, 1);
    add_body(world, fighter, body);
    advance(world, "semi_implicit_euler", h, 600);
    CHECK(world.position[0].y() + 290.5 == Approx(-9.81 * 10 * h / 2).epsilon(1e-9));
    CHECK(same_bits(world.angular_velocity[0], Vec3(2, 1, 1)));
}

TEST_CASE("momentum_euler gains the energy that theory says at every step", "[integrator]") {
    const Vec3 spin(2, 1, 1);
    for (const double h : {1e-3, 1e-4}) {
        CAPTURE(h);
        World world = spinning(fighter, spin);
        const Vec3 momentum = world.angular_momentum(0);
        const double before = world.kinetic_energy(0);
        advance(world, "momentum_euler", h, 1);
        // dE = h^2 / 2 (L x w) . I^-1 (L x w) + O(h^3), body axes, which are the world's at the start.
        const Vec3 rate = momentum.cross(spin);
        const double gain = h * h / 2 * rate.dot(rate.cwiseQuotient(fighter));
        CHECK(gain > 0);
        CHECK((world.kinetic_energy(0) - before) / gain == Approx(1).epsilon(10 * h));
        CHECK((world.angular_momentum(0) - momentum).norm() < 1e-14 * momentum.norm());
    }
}

TEST_CASE("momentum_euler makes a tumbling fighter explode where pdmv4 keeps its energy", "[integrator]") {
    World tumbling = spinning(fighter, Vec3(2, 1, 1));
    CHECK(rotational_drift(tumbling, "momentum_euler", 1 / 60.0, 36000).energy > 0.4);
    World about_an_axis = spinning(fighter, Vec3(0, 0, 2));
    CHECK(rotational_drift(about_an_axis, "momentum_euler", 1 / 60.0, 36000).energy < 1e-12);
}

TEST_CASE("Drag, wind and gravity follow the closed form at any step", "[integrator]") {
    const Vec3 start(3, 20, -1), wind(5, 0, 2), gravity(0, -9.81, 0);
    const long double time = 2;
    for (const double drag : {0.01, 0.3, 0.5, 0.7, 40.0, 1e4})
        for (const long steps : {1, 10, 1000}) {
            CAPTURE(drag, steps);
            World world = empty_world();
            world.forces = {gravity, wind, drag};
            BodyDescription body;
            body.velocity = start;
            add_body(world, fighter, body);
            advance(world, "pdmv4", static_cast<double>(time) / steps, steps);
            using Vec = Eigen::Matrix<long double, 3, 1>;
            const long double k = drag;
            const Vec terminal = wind.cast<long double>() + gravity.cast<long double>() / k;
            const Vec excess = start.cast<long double>() - terminal;
            const Vec3 velocity = (terminal + excess * std::exp(-k * time)).cast<double>();
            const Vec3 position = (terminal * time - excess * std::expm1(-k * time) / k).cast<double>();
            CHECK((world.velocity[0] - velocity).norm() < 1e-12 * velocity.norm());
            CHECK((world.position[0] - position).norm() < 1e-12 * position.norm());
        }
}

TEST_CASE("A trace of drag changes a fall only by a trace", "[integrator]") {
    World world = empty_world();
    world.forces = {Vec3(0, -9.81, 0), Vec3::Zero(), 1e-14};
    add_body(world, fighter);
    advance(world, "pdmv4", 1, 10);
    CHECK(world.position[0].y() == Approx(-490.5).epsilon(1e-12));
}

TEST_CASE("The Euler integrators approach the closed form of drag with order 1 and stay stable", "[integrator]") {
    for (const char* name : {"semi_implicit_euler", "momentum_euler"}) {
        CAPTURE(name);
        const auto error_with = [&](long steps) {
            World world = empty_world();
            world.forces = {Vec3::Zero(), Vec3(2, 0, 0), 1};
            add_body(world, fighter);
            advance(world, name, 1.0 / steps, steps);
            return std::abs(world.velocity[0].x() - 2 * (1 - std::exp(-1)));
        };
        CHECK(error_with(100) / error_with(200) == Approx(2).epsilon(0.02));
        World stiff = empty_world();
        stiff.forces = {Vec3::Zero(), Vec3(2, 0, 0), 1e6};
        add_body(stiff, fighter);
        advance(stiff, name, 0.1, 100);
        CHECK(stiff.velocity[0].x() == Approx(2));
    }
}

TEST_CASE("pdmv4 lets angular momentum decay and grow as drag and torque say", "[integrator]") {
    World braked = spinning(fighter, Vec3(2, 1, 1));
    braked.forces.drag = 0.2;
    const Vec3 before = braked.angular_momentum(0);
    advance(braked, "pdmv4", 1 / 60.0, 600);
    CHECK((braked.angular_momentum(0) - before * std::exp(-2)).norm() < 1e-12 * before.norm());

    World driven = empty_world();
    BodyDescription body;
    body.angular_velocity = Vec3(2, 1, 1);
    body.constant_torque = Vec3(100, -3000, 1000);
    add_body(driven, fighter, body);
    advance(driven, "pdmv4", 1 / 60.0, 600);
    const Vec3 expected = before + 10 * body.constant_torque;
    CHECK((driven.angular_momentum(0) - expected).norm() < 1e-12 * expected.norm());
}

TEST_CASE("pdmv4 has order 2 under a torque", "[integrator]") {
    BodyDescription body;
    body.angular_velocity = Vec3(2, 1, 1);
    body.constant_torque = Vec3(300, -1000, 500);
    EulerTop reference(fighter, Quat::Identity(), body.angular_velocity, body.constant_torque);
    reference.advance(2, 20000);
    const auto error_with = [&](long steps) {
        World world = empty_world();
        add_body(world, fighter, body);
        advance(world, "pdmv4", 2.0 / steps, steps);
        return attitude_error(world.orientation[0], reference.attitude());
    };
    CHECK(error_with(120) / error_with(240) == Approx(4).epsilon(0.05));
}

TEST_CASE("Integrators leave static and removed bodies alone", "[integrator]") {
    for (const std::string& name : integrator_names()) {
        CAPTURE(name);
        World world = empty_world();
        world.forces = {Vec3(0, -9.81, 0), Vec3(1, 0, 0), 0.1};
        BodyDescription body;
        body.is_static = true;
        body.constant_force = body.constant_torque = Vec3::Ones();
        add_body(world, fighter, body);
        body.is_static = false;
        add_body(world, fighter, body);
        world.removed[1] = 1;
        advance(world, name, 0.1, 10);
        for (int i : {0, 1}) {
            CHECK(world.position[i].isZero(0));
            CHECK(world.velocity[i].isZero(0));
            CHECK(world.angular_velocity[i].isZero(0));
            CHECK(world.orientation[i].coeffs() == Quat::Identity().coeffs());
        }
    }
}

TEST_CASE("Integrators give the same bits on any number of threads", "[integrator]") {
    World start = empty_world();
    start.forces = {Vec3(0, -9.81, 0), Vec3(1, 0, 0), 0.1};
    Random random(4);
    for (int i = 0; i < 2000; ++i) {
        BodyDescription body;
        body.orientation = random.rotation();
        body.velocity = random.normal();
        body.angular_velocity = 10 * random.normal();
        body.constant_torque = random.normal();
        add_body(start, random.moments(), body);
    }
    for (const std::string& name : integrator_names()) {
        World alone = start;
        advance(alone, name, 0.01, 5);
        for (const int threads : {2, 8}) {
            CAPTURE(name, threads);
            World together = start;
            advance(together, name, 0.01, 5, threads);
            bool same = true;
            for (std::size_t i = 0; i < start.size(); ++i)
                same = same && same_bits(alone.position[i], together.position[i]) &&
                       same_bits(alone.velocity[i], together.velocity[i]) &&
                       same_bits(alone.angular_velocity[i], together.angular_velocity[i]) &&
                       alone.orientation[i].coeffs() == together.orientation[i].coeffs();
            CHECK(same);
        }
    }
}

TEST_CASE("An unknown integrator is refused with the names of those there are", "[integrator]") {
    CHECK_THROWS_WITH(make_integrator("rk4"), Catch::Contains("rk4") && Catch::Contains("pdmv4"));
    for (const std::string& name : integrator_names()) CHECK(make_integrator(name));
}
