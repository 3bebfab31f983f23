// Capsules against every other shape: by dense sampling of the core, closed forms, and in motion.
#include "framework/scenes.h"
#include "framework/solids.h"
#include "framework/volumes_of_shapes.h"
#include "narrowphase/solids.h"
#include "narrowphase/two_bodies.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

Vec3 random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return {uniform(random), uniform(random), uniform(random)};
}

// How far a point lies outside of a body's surface; below 0 inside. Of meshes by all their triangles.
double height_above(const World& world, std::uint32_t body, const Vec3& p) {
    const Shape& shape = world.shape_of(body);
    const Vec3 local = world.orientation[body].conjugate() * (p - world.position[body]);
    switch (shape.kind) {
    case ShapeKind::sphere: return local.norm() - shape.radius;
    case ShapeKind::half_space: return shape.normal.dot(local);
    case ShapeKind::capsule: {
        const double along = std::clamp(local.y(), -shape.half_height, shape.half_height);
        return (local - Vec3(0, along, 0)).norm() - shape.cap_radius;
    }
    default: break;
    }
    double nearest = infinity, winding = 0;
    for (const Triangle& t : shape.mesh->triangles) {
        const Vec3 a = shape.mesh->vertices[t[0]] - local, b = shape.mesh->vertices[t[1]] - local,
                   c = shape.mesh->vertices[t[2]] - local;
        // Of the solid angle's sum: Van Oosterom and Strackee 1983.
        winding += std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                     b.dot(c) * a.norm() + c.dot(a) * b.norm());
        const Vec3 n = (b - a).cross(c - a);
        const Vec3 foot = n * (n.dot(a) / n.squaredNorm());
        const auto within = [&](const Vec3& u, const Vec3& v) { return n.dot((v - u).cross(foot - u)) >= 0; };
        if (within(a, b) && within(b, c) && within(c, a)) nearest = std::min(nearest, foot.norm());
        for (const auto& [u, v] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
            const double s = std::clamp(-u.dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
            nearest = std::min(nearest, (u + s * (v - u)).norm());
        }
    }
    return winding > 3 ? -nearest : nearest;
}

struct Lowest {
    double height = infinity;
    Vec3 at = Vec3::Zero();
};

Lowest lowest_of_core(const World& world, std::uint32_t capsule, std::uint32_t other) {
    const double half = world.shape_of(capsule).half_height;
    const Vec3 middle = world.position[capsule], axis = world.orientation[capsule] * Vec3(0, half, 0);
    Lowest lowest;
    double from = -1, to = 1;
    for (int round = 0; round < 4; ++round) {
        double best = from;
        for (int i = 0; i <= 200; ++i) {
            const double s = from + (to - from) * i / 200;
            const double height = height_above(world, other, middle + s * axis);
            if (height < lowest.height) lowest = {height, middle + s * axis}, best = s;
        }
        const double step = (to - from) / 200;
        from = std::max(-1.0, best - 2 * step), to = std::min(1.0, best + 2 * step);
    }
    return lowest;
}

std::vector<Shape> partners() {
    std::mt19937 random(7);
    std::vector<Vec3> points;
    for (int i = 0; i < 20; ++i) points.push_back(0.6 * random_vector(random, 1).normalized());
    return {make_sphere("sphere", 0.5),
            make_box("box", Vec3(0.6, 0.3, 0.4)),
            make_capsule("capsule", 0.25, 0.5),
            make_hull("hull", points),
            make_mesh("bar", u_bar()),
            make_mesh("cone", cone(12, 0.5, 1)),
            make_half_space("floor", Vec3(0, 1, 0), 0)};
}

}  // namespace

TEST_CASE("A capsule overlaps what comes nearer to its core than its radius, and as deep", "[narrowphase][capsule]") {
    const unsigned seed = 20261125;
    CAPTURE(seed);
    std::mt19937 random(seed);
    NarrowphaseUnderTest stage("moller", {});
    const Shape capsule = make_capsule("pill", 0.2, 0.5);
    for (const Shape& other : partners()) {
        int shallow = 0, deep = 0, apart = 0;
        for (int round = 0; round < 300; ++round) {
            const bool first = round % 2 == 0;
            const Placed pill{capsule, random_vector(random, 1), Quat(any_rotation(random))};
            const Placed partner{other, random_vector(random, 0.3), Quat(any_rotation(random)),
                                 other.kind == ShapeKind::half_space};
            World world = first ? world_of(pill, partner) : world_of(partner, pill);
            const std::uint32_t id = first ? 0 : 1;
            const Lowest lowest = lowest_of_core(world, id, 1 - id);
            CAPTURE(other.name, round, lowest.height);
            const auto rows = stage.collide(world, Detail::manifold).rows;
            REQUIRE(rows.empty() == !(lowest.height < 0.2));
            REQUIRE(stage.collide(world, Detail::overlap).rows.empty() == rows.empty());
            apart += rows.empty();
            double deepest = 0;
            for (const Contact& row : rows) {
                CHECK(std::abs(row.normal.norm() - 1) < 1e-12);
                CHECK(row.depth > 0);
                deepest = std::max(deepest, row.depth);
                // The point lies in the capsule, and in the other or, at its corners, as far out as the overlap is
                // deep.
                const Vec3 point = point_of(world, row);
                if (lowest.height > 1e-3) {
                    CHECK(height_above(world, id, point) < 1e-9);
                    CHECK(height_above(world, 1 - id, point) < 0.5 * row.depth + 1e-9);
                }
            }
            if (!rows.empty() && lowest.height > 1e-3) {
                ++shallow;
                CHECK(deepest == Approx(0.2 - lowest.height).margin(1e-5));
            }
            deep += lowest.height < 0;
        }
        CAPTURE(other.name);
        CHECK(shallow > 10);
        CHECK(deep > 10);
        CHECK(apart > 10);
    }
}

