#include "metamorphic.h"

#include "response_under_test.h"

#include <optional>

namespace kolize {

namespace {

constexpr double dt = 0.01;     // s
constexpr double radius = 0.5;  // m, of the ball

// A ball that touches a floor, body 0, whose surface is the plane y = 0.
ImpactScene ball_on_floor(double restitution, double friction) {
    ImpactScene scene;
    World& world = scene.world;
    world.materials.push_back({"material", restitution, friction, 1000});
    world.shapes = {make_box("floor", Vec3(10, 1, 10)), make_sphere("ball", radius)};
    world.forces.gravity = Vec3(0, -9.81, 0);
    BodyDescription floor, ball;
    floor.is_static = true;
    floor.position = Vec3(0, -1, 0);
    ball.shape = 1;
    ball.mass = 1;
    ball.position = Vec3(0, radius, 0);
    world.add(floor);
    world.add(ball);
    scene.hit = {3};
    return scene;
}

// Between the floor and the ball where it is; depth 0 or less: they are apart.
Contact floor_contact(const World& world) {
    Contact contact;
    contact.a = 0;
    contact.b = 1;
    contact.normal = Vec3::UnitY();
    contact.depth = radius - world.position[1].y();
    const Vec3 point(world.position[1].x(), -contact.depth / 2, world.position[1].z());
    contact.arm_a = point - world.position[0];
    contact.arm_b = point - world.position[1];
    return contact;
}

class MetamorphicResponse : ResponseUnderTest {
public:
    using ResponseUnderTest::ResponseUnderTest;

    void mirrored_scenes() const {
        const Vec3 mirror(-1, 1, 1);
        for_few_contacts([&](const ImpactScene& scene) {
            const World here = respond(scene).scene.world, there = respond(mirrored(scene)).scene.world;
            for (std::uint32_t i = 0; i < here.size(); ++i)
                if (!close(there, i, mirror.cwiseProduct(here.velocity[i]),
                           -mirror.cwiseProduct(here.angular_velocity[i])))
                    violate("body " + std::to_string(i) + " moves otherwise in a mirror", scene);
        });
    }

    void masses_scaled() const {
        for_few_contacts([&](const ImpactScene& scene) {
            const World expected = respond(scene).scene.world;
            for (const double by : {0x1p-30, 0x1p30}) {
                const World scaled = respond(heavier(scene, by)).scene.world;
                for (std::uint32_t i = 0; i < expected.size(); ++i)
                    if (!close(scaled, i, expected.velocity[i], expected.angular_velocity[i]))
                        violate("body " + std::to_string(i) + " moves otherwise when all masses are scaled", scene);
            }
        });
    }

    // Nothing tells rest from steady motion but a static body.
    void seen_in_motion() const {
        const Vec3 more(3, -2, 1);
        for_few_contacts([&](ImpactScene scene) {
            for (const Contact& c : scene.contacts)
                if (scene.world.is_static[c.a] || scene.world.is_static[c.b]) return;
            const World here = respond(scene).scene.world;
            for (Vec3& velocity : scene.world.velocity) velocity += more;
            const World there = respond(scene).scene.world;
            for (std::uint32_t i = 0; i < here.size(); ++i)
                if (!close(there, i, here.velocity[i] + more, here.angular_velocity[i]))
                    violate("body " + std::to_string(i) + " moves otherwise when all bodies are faster", scene);
        });
    }

    // Either it refuses, in a sentence, or what it gives is finite.
    void parameters() const {
        const ImpactScene scene = impacts(20, 0.5, options_.seed);
        for_each_setting([&](const std::string& what, const Settings& settings) {
            const auto host = make_host(1);
            const auto stage = make_if_it_can(*host, settings);
            if (!stage) return;
            const World after = respond(**stage, scene).scene.world;
            for (std::size_t i = 0; i < after.size(); ++i)
                if (!after.velocity[i].allFinite() || !after.angular_velocity[i].allFinite())
                    throw Violation(what + ": a velocity is not finite");
        });
    }

    void needs_what_it_uses() const {
        if (capabilities().needs > capabilities().uses)
            throw Violation("it declares that it needs " + std::string(to_string(capabilities().needs)) +
                            ", and uses no more than " + to_string(capabilities().uses));
    }

    void friction() const {
        if (!capabilities().friction)
            return for_each_scene([&](ImpactScene scene) {
                const World smooth = respond(scene).scene.world;
                for (Material& material : scene.world.materials) material.friction = 0.7;
                expect_same(respond(scene).scene.world, smooth,
                            "it declares no friction, and with a coefficient of 0.7", scene);
            });
        constexpr double coefficient = 0.3;
        ImpactScene scene = ball_on_floor(0, coefficient);
        scene.world.velocity[1] = Vec3(4, -1, 3);
        scene.contacts = {floor_contact(scene.world)};
        const Contact c = respond(scene).scene.contacts[0];
        if (!(c.friction.dot(scene.world.velocity[1]) < 0))
            violate("it declares friction, and nothing holds a ball that slides", scene);
        if (!(c.friction.norm() <= coefficient * c.impulse * (1 + 1e-9)) || !(std::abs(c.friction.y()) <= 1e-9))
            violate("friction leaves its cone", scene);
    }

