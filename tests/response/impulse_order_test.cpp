// What the numbers of the bodies, the place and the attitude of the scene have to do with the outcome: nothing.
#include "response/response_plugin.h"

#include <numeric>

using namespace kolize;

namespace {

// Bodies that touch each other at random, and an obstacle.
struct Crowd {
    World world = empty_world();
    std::vector<Contact> contacts;

    Crowd(Random& random, int bodies, int count) {
        add_obstacle(world);
        for (int i = 0; i < bodies; ++i) add_random_body(world, random);
        while (static_cast<int>(contacts.size()) < count) {
            const auto a = static_cast<std::uint32_t>(random.uniform(0, bodies));
            const auto b = static_cast<std::uint32_t>(random.uniform(a + 1, bodies + 1));
            contacts.push_back(contact_at(world, a, b, random.normal(), random.direction()));
        }
        sort_canonically(contacts);
    }
};

// The same scene with body i as body number[i].
Crowd renumbered(const Crowd& crowd, const std::vector<std::uint32_t>& number) {
    Crowd result = crowd;
    for (std::uint32_t i = 0; i < number.size(); ++i) {
        result.world.set_state(number[i], crowd.world.state(i));
        result.world.inverse_mass[number[i]] = crowd.world.inverse_mass[i];
        result.world.inverse_inertia[number[i]] = crowd.world.inverse_inertia[i];
        result.world.is_static[number[i]] = crowd.world.is_static[i];
    }
    for (Contact& c : result.contacts) {
        c.a = number[c.a];
        c.b = number[c.b];
        if (c.a < c.b) continue;
        std::swap(c.a, c.b);
        std::swap(c.arm_a, c.arm_b);
        c.normal = -c.normal;
    }
    sort_canonically(result.contacts);
    return result;
}

std::vector<std::uint32_t> shuffled(std::size_t count, Random& random) {
    std::vector<std::uint32_t> number(count);
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), random.engine());
    return number;
}

// The largest difference of a velocity, where body i of one scene is body number[i] of the other.
double difference(const World& one, const World& other, const std::vector<std::uint32_t>& number) {
    double worst = 0;
    for (std::uint32_t i = 0; i < number.size(); ++i) {
        worst = std::max(worst, (one.velocity[i] - other.velocity[number[i]]).norm());
        worst = std::max(worst, (one.angular_velocity[i] - other.angular_velocity[number[i]]).norm());
    }
    return worst;
}

}  // namespace

TEST_CASE("Sequential order gives the same bits however the bodies are numbered", "[impulse][order]") {
    for (unsigned seed = 90; seed < 190; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        Crowd crowd(random, 6, 8);
        const std::vector<std::uint32_t> number = shuffled(crowd.world.size(), random);
        Crowd other = renumbered(crowd, number);
        ResponsePlugin impulse("impulse");
        impulse.respond(crowd.world, crowd.contacts);
        impulse.respond(other.world, other.contacts);
        CHECK(difference(crowd.world, other.world, number) == 0);
    }
}

TEST_CASE("Symmetric order gives the same to rounding however the bodies are numbered", "[impulse][order]") {
    for (const double restitution : {1.0, 0.5, 0.0})
        for (unsigned seed = 200; seed < 300; ++seed) {
            CAPTURE(restitution, seed);
            Random random(seed);
            Crowd crowd(random, 6, 8);
            crowd.world.materials[0].restitution = restitution;
            const std::vector<std::uint32_t> number = shuffled(crowd.world.size(), random);
            Crowd other = renumbered(crowd, number);
            ResponsePlugin impulse("impulse", {{"order", std::string("symmetric")}});
            impulse.respond(crowd.world, crowd.contacts);
            impulse.respond(other.world, other.contacts);
            CHECK(difference(crowd.world, other.world, number) < 1e-10);
        }
}

