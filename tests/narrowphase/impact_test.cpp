// When bodies in motion meet: Narrowphase::find_impacts, with flows whose motion is known in closed form.
#include "conformance/steady_flow.h"
#include "framework/solids.h"
#include "narrowphase/solids.h"
#include "narrowphase/two_bodies.h"

#include <catch2/catch.hpp>

#include <random>

using namespace kolize;
using namespace kolize::test;

namespace {

constexpr double h = 1.0 / 60;

// What one narrowphase says about bodies 0 and 1 of a world that move steadily.
class Sweep {
public:
    explicit Sweep(const World& world)
        : world_(world),
          flow_(world_),
          host_(make_host(1)),
          stage_(library().make<Narrowphase>(StageConfig{"moller", {}, {}}, *host_)) {
        stage_->prepare(world_);
    }

    double impact(double until, double from = 0) {
        double time = 0;
        stage_->find_impacts({world_, flow_, {&pair_, 1}, from, until}, {&time, 1});
        return time;
    }
    double touch() const { return touch_distance(world_, 0, 1); }
    World world_at(double time) const {
        World moved = world_;
        for (const std::uint32_t body : {0u, 1u}) moved.set_state(body, flow_.at(body, time));
        return moved;
    }
    bool overlaps(double time) {
        const World moved = world_at(time);
        const Detail detail = Detail::overlap;
        Contacts contacts;
        stage_->find_contacts({moved, {&pair_, 1}, {&detail, 1}}, contacts);
        return !contacts.rows.empty();
    }
    std::vector<Contact> touching(double time, double reach = 0) {
        const World moved = world_at(time);
        const Detail detail = Detail::manifold;
        Contacts contacts;
        stage_->find_touching({moved, {&pair_, 1}, {&detail, 1}, reach}, contacts);
        return contacts.rows;
    }

private:
    World world_;
    SteadyFlow flow_;
    Pair pair_{0, 1};
    std::unique_ptr<Host> host_;
    StagePtr<Narrowphase> stage_;
};

World world_of_moving(const Placed& a, const Vec3& velocity, const Vec3& angular_velocity, const Placed& b) {
    World world = world_of(a, b);
    world.velocity[0] = velocity;
    world.angular_velocity[0] = angular_velocity;
    return world;
}

Placed standing(const Shape& shape) { return {shape, Vec3::Zero(), Quat::Identity(), true}; }

Shape box_mesh(const Vec3& half) { return make_mesh("box", box_soup(half)); }

}  // namespace

TEST_CASE("C1 bullet: a small ball of any speed meets a thin plate, as a box, a mesh and a half-space", "[impact]") {
    for (const Shape& plate : {make_box("plate", Vec3(0.05, 5e-4, 0.05)), box_mesh(Vec3(0.05, 5e-4, 0.05)),
                               make_half_space("floor", Vec3::UnitY(), 5e-4)})
        for (int k = 0; k <= 8; ++k) {
            CAPTURE(to_string(plate.kind), k);
            const double speed = std::pow(10.0, k);
            Sweep sweep(world_of_moving({make_sphere("ball", 0.01), Vec3(0.01, 1 + 5e-4, 0.02)}, Vec3(0, -speed, 0),
                                        Vec3::Zero(), {plate, Vec3::Zero(), Quat::Identity(), true}));
            const double expected = (1 - 0.01) / speed, found = sweep.impact(2 / speed);
            CHECK(found <= expected + 1e-15 * expected);
            CHECK(expected - found <= 1e-12 * h);
            CHECK(sweep.impact(0.5 / speed) == infinity);
        }
}

TEST_CASE("C2 rod: the end of a turning rod meets a plane, a box and a mesh", "[impact]") {
    const double thin = 1e-3, angle = std::asin(0.5 / std::hypot(1, thin)) - std::atan(thin);
    for (const Shape& floor :
         {make_half_space("floor", Vec3::UnitY(), 0), make_box("floor", Vec3(2, 1, 2)), box_mesh(Vec3(2, 1, 2))})
        for (int k = -1; k <= 6; ++k) {
            CAPTURE(to_string(floor.kind), k);
            const double turning = std::pow(10.0, k);
            const double floor_height = floor.kind == ShapeKind::half_space ? 0.0 : -1.0;
            Sweep sweep(world_of_moving({box_mesh(Vec3(1, thin, thin)), Vec3(0, 0.5, 0)}, Vec3::Zero(),
                                        Vec3(0, 0, -turning),
                                        {floor, Vec3(0, floor_height, 0), Quat::Identity(), true}));
            const double expected = angle / turning, found = sweep.impact(3 / turning);
            CHECK(found <= expected * (1 + 1e-14));
            CHECK(expected - found <= 1e-12 * expected);
        }
}

TEST_CASE("C3 graze: a ball that passes an edge touches it or not by the sign of the offset", "[impact]") {
    const double radius = 0.1, half = std::sqrt(0.5);
    for (int k = 1; k <= 15; ++k)
        for (const double sign : {-1.0, 1.0}) {
            const double offset = radius * (1 + sign * std::pow(10.0, -k));
            CAPTURE(k, sign);
            // The edge x = y = 0 of a quarter space; the ball passes it along (1, -1) at a distance of `offset`.
            Sweep sweep(world_of_moving({make_sphere("ball", radius), offset * Vec3(half, half, 0) + Vec3(-1, 1, 0)},
                                        Vec3(1, -1, 0), Vec3::Zero(),
                                        {box_mesh(Vec3(0.3, 0.3, 0.3)), Vec3(-0.3, -0.3, 0)}));
            const double found = sweep.impact(2);
            const bool within_touch = radius * std::pow(10.0, -k) <= 2 * sweep.touch();
            if (sign < 0) CHECK(found < 1 + 1e-3);
            if (sign > 0 && !within_touch) CHECK(found == infinity);
        }
}