    // That it moves nothing without declaring it is checked where all it writes is.
    void moves() const {
        if (!capabilities().moves) throw Inapplicable("it does not declare that it moves bodies");
        ImpactScene scene = ball_on_floor(0, 0);
        scene.world.position[1].y() -= 0.2;
        scene.contacts = {floor_contact(scene.world)};
        if (!(respond(scene).scene.world.position[1].y() > scene.world.position[1].y()))
            violate("it declares that it moves bodies apart, and leaves a ball 0.2 m deep in the floor", scene);
    }

    void rests() const {
        if (!capabilities().rests) throw Inapplicable("it does not declare that it models resting contact");
        ImpactScene scene = ball_on_floor(0.5, 0.5);
        World& world = scene.world;
        world.position[1].y() += 0.05;
        const auto host = make_host(1);
        const auto stage = make(*host);
        const double step = world.forces.gravity.norm() * dt;  // m/s
        for (int i = 0; i < 400; ++i) {
            fall(*stage, scene);
            if (i < 350) continue;
            if (!(std::abs(world.position[1].y() - radius) < 0.05 * radius) || !(world.velocity[1].norm() < 2 * step))
                violate("it declares resting contact, and a ball dropped on a floor does not come to rest within 3.5 s",
                        scene);
        }
    }

    // Whatever it takes to lay bodies to sleep may be a parameter; what touches a sleeping body always wakes it.
    void sleeps() const {
        if (!capabilities().sleeps) throw Inapplicable("it does not declare that it lays bodies to sleep");
        ImpactScene scene = ball_on_floor(0, 0.5);
        scene.world.position[1].y() -= 1e-4;
        scene.contacts = {floor_contact(scene.world)};
        bool slept = false;
        for_each_setting([&](const std::string&, const Settings& settings) {
            const auto host = make_host(1);
            const auto stage = make_if_it_can(*host, settings);
            if (stage && !slept) slept = falls_asleep(**stage, scene);
        });
        if (!slept) violate("it declares sleep, and a ball at rest sleeps in no setting of one parameter", scene);
        wakes();
    }

private:
    template <class CheckScene>
    void for_few_contacts(CheckScene&& check) const {
        for (std::uint64_t seed = options_.seed; seed < options_.seed + 20; ++seed)
            for (const std::size_t count : {1, 2}) check(impacts(count, 1, seed));
    }

    // The defaults, and each parameter at its ends and at 1, the others at their defaults.
    template <class CheckSettings>
    void for_each_setting(CheckSettings&& check) const {
        check("the defaults", Settings{});
        for (const Parameter& parameter : plugin_.parameters.items) {
            std::vector<Value> values = values_to_try(parameter);
            if (std::holds_alternative<double>(parameter.default_value)) values.emplace_back(1.0);
            for (const Value& value : values)
                check(parameter.name + " = " + to_string(value), Settings{{parameter.name, {value, {}}}});
        }
    }

    // Nothing where the value is refused.
    std::optional<StagePtr<Response>> make_if_it_can(Host& host, const Settings& settings) const {
        try {
            return make(host, settings);
        } catch (const Error&) {
            return std::nullopt;
        }
    }

    // A step as the framework takes it: bodies move first, and then contacts are answered.
    static void fall(Response& stage, ImpactScene& scene) {
        World& world = scene.world;
        const Vec3 before = world.velocity[1];
        if (!world.asleep[1]) {
            world.velocity[1] += dt * world.forces.gravity;
            world.position[1] += dt / 2 * (before + world.velocity[1]);
        }
        scene.contacts = {floor_contact(world)};
        if (scene.contacts[0].depth > 0) scene = respond(stage, scene).scene;
    }

    static bool falls_asleep(Response& stage, ImpactScene scene) {
        for (int step = 0; step < 2000 && !scene.world.asleep[1]; ++step) fall(stage, scene);
        return scene.world.asleep[1];
    }

    void wakes() const {
        ImpactScene scene = ball_on_floor(0, 0);
        World& world = scene.world;
        BodyDescription other;
        other.shape = 1;
        other.mass = 1;
        other.position = Vec3(0, 3 * radius - 1e-3, 0);
        other.velocity = Vec3(0, -5, 0);
        world.add(other);
        world.asleep[1] = 1;
        Contact contact;
        contact.a = 1;
        contact.b = 2;
        contact.normal = Vec3::UnitY();
        contact.depth = 1e-3;
        contact.arm_a = Vec3(0, radius, 0);
        contact.arm_b = world.position[1] + contact.arm_a - world.position[2];
        scene.contacts = {contact};
        if (respond(scene).scene.world.asleep[1]) violate("a sleeping ball that is hit at 5 m/s sleeps on", scene);
    }
};

}  // namespace

void check_metamorphic_response(const PluginLibrary& library, const LoadedPlugin& plugin,
                                const ConformanceOptions& options, Suite& suite) {
    const MetamorphicResponse checks(library, plugin, options);
    suite.run("the whole in a mirror", [&] { checks.mirrored_scenes(); });
    suite.run("all masses scaled", [&] { checks.masses_scaled(); });
    suite.run("all velocities shifted", [&] { checks.seen_in_motion(); });
    suite.run("ends of all parameter ranges", [&] { checks.parameters(); });
    suite.run("needs no more than it uses", [&] { checks.needs_what_it_uses(); });
    suite.run("friction as declared", [&] { checks.friction(); });
    suite.run("moves bodies as declared", [&] { checks.moves(); });
    suite.run("rests as declared", [&] { checks.rests(); });
    suite.run("sleeps as declared", [&] { checks.sleeps(); });
}

}  // namespace kolize