TEST_CASE("Symmetric order keeps the symmetry of a break", "[impulse][order]") {
    // A cue ball hits a triangle of touching balls on its axis.
    const int rows = 5;
    World world = empty_world();
    add_ball(world, Vec3(-2, 0, 0), Vec3(1, 0, 0));
    std::vector<Contact> contacts;
    for (int row = 0; row < rows; ++row)
        for (int i = 0; i <= row; ++i) add_ball(world, Vec3(std::sqrt(3) * row, 2 * i - row, 0), Vec3::Zero());
    for (std::uint32_t a = 0; a < world.size(); ++a)
        for (std::uint32_t b = a + 1; b < world.size(); ++b) {
            const Vec3 between = world.position[b] - world.position[a];
            if (between.norm() < 2.1)
                contacts.push_back(contact_at(world, a, b, world.position[a] + 0.5 * between, between.normalized()));
        }
    ResponsePlugin impulse("impulse", {{"order", std::string("symmetric")}});
    impulse.respond(world, contacts);
    CHECK(impulse.unresolved == 0);
    CHECK(Invariants(world).energy == Approx(0.5).epsilon(1e-14));
    CHECK(Invariants(world).momentum.x() == Approx(1).epsilon(1e-14));
    for (int row = 0, first = 1; row < rows; first += ++row)
        for (int i = 0; i <= row; ++i) {
            CAPTURE(row, i);
            const Vec3 &here = world.velocity[first + i], &mirrored = world.velocity[first + row - i];
            CHECK((here - Vec3(mirrored.x(), -mirrored.y(), 0)).norm() < 1e-13);
        }
}

TEST_CASE("Approaches that are the same to the last bit are answered in canonical order", "[impulse][order]") {
    World world = empty_world();
    add_ball(world, Vec3::Zero(), Vec3(1, 0, 0));
    const Vec3 up(0.8, 0.6, 0), down(0.8, -0.6, 0);
    add_ball(world, 2 * up, Vec3::Zero());
    add_ball(world, 2 * down, Vec3::Zero());
    std::vector<Contact> contacts{contact_at(world, 0, 1, up, up), contact_at(world, 0, 2, down, down)};
    ResponsePlugin impulse("impulse");
    impulse.respond(world, contacts);
    CHECK(world.velocity[1].norm() > world.velocity[2].norm());
}

TEST_CASE("Turning a scene of many contacts turns the outcome, and moving it far away changes nothing",
          "[impulse][order]") {
    for (const std::string order : {"sequential", "symmetric"})
        for (const double restitution : {1.0, 0.5, 0.0})
            for (unsigned seed = 300; seed < 340; ++seed) {
                CAPTURE(order, restitution, seed);
                Random random(seed);
                Crowd crowd(random, 4, 5);
                crowd.world.materials[0].restitution = restitution;
                const Quat turn = random.rotation();
                Crowd far = crowd, turned = crowd;
                for (std::size_t i = 0; i < crowd.world.size(); ++i) {
                    far.world.position[i] += Vec3(1e6, -1e6, 1e6);
                    turned.world.orientation[i] = turn * crowd.world.orientation[i];
                    turned.world.velocity[i] = turn * crowd.world.velocity[i];
                    turned.world.angular_velocity[i] = turn * crowd.world.angular_velocity[i];
                }
                for (Contact& c : turned.contacts) {
                    c.normal = turn * c.normal;
                    c.arm_a = turn * c.arm_a;
                    c.arm_b = turn * c.arm_b;
                }
                ResponsePlugin impulse("impulse", {{"order", order}});
                impulse.respond(crowd.world, crowd.contacts);
                impulse.respond(far.world, far.contacts);
                impulse.respond(turned.world, turned.contacts);
                CHECK(far.world.velocity == crowd.world.velocity);
                CHECK(far.world.angular_velocity == crowd.world.angular_velocity);
                for (std::size_t i = 0; i < crowd.world.size(); ++i) {
                    CHECK((turned.world.velocity[i] - turn * crowd.world.velocity[i]).norm() < 1e-10);
                    CHECK((turned.world.angular_velocity[i] - turn * crowd.world.angular_velocity[i]).norm() < 1e-10);
                }
            }
}
