#include "demos/tunnel_games.h"

#include <catch2/catch.hpp>

#include <array>
#include <random>

using namespace kolize;
using namespace kolize::test;

namespace {

const Engines engines{1000, {2000, 5000, 4000}, {20000, 15000, 15000}, {6000, 10000, 8000}, 0.1};

std::set<Key> keys(const std::string& letters, std::vector<Key> others = {}) {
    std::set<Key> held(others.begin(), others.end());
    for (const char letter : letters) held.insert(static_cast<Key>(letter));
    return held;
}

// A rigid ball with the inertia of the engines, forward in small steps: what the load does to it.
void move(Motion& motion, const Load& load, double dt) {
    motion.velocity += dt / engines.mass * load.force;
    const Vec3 torque = motion.axes.conjugate() * load.torque;
    const Vec3 spin = motion.axes.conjugate() * motion.angular_velocity + dt * torque.cwiseQuotient(engines.inertia);
    motion.angular_velocity = motion.axes * spin;
    const Vec3 turn = dt * motion.angular_velocity;
    if (turn.norm() > 0)
        motion.axes = (Quat(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * motion.axes).normalized();
}

struct Numbers {
    std::mt19937 random{3};
    double operator()(double most) { return most * (2.0 * random() / std::mt19937::max() - 1); }
    Vec3 vector(double most) { return {(*this)(most), (*this)(most), (*this)(most)}; }
    Quat turn() { return Quat(Eigen::AngleAxisd((*this)(3), vector(1).normalized())); }
};

}  // namespace

TEST_CASE("Each key asks for the engine that the help says", "[tunnel]") {
    struct Row {
        std::set<Key> held;
        Vec3 thrust, turn;
    };
    const std::vector<Row> table = {{keys("W"), {1, 0, 0}, {0, 0, 0}},
                                    {keys("S"), {-1, 0, 0}, {0, 0, 0}},
                                    {keys("E"), {0, 1, 0}, {0, 0, 0}},
                                    {keys("Q"), {0, -1, 0}, {0, 0, 0}},
                                    {keys("D"), {0, 0, 1}, {0, 0, 0}},
                                    {keys("A"), {0, 0, -1}, {0, 0, 0}},
                                    {keys("WSA"), {0, 0, -1}, {0, 0, 0}},
                                    {keys("", {Key::left}), {0, 0, 0}, {0, 1, 0}},
                                    {keys("", {Key::right}), {0, 0, 0}, {0, -1, 0}},
                                    {keys("", {Key::up}), {0, 0, 0}, {0, 0, 1}},
                                    {keys("", {Key::down}), {0, 0, 0}, {0, 0, -1}},
                                    {keys("", {Key::control, Key::left}), {0, 0, 0}, {-1, 0, 0}},
                                    {keys("", {Key::control, Key::right}), {0, 0, 0}, {1, 0, 0}},
                                    {keys("G", {Key::down}), {0, 0, 0}, {0, 0, 0}},
                                    {keys("WEA", {Key::up, Key::right}), {1, 1, -1}, {0, -1, 1}}};
    for (const Row& row : table) {
        const Demand demand = demand_of(row.held);
        CHECK(demand.thrust == row.thrust);
        CHECK(demand.turn == row.turn);
        CHECK_FALSE(demand.full_stop);
    }
    CHECK(demand_of(keys("W", {Key::space})).full_stop);
}

TEST_CASE("Turning to the left, upward and to the right are what they are to a pilot", "[tunnel]") {
    struct Row {
        Key key;
        bool control;
        Vec3 part, goes;  // a direction in the fighter, and where it goes
    };
    const Vec3 nose = Vec3::UnitX(), up = Vec3::UnitY(), right = Vec3::UnitZ();
    for (const Row& row :
         {Row{Key::left, false, nose, -right}, Row{Key::right, false, nose, right}, Row{Key::up, false, nose, up},
          Row{Key::down, false, nose, -up}, Row{Key::right, true, up, right}, Row{Key::left, true, up, -right}}) {
        std::set<Key> held{row.key};
        if (row.control) held.insert(Key::control);
        const Load load = engine_load(engines, demand_of(held), Control::relative, {});
        CHECK(load.torque.cross(row.part).dot(row.goes) > 0);
        CHECK(load.force.isZero(0));
    }
}

TEST_CASE("No engine ever exceeds its maximum, on any axis, whatever the motion", "[tunnel]") {
    Numbers number;
    for (int i = 0; i < 2000; ++i) {
        const Motion motion{number.turn(), number.vector(200), number.vector(50)};
        Demand demand{number.vector(1), number.vector(1), number.vector(3), i % 3 == 0};
        if (i % 2) demand.thrust = demand.turn = Vec3::Zero();
        const Load load = engine_load(engines, demand, i % 5 ? Control::autopilot : Control::relative, motion);
        const Vec3 force = motion.axes.conjugate() * load.force, torque = motion.axes.conjugate() * load.torque;
        CHECK((force.cwiseAbs() - engines.max_force).maxCoeff() <= 1e-8);
        CHECK((torque.cwiseAbs() - engines.max_torque).maxCoeff() <= 1e-8);
    }
}

TEST_CASE("Engines push along the fighter's own axes, however it is turned", "[tunnel]") {
    Numbers number;
    const std::array<std::pair<char, Vec3>, 3> table = {
        {{'W', {20000, 0, 0}}, {'E', {0, 15000, 0}}, {'A', {0, 0, -15000}}}};
    for (int i = 0; i < 100; ++i) {
        const Motion motion{number.turn(), number.vector(20), number.vector(2)};
        for (const auto& [key, push] : table) {
            const Load load = engine_load(engines, demand_of(keys({key})), Control::relative, motion);
            CHECK((load.force - motion.axes.toRotationMatrix() * push).norm() < 1e-9 * push.norm());
            CHECK(load.torque.isZero(0));
        }
    }
}

TEST_CASE("Without autopilot and keys nothing acts on the fighter", "[tunnel]") {
    const Load load = engine_load(engines, {}, Control::relative, {Quat::Identity(), {10, -4, 3}, {1, 2, 3}});
    CHECK(load.force.isZero(0));
    CHECK(load.torque.isZero(0));
}

TEST_CASE("The autopilot brings every velocity to rest and never overshoots", "[tunnel]") {
    Numbers number;
    for (const bool full_stop : {false, true}) {
        Motion motion{number.turn(), number.vector(30), Vec3::Zero()};
        Demand demand{full_stop ? Vec3(1, 1, 1) : Vec3(0, 0, 0), Vec3::Zero(), Vec3::Zero(), full_stop};
        const Control control = full_stop ? Control::relative : Control::autopilot;
        for (int step = 0; step < 240 * 8; ++step) {
            const Vec3 before = motion.axes.conjugate() * motion.velocity;
            move(motion, engine_load(engines, demand, control, motion), 1.0 / 240);
            const Vec3 after = motion.axes.conjugate() * motion.velocity;
            for (int i = 0; i < 3; ++i) {
                CHECK(std::abs(after[i]) <= std::abs(before[i]) + 1e-12);
                CHECK(after[i] * before[i] >= -1e-12);
            }
        }
        CHECK(motion.velocity.norm() < 1e-6);
    }
    Motion motion{Quat::Identity(), Vec3::Zero(), {2, -3, 4}};
    for (int step = 0; step < 240 * 8; ++step)
        move(motion, engine_load(engines, {}, Control::autopilot, motion), 1.0 / 240);
    CHECK(motion.angular_velocity.norm() < 1e-6);
}

TEST_CASE("The autopilot leaves an axis alone on which the pilot asks for something", "[tunnel]") {
    const Motion motion{Quat::Identity(), {8, 2, 0}, Vec3::Zero()};
    const Load load = engine_load(engines, demand_of(keys("W")), Control::autopilot, motion);
    CHECK(load.force.x() == 20000);           // the engine at full
    CHECK(load.force.y() == Approx(-15000));  // 1000 kg * 2 m/s / 0.1 s would be 20000 N: limited
    CHECK(load.force.z() == 0);
}

TEST_CASE("The autopilot keeps the turning rate that the pointer asks for", "[tunnel]") {
    Demand demand;
    demand.turn_rate = {0, 0.7, 0};
    Motion motion;
    for (int step = 0; step < 240 * 4; ++step)
        move(motion, engine_load(engines, demand, Control::autopilot, motion), 1.0 / 240);
    CHECK((motion.axes.conjugate() * motion.angular_velocity - Vec3(0, 0.7, 0)).norm() < 1e-6);
}
