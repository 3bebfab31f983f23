#include "oracle/rigid_bodies.h"

#include <kolize/world.h>

#include <catch2/catch.hpp>

using namespace kolize;

namespace {

// A right-angled tetrahedron far from its file's origin: centre of mass and principal axes are both off the file's.
TriangleSoup tetrahedron() {
    TriangleSoup soup;
    const Vec3 corner(3, -2, 5);
    soup.vertices = {corner, corner + Vec3(1, 0, 0), corner + Vec3(0, 2, 0), corner + Vec3(0, 0, 0.5)};
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return soup;
}

World world_with(Shape shape) {
    World world = empty_world();
    world.shapes.push_back(std::move(shape));
    return world;
}

// Six equal point masses on the principal axes that have the given moments over mass (m^2).
std::vector<Vec3> point_masses(const Vec3& moments) {
    std::vector<Vec3> points;
    for (int axis = 0; axis < 3; ++axis) {
        const double spread = moments.sum() / 2 - moments[axis];
        for (const double sign : {-1.0, 1.0}) points.push_back(sign * std::sqrt(3 * spread) * Vec3::Unit(axis));
    }
    return points;
}

std::string refusal(World world, const BodyDescription& body) {
    const std::size_t before = world.size();
    try {
        world.add(body);
    } catch (const std::invalid_argument& e) {
        REQUIRE(world.size() == before);
        return e.what();
    }
    return "";
}

}  // namespace

TEST_CASE("A mesh vertex stands where its model frame puts it, whatever the body frame is", "[world]") {
    const TriangleSoup soup = tetrahedron();
    World world = world_with(make_mesh("tetrahedron", soup));
    Random random(1);
    BodyDescription description;
    description.position = Vec3(10, 20, -30);
    description.orientation = random.rotation();
    const std::uint32_t body = world.add(description);

    const Mesh& mesh = *world.shape_of(body).mesh;
    const Transform pose = world.pose(body);
    for (std::size_t i = 0; i < soup.vertices.size(); ++i) {
        const Vec3 expected = description.position + description.orientation * soup.vertices[i];
        CHECK((pose * mesh.vertices[i] - expected).norm() < 1e-13);
    }
    CHECK((world.model_position(body) - description.position).norm() < 1e-13);
    CHECK(world.model_orientation(body).angularDistance(description.orientation) < 1e-13);
}

TEST_CASE("A half-space lies where normal and offset of its model frame say", "[world]") {
    World world = world_with(make_half_space("floor", Vec3(0, 2, 0), 3));
    BodyDescription description;
    description.is_static = true;
    description.position = Vec3(0, 1, 0);
    const std::uint32_t body = world.add(description);
    CHECK(world.position[body].y() == Approx(1 + 1.5));
    CHECK(world.model_position(body).y() == Approx(1));
    CHECK(world.inverse_mass[body] == 0);
    CHECK(world.world_inverse_inertia(body).isZero(0));
    CHECK(world.angular_momentum(body).isZero(0));
    CHECK(world.kinetic_energy(body) == 0);
    CHECK(world_bounds(world, body).min == Vec3::Constant(-infinity));
    CHECK(world_bounds(world, body).max == Vec3::Constant(infinity));
}

TEST_CASE("Energy and angular momentum are those of six point masses with the same inertia", "[world]") {
    Random random(2);
    for (int round = 0; round < 100; ++round) {
        CAPTURE(round);
        World world = empty_world();
        BodyDescription description;
        description.mass = random.uniform(0.1, 10);
        description.orientation = random.rotation();
        description.velocity = random.normal();
        description.angular_velocity = random.normal();
        const Vec3 moments = random.moments();
        const std::uint32_t body = add_body(world, moments, description);

        double energy = 0;
        Vec3 momentum = Vec3::Zero();
        for (const Vec3& point : point_masses(moments)) {
            const Vec3 arm = description.orientation * point;
            energy += description.mass / 12 * world.velocity_at(body, arm).squaredNorm();
            momentum += description.mass / 6 * arm.cross(description.angular_velocity.cross(arm));
        }
        CHECK(world.kinetic_energy(body) == Approx(energy).epsilon(1e-13));
        CHECK((world.angular_momentum(body) - momentum).norm() < 1e-13 * (1 + momentum.norm()));
        const Vec3 velocity = world.world_inverse_inertia(body) * momentum;
        CHECK((velocity - description.angular_velocity).norm() < 1e-10);
    }
}