TEST_CASE("C5 start touching: only what approaches meets at once", "[impact]") {
    for (const Shape& floor :
         {make_half_space("floor", Vec3::UnitY(), 0.5), make_box("floor", Vec3(2, 0.5, 2)), box_mesh(Vec3(2, 0.5, 2))})
        for (const Shape& body : {make_sphere("ball", 0.5), box_mesh(Vec3(0.5, 0.5, 0.5))}) {
            CAPTURE(to_string(floor.kind), to_string(body.kind));
            const auto impact = [&](const Vec3& velocity) {
                return Sweep(world_of_moving({body, Vec3(0.25, 1, 0.125)}, velocity, Vec3::Zero(), standing(floor)))
                    .impact(h);
            };
            CHECK(impact(Vec3(0, 1, 0)) == infinity);
            CHECK(impact(Vec3(1, 0, 0)) == infinity);
            CHECK(impact(Vec3(0, -1, 0)) == 0);
            CHECK(impact(Vec3(0, -1e-6, 0)) == 0);
        }
}

TEST_CASE("what stands above the floor within reach is in contact with its gap", "[impact]") {
    const double above = 1e-6;
    for (const Shape& floor :
         {make_half_space("floor", Vec3::UnitY(), 0.5), make_box("floor", Vec3(2, 0.5, 2)), box_mesh(Vec3(2, 0.5, 2))})
        for (const Shape& body : {make_sphere("ball", 0.5), box_mesh(Vec3(0.5, 0.5, 0.5))}) {
            CAPTURE(to_string(floor.kind), to_string(body.kind));
            Sweep sweep(
                world_of_moving({body, Vec3(0.25, 1 + above, 0.125)}, Vec3::Zero(), Vec3::Zero(), standing(floor)));
            CHECK(sweep.touching(0).empty());
            CHECK(sweep.touching(0, 0.9 * above).empty());
            const auto rows = sweep.touching(0, 1.1 * above);
            REQUIRE(rows.size() >= (body.kind == ShapeKind::sphere ? 1 : 4));
            for (const Contact& c : rows) {
                CHECK((c.normal - Vec3(0, -1, 0)).norm() < 1e-9);
                CHECK(c.depth == Approx(-above).epsilon(1e-6));
            }
        }
}

TEST_CASE("a cube that lands flat touches with its four corners", "[impact]") {
    for (const Shape& floor : {make_half_space("floor", Vec3::UnitY(), 0.5), make_box("floor", Vec3(2, 0.5, 2)),
                               box_mesh(Vec3(2, 0.5, 2))}) {
        CAPTURE(to_string(floor.kind));
        Sweep sweep(world_of_moving({box_mesh(Vec3(0.5, 0.5, 0.5)), Vec3(0.25, 1.1, 0.125)}, Vec3(0, -1, 0),
                                    Vec3::Zero(), standing(floor)));
        const double time = sweep.impact(1);
        CHECK(time == Approx(0.1).epsilon(1e-12));
        const auto rows = sweep.touching(time);
        for (const double x : {-0.5, 0.5})
            for (const double z : {-0.5, 0.5}) {
                const Vec3 corner(x, -0.5, z);
                CHECK(std::any_of(rows.begin(), rows.end(),
                                  [&](const Contact& c) { return (c.arm_a - corner).norm() < 1e-9; }));
            }
        for (const Contact& c : rows) CHECK((c.normal - Vec3(0, -1, 0)).norm() < 1e-12);
    }
}

TEST_CASE("no overlap comes before the time of impact, and one follows it: non-convex bodies that spin", "[impact]") {
    constexpr unsigned seed = 11;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 1);
    const auto vector = [&](double scale) {
        return Vec3(scale * Vec3(normal(random), normal(random), normal(random)));
    };
    const Shape shapes[] = {make_mesh("bar", u_bar()), make_mesh("spike", spike()), make_sphere("ball", 0.4),
                            make_box("box", Vec3(0.7, 0.4, 0.2))};
    int impacts = 0, misses = 0;
    for (int round = 0; round < 1500; ++round) {
        CAPTURE(round);
        const Quat turn_a(Eigen::Quaterniond(vector(1).homogeneous()).normalized());
        const Quat turn_b(Eigen::Quaterniond(vector(1).homogeneous()).normalized());
        World world = world_of({shapes[round % 4], vector(2), turn_a}, {shapes[round % 3], vector(2), turn_b});
        for (const std::uint32_t body : {0u, 1u}) {
            world.velocity[body] = vector(3);
            world.angular_velocity[body] = vector(5);
        }
        Sweep sweep(world);
        if (sweep.overlaps(0)) continue;
        const double until = 0.5, found = sweep.impact(until);
        ++(found < until ? impacts : misses);
        for (int i = 0; i <= 200; ++i) {
            const double time = until * i / 200;
            if (time < found) CHECK_FALSE(sweep.overlaps(time));
        }
        if (!(found < until)) continue;
        const auto rows = sweep.touching(found);
        REQUIRE(!rows.empty());
        const World there = sweep.world_at(found);
        double approach = 0;
        for (const Contact& c : rows)
            approach = std::max(approach, -c.normal.dot(there.velocity_at(1, c.arm_b) - there.velocity_at(0, c.arm_a)));
        CHECK(approach > 0);
        if (approach > 1e-2) CHECK(sweep.overlaps(found + 1e-7));
    }
    CHECK(impacts > 60);
    CHECK(misses > 60);
}
