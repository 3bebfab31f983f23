// One contact at a time: closed forms and invariants.
#include "response/response_plugin.h"

using namespace kolize;

namespace {

// Answers one contact of bodies 0 and 1.
void hit(World& world, const Vec3& point, const Vec3& normal) {
    ResponsePlugin impulse("impulse");
    std::vector<Contact> contacts{contact_at(world, 0, 1, point, normal)};
    impulse.respond(world, contacts);
}

// The corner of a unit cube, cut off through its three neighbours: products of inertia in the axes of the cube.
void add_right_tetrahedron(World& world, BodyDescription body) {
    body.orientation = Quat::FromTwoVectors(Vec3::UnitX(), Vec3::Ones());
    add_body(world, Vec3(0.1, 0.0625, 0.0625), body);
}

bool within_ulps(double value, double expected, int ulps) {
    return std::abs(value - expected) <= ulps * std::numeric_limits<double>::epsilon() * std::abs(expected);
}

}  // namespace

TEST_CASE("R1 swap: equal spheres that meet head-on swap velocities exactly", "[impulse]") {
    World world = empty_world();
    add_ball(world, Vec3(-1, 0, 0), Vec3(1, 0, 0));
    add_ball(world, Vec3(1, 0, 0), Vec3(-1, 0, 0));
    hit(world, Vec3::Zero(), Vec3::UnitX());
    CHECK(world.velocity[0] == Vec3(-1, 0, 0));
    CHECK(world.velocity[1] == Vec3(1, 0, 0));
}

TEST_CASE("R2 mass ratio: head-on velocities are right to four ulp over thirty decades", "[impulse]") {
    for (int k = -15; k <= 15; ++k) {
        CAPTURE(k);
        const double m = std::pow(10.0, k);
        World world = empty_world();
        add_ball(world, Vec3(-1, 0, 0), Vec3(1, 0, 0), m);
        add_ball(world, Vec3(1, 0, 0), Vec3::Zero(), 1);
        hit(world, Vec3::Zero(), Vec3::UnitX());
        CHECK(within_ulps(world.velocity[0].x(), (m - 1) / (m + 1), 4));
        CHECK(within_ulps(world.velocity[1].x(), 2 * m / (m + 1), 4));
    }
}

TEST_CASE("R5 oblique: equal spheres part at a right angle", "[impulse]") {
    World world = empty_world();
    const Vec3 normal(std::sqrt(3) / 2, 0.5, 0);
    add_ball(world, -normal, Vec3(1, 0, 0));
    add_ball(world, normal, Vec3::Zero());
    hit(world, Vec3::Zero(), normal);
    CHECK((world.velocity[0] - Vec3(0.25, -std::sqrt(3) / 4, 0)).norm() < 1e-15);
    CHECK((world.velocity[1] - Vec3(0.75, std::sqrt(3) / 4, 0)).norm() < 1e-15);
    CHECK(world.angular_velocity[1].norm() < 1e-15);
}

TEST_CASE("R6 cube corner: a cube that lands on a corner leaves half its speed and spins", "[impulse]") {
    World world = empty_world();
    add_obstacle(world, Vec3(0, -5, 0));
    BodyDescription cube;
    cube.velocity = Vec3(0, -1, 0);
    add_body(world, Vec3::Constant(1.0 / 6), cube);
    ResponsePlugin impulse("impulse");
    std::vector<Contact> contacts{contact_at(world, 0, 1, Vec3(0.5, -0.5, 0.5), Vec3::UnitY())};
    impulse.respond(world, contacts);
    CHECK(contacts[0].impulse == Approx(0.5).epsilon(1e-15));
    CHECK((world.velocity[1] - Vec3(0, -0.5, 0)).norm() < 1e-15);
    CHECK((world.angular_velocity[1] - Vec3(-1.5, 0, 1.5)).norm() < 1e-15);
    CHECK(world.velocity[0].isZero(0));
    CHECK(world.angular_velocity[0].isZero(0));
}