TEST_CASE("A capsule lies on a face at both its ends, and over an edge at the edge", "[narrowphase][capsule]") {
    NarrowphaseUnderTest stage("moller", {});
    const Shape capsule = make_capsule("pill", 0.2, 0.5);
    const Quat lying(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()));
    for (const double tilt : {0.0, 1e-3}) {
        CAPTURE(tilt);
        const Quat turn = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitZ())) * lying;
        // On a table that is wider than it, and on a block that it overhangs on both sides.
        for (const double half : {2.0, 0.3}) {
            CAPTURE(half);
            const auto rows = stage
                                  .collide(world_of({make_box("block", Vec3(half, 1, 1)), Vec3::Zero()},
                                                    {capsule, Vec3(0, 1.195, 0), turn}),
                                           Detail::manifold)
                                  .rows;
            REQUIRE(rows.size() == 2);
            const double width = std::abs(rows[0].arm_a.x() - rows[1].arm_a.x());
            CHECK(width == Approx(2 * std::min(half, 0.5)).margin(1e-3));
            for (const Contact& row : rows) {
                CHECK((row.normal - Vec3::UnitY()).norm() < 2 * tilt + 1e-12);
                CHECK(row.depth == Approx(0.005).margin(0.5 * tilt + 1e-9));
            }
        }
    }
}

TEST_CASE("Capsules, bars and balls keep their energy in a room", "[narrowphase][capsule]") {
    for (const char* mode : {"discrete", "continuous"}) {
        CAPTURE(mode);
        Scene scene = gas(make_capsule("pill", 0.4, 0.6), 3, 2.6, 5);
        const std::uint32_t bar = add_shape(scene, make_mesh("bar", u_bar())),
                            ball = add_shape(scene, make_sphere("ball", 0.4)),
                            box = add_shape(scene, make_box("box", Vec3(0.4, 0.5, 0.3)));
        std::uint32_t number = 0;
        for (std::uint32_t body = 0; body < scene.world.size(); ++body) {
            const BodyState state = scene.world.state(body);
            const std::uint32_t shape = std::array{scene.world.shape[body], bar, ball, box}[number++ % 4];
            scene.world.shape[body] = shape;
            const Vec3 inertia = scene.world.shapes[shape].moments;
            scene.world.inverse_inertia[body] = inertia.cwiseInverse();
            scene.world.set_state(body, state);
        }
        scene.pipeline.step.mode = mode;
        const RunResult result = run(scene, 400);
        CHECK(result.contacts > 20);
        CHECK(result.energy_drift < 1e-12);
        CHECK(result.momentum_drift < 1e-11);
        CHECK(result.escaped == 0);
        CHECK(result.stuck == 0);
        if (mode == std::string("continuous")) CHECK(result.max_penetration_m == 0);
    }
}

// A rod that turns about its middle, 0.5 above a floor: its end comes down when sin(w t) * half = 0.5 - radius.
TEST_CASE("A turning capsule meets the floor when its end comes down", "[narrowphase][capsule]") {
    const Quat lying(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()));
    for (const double speed : {0.1, 10.0, 1000.0}) {
        Scene scene = empty_scene();
        scene.world.materials[0].restitution = 1;
        BodyDescription floor;
        floor.shape = add_shape(scene, make_half_space("floor", Vec3::UnitY(), 0));
        floor.is_static = true;
        scene.world.add(floor);
        BodyDescription rod;
        give(rod, add_shape(scene, make_capsule("rod", 0.1, 1)), Vec3(0, 0.5, 0), Vec3::Zero());
        rod.orientation = lying;
        rod.angular_velocity = Vec3(0, 0, speed);
        scene.world.add(rod);
        scene.pipeline.step.mode = "continuous";
        const double meets = std::asin(0.4) / speed;
        // Just before it spins as it did; just after it does not.
        for (const double share : {1 - 1e-9, 1 + 1e-9}) {
            constexpr int steps = 64;  // a large turn in one step is not exact to that
            scene.pipeline.step.dt = share * meets / steps;
            CAPTURE(speed, share);
            const auto host = make_host(1);
            Simulation simulation(scene, plugins(), *host, steps);
            for (int i = 0; i < steps; ++i) simulation.step();
            CHECK((simulation.result().contacts > 0) == (share > 1));
        }
    }
}