TEST_CASE("A body without a mass takes density times volume", "[world]") {
    World world = world_with(make_box("brick", Vec3(0.5, 1, 1.5)));
    world.materials[0].density = 2000;
    const std::uint32_t body = world.add({});
    CHECK(1 / world.inverse_mass[body] == Approx(2000 * 6));
}

TEST_CASE("World bounds are the tightest box around the turned shape", "[world]") {
    Random random(3);
    const Shape box = make_box("box", Vec3(1, 2, 0.25));
    const Shape mesh = make_mesh("tetrahedron", tetrahedron());
    for (int round = 0; round < 100; ++round) {
        CAPTURE(round);
        BodyDescription description;
        description.position = 10 * random.normal();
        description.orientation = random.rotation();

        World boxes = world_with(box);
        const std::uint32_t turned_box = boxes.add(description);
        Aabb expected;
        for (const Vec3& vertex : box.mesh->vertices) expected.include(boxes.pose(turned_box) * vertex);
        const Aabb bounds = world_bounds(boxes, turned_box);
        CHECK((bounds.min - expected.min).norm() < 1e-13);
        CHECK((bounds.max - expected.max).norm() < 1e-13);

        World meshes = world_with(mesh);
        const std::uint32_t turned_mesh = meshes.add(description);
        const Aabb around = world_bounds(meshes, turned_mesh);
        for (const Vec3& vertex : mesh.mesh->vertices) {
            const Vec3 p = meshes.pose(turned_mesh) * vertex;
            CHECK((p.array() >= around.min.array() - 1e-13).all());
            CHECK((p.array() <= around.max.array() + 1e-13).all());
        }
    }
    World balls = world_with(make_sphere("ball", 2));
    BodyDescription description;
    description.position = Vec3(1, 2, 3);
    const Aabb ball = world_bounds(balls, balls.add(description));
    CHECK(ball.min == Vec3(-1, 0, 1));
    CHECK(ball.max == Vec3(3, 4, 5));
}

TEST_CASE("A body that cannot be is refused with its name and the cause, and nothing is added", "[world]") {
    World world = world_with(make_sphere("ball", 1));
    world.shapes.push_back(make_half_space("floor", Vec3::UnitY(), 0));
    BodyDescription body;
    body.name = "b";
    const auto refused = [&](auto change, const std::string& cause) {
        BodyDescription changed = body;
        change(changed);
        const std::string message = refusal(world, changed);
        CHECK_THAT(message, Catch::StartsWith("body 'b'") && Catch::Contains(cause));
    };
    const double nan = std::nan("");
    refused([&](auto& b) { b.position.y() = nan; }, "position is not finite");
    refused([&](auto& b) { b.orientation.w() = infinity; }, "orientation is not finite");
    refused([&](auto& b) { b.velocity.x() = nan; }, "velocity is not finite");
    refused([&](auto& b) { b.angular_velocity.z() = nan; }, "angular velocity is not finite");
    refused([&](auto& b) { b.constant_force.x() = nan; }, "constant force is not finite");
    refused([&](auto& b) { b.constant_torque.x() = nan; }, "constant torque is not finite");
    refused([&](auto& b) { b.mass = nan; }, "mass is not finite");
    refused([&](auto& b) { b.mass = -1; }, "mass must be positive");
    refused([&](auto& b) { b.mass = 1e-320; }, "mass");
    refused([&](auto& b) { b.orientation = Quat(0, 0, 0, 0); }, "orientation has no usable length");
    refused([&](auto& b) { b.shape = 7; }, "there is no shape 7");
    refused([&](auto& b) { b.material = 7; }, "there is no material 7");
    refused([&](auto& b) { b.shape = 1; }, "half_space has no mass");
    refused([&](auto& b) { b.is_static = true, b.velocity.x() = 1; }, "static body never moves");
    CHECK(refusal(world, body).empty());
}

TEST_CASE("Kinds are numbered once each, in the order of their first use", "[world]") {
    World world = world_with(make_sphere("ball", 1));
    for (const char* kind : {"ball", "missile", "ball"}) {
        BodyDescription body;
        body.kind = kind;
        world.add(body);
    }
    CHECK(world.kind == std::vector<std::uint32_t>{0, 1, 0});
    CHECK(world.kinds == std::vector<std::string>{"ball", "missile"});
}