TEST_CASE("R7 frame indifference: a thousand turns of the corner cube and of a tetrahedron turn the outcome",
          "[impulse]") {
    Random random(5);
    for (const bool tetrahedron : {false, true}) {
        World world = empty_world();
        add_obstacle(world, Vec3(0, -5, 0));
        BodyDescription body;
        body.velocity = Vec3(0, -1, 0);
        if (tetrahedron)
            add_right_tetrahedron(world, body);
        else
            add_body(world, Vec3::Constant(1.0 / 6), body);
        const Vec3 point(0.5, -0.5, 0.5);
        World expected = world;
        hit(expected, point, Vec3::UnitY());
        for (int round = 0; round < 1000; ++round) {
            CAPTURE(tetrahedron, round);
            const Quat turn = random.rotation();
            World turned = world;
            for (int i : {0, 1}) {
                turned.position[i] = turn * world.position[i];
                turned.orientation[i] = turn * world.orientation[i];
                turned.velocity[i] = turn * world.velocity[i];
            }
            hit(turned, turn * point, turn * Vec3::UnitY());
            CHECK((turned.velocity[1] - turn * expected.velocity[1]).norm() < 1e-14);
            CHECK((turned.angular_velocity[1] - turn * expected.angular_velocity[1]).norm() < 1e-14);
        }
    }
}

TEST_CASE("Naming the two bodies the other way round changes not a bit", "[impulse]") {
    Random random(6);
    for (int round = 0; round < 1000; ++round) {
        CAPTURE(round);
        World world = empty_world();
        add_random_body(world, random);
        add_random_body(world, random);
        const Contact c = contact_at(world, 0, 1, random.normal(), random.direction());
        std::vector<Contact> one_way{c};
        std::vector<Contact> other_way{c};
        other_way[0].a = 1, other_way[0].b = 0;
        std::swap(other_way[0].arm_a, other_way[0].arm_b);
        other_way[0].normal = -c.normal;
        World other = world;
        ResponsePlugin impulse("impulse");
        impulse.respond(world, one_way);
        impulse.respond(other, other_way);
        CHECK(world.velocity == other.velocity);
        CHECK(world.angular_velocity == other.angular_velocity);
        CHECK(one_way[0].impulse == other_way[0].impulse);
    }
}

TEST_CASE("R8 full tensor: 100000 impacts of a tetrahedron keep energy, momentum and angular momentum", "[impulse]") {
    Random random(7);
    World world = empty_world();
    BodyDescription body;
    body.velocity = random.normal();
    body.angular_velocity = random.normal();
    add_right_tetrahedron(world, body);
    add_random_body(world, random);
    const Invariants start(world);
    ResponsePlugin impulse("impulse");
    double worst_energy = 0, worst_momentum = 0, worst_angular_momentum = 0, worst_reversal = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 point = 3 * random.normal();  // more often outside the bodies than not
        std::vector<Contact> contacts{contact_at(world, 0, 1, point, random.direction())};
        double speed = normal_velocity(world, contacts[0]);
        if (speed > 0) {
            contacts[0].normal = -contacts[0].normal;
            speed = -speed;
        }
        const Invariants before(world);
        impulse.respond(world, contacts);
        const Invariants after(world);
        const double scale = contacts[0].impulse * (1 + point.norm()) + before.momentum_scale;
        worst_energy = std::max(worst_energy, std::abs(after.energy / before.energy - 1));
        worst_momentum = std::max(worst_momentum, (after.momentum - before.momentum).norm() / scale);
        worst_angular_momentum =
            std::max(worst_angular_momentum, (after.angular_momentum - before.angular_momentum).norm() / scale);
        worst_reversal = std::max(worst_reversal, std::abs(normal_velocity(world, contacts[0]) + speed));
    }
    CAPTURE(worst_energy, worst_momentum, worst_angular_momentum);
    CHECK(worst_energy < 2e-15);
    CHECK(worst_momentum < 1e-15);
    CHECK(worst_angular_momentum < 1e-15);
    CHECK(worst_reversal < 1e-12);
    const Invariants end(world);
    CHECK(std::abs(end.energy / start.energy - 1) < 1e-12);
    CHECK((end.momentum - start.momentum).norm() < 1e-12 * start.momentum_scale);
    CHECK((end.angular_momentum - start.angular_momentum).norm() < 1e-12 * start.momentum_scale);
}

TEST_CASE("R9 Zeno: the heights of a ball that bounces at 0.5 fall by a quarter each, down to nothing", "[impulse]") {
    // Each impact is given exactly: what comes up with speed v from the ground comes down with it.
    const double gravity = 9.81, restitution = 0.5;
    World world = empty_world();
    world.materials[0].restitution = restitution;
    const std::uint32_t floor = add_obstacle(world);
    const std::uint32_t ball = add_ball(world, Vec3(0, 0, 1), Vec3(0, 0, -std::sqrt(2 * gravity)));
    ResponsePlugin impulse("impulse");
    double time = std::sqrt(2 / gravity);
    for (int bounce = 1; bounce <= 500; ++bounce) {
        CAPTURE(bounce);
        std::vector<Contact> contacts{contact_at(world, floor, ball, Vec3::Zero(), Vec3::UnitZ())};
        impulse.respond(world, contacts);
        const double speed = world.velocity[ball].z();
        CHECK(speed * speed / (2 * gravity) == Approx(std::pow(restitution, 2 * bounce)).epsilon(1e-13));
        time += 2 * speed / gravity;
        world.velocity[ball].z() = -speed;
    }
    CHECK(time == Approx(std::sqrt(2 / gravity) * (1 + restitution) / (1 - restitution)).epsilon(1e-13));
    CHECK(time == Approx(1.354570923).epsilon(1e-9));
    world.velocity[ball].setZero();
    std::vector<Contact> contacts{contact_at(world, floor, ball, Vec3::Zero(), Vec3::UnitZ())};
    impulse.respond(world, contacts);
    CHECK(world.velocity[ball].isZero(0));
    CHECK(impulse.unresolved == 0);
}

TEST_CASE("Restitution scales the parting speed, and the lost energy is reported", "[impulse]") {
    Random random(8);
    for (int tenths = 0; tenths <= 10; ++tenths) {
        const double restitution = tenths / 10.0;
        CAPTURE(restitution);
        World world = empty_world();
        world.materials[0].restitution = restitution;
        add_random_body(world, random);
        add_random_body(world, random);
        std::vector<Contact> contacts{contact_at(world, 0, 1, random.normal(), random.direction())};
        double speed = normal_velocity(world, contacts[0]);
        if (speed > 0) {
            contacts[0].normal = -contacts[0].normal;
            speed = -speed;
        }
        const double before = Invariants(world).energy;
        ResponsePlugin impulse("impulse");
        impulse.respond(world, contacts);
        CHECK(normal_velocity(world, contacts[0]) == Approx(-restitution * speed).margin(1e-13));
        CHECK(before - Invariants(world).energy == Approx(impulse.dissipated_J).margin(1e-14 * before));
    }
}

TEST_CASE("Of two restitutions the larger one counts", "[impulse]") {
    World world = empty_world();
    world.materials[0].restitution = 0.2;
    add_ball(world, Vec3(-1, 0, 0), Vec3(1, 0, 0));
    world.materials.push_back({"rubber", 0.5, 0, 1000});
    BodyDescription other;
    other.material = 1;
    other.position = Vec3(1, 0, 0);
    add_body(world, Vec3::Constant(0.4), other);
    hit(world, Vec3::Zero(), Vec3::UnitX());
    CHECK(world.velocity[1].x() - world.velocity[0].x() == Approx(0.5));
}

TEST_CASE("Bodies that part or rest are left as they are", "[impulse]") {
    World world = empty_world();
    add_ball(world, Vec3(-1, 0, 0), Vec3(-1, 0, 0));
    add_ball(world, Vec3(1, 0, 0), Vec3(2, 0, 0));
    std::vector<Contact> contacts{contact_at(world, 0, 1, Vec3::Zero(), Vec3::UnitX())};
    contacts[0].impulse = 7;  // left over from another step
    ResponsePlugin impulse("impulse");
    impulse.respond(world, contacts);
    CHECK(contacts[0].impulse == 0);
    CHECK(world.velocity[0].x() == -1);
    world.velocity = {Vec3::Zero(), Vec3::Zero()};
    impulse.respond(world, contacts);
    CHECK(contacts[0].impulse == 0);
    CHECK(impulse.unresolved == 0);
    std::vector<Contact> none;
    impulse.respond(world, none);
    CHECK(impulse.events.empty());
}
