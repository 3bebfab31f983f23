#include "metamorphic.h"
#include "response_under_test.h"

#include <algorithm>

namespace kolize {

namespace {

double kinetic_energy(const World& world) {
    double energy = 0;
    for (std::uint32_t i = 0; i < world.size(); ++i) energy += world.kinetic_energy(i);
    return energy;
}

std::vector<std::uint8_t> touched_bodies(const ImpactScene& scene) {
    std::vector<std::uint8_t> touched(scene.world.size(), 0);
    for (const Contact& c : scene.contacts) touched[c.a] = touched[c.b] = 1;
    return touched;
}

// The plugin under test; the checks are its member functions.
class ResponseChecks : ResponseUnderTest {
public:
    using ResponseUnderTest::ResponseUnderTest;

    void nothing_to_answer() const {
        const ImpactScene scene = impacts(0, 1, options_.seed);
        const Answer answer = respond(scene);
        expect_same(answer.scene.world, scene.world, "without contacts", scene);
        if (!answer.events.empty() || answer.dissipated_J != 0 || answer.unresolved != 0)
            violate("without contacts there is something to report", scene);
    }

    void writes_nothing_else() const {
        for_each_scene([&](const ImpactScene& scene) {
            const World& before = scene.world;
            const Answer answer = respond(scene);
            const World& after = answer.scene.world;
            const std::vector<std::uint8_t> touched = touched_bodies(scene);
            for (std::size_t i = 0; i < before.size(); ++i) {
                const std::string body = "body " + std::to_string(i);
                const bool may_move = capabilities().moves && touched[i] && !before.is_static[i];
                if (!may_move && (!same_bits(before.position[i], after.position[i]) ||
                                  before.orientation[i].coeffs() != after.orientation[i].coeffs()))
                    violate(body + " is moved", scene);
                if (touched[i] && !before.is_static[i]) continue;
                if (!same_bits(before.velocity[i], after.velocity[i]) ||
                    !same_bits(before.angular_velocity[i], after.angular_velocity[i]))
                    violate(body + " is static or has no contact, and its velocity changes", scene);
            }
            if (after.size() != before.size() || after.inverse_mass != before.inverse_mass ||
                after.inverse_inertia != before.inverse_inertia || after.removed != before.removed ||
                after.is_static != before.is_static || after.kind != before.kind ||
                (!capabilities().sleeps && after.asleep != before.asleep))
                violate("a constant of the bodies is changed", scene);
        });
    }

    void reports_every_impulse() const {
        for_each_scene([&](const ImpactScene& scene) {
            const Answer answer = respond(scene);
            std::vector<Vec3> momentum(scene.world.size(), Vec3::Zero());
            double scale = 0;
            for (const Contact& c : answer.scene.contacts) {
                if (!(c.impulse >= 0)) violate("an impulse is negative or not a number", scene);
                momentum[c.a] -= c.total_impulse();
                momentum[c.b] += c.total_impulse();
                scale += c.total_impulse().norm();
            }
            for (std::size_t i = 0; i < momentum.size(); ++i) {
                if (scene.world.is_static[i]) continue;
                const Vec3 change =
                    (answer.scene.world.velocity[i] - scene.world.velocity[i]) / scene.world.inverse_mass[i];
                if (!((change - momentum[i]).norm() <= 1e-12 * (1 + scale)))
                    violate("the momentum of body " + std::to_string(i) + " is not that of its impulses", scene);
            }
        });
    }

    void energy_is_accounted_for() const {
        for_each_scene([&](const ImpactScene& scene) {
            const double before = kinetic_energy(scene.world);
            Answer answer = respond(scene);
            answer.scene.world.orientation = scene.world.orientation;  // moving bodies apart is no part of it
            const double lost = before - kinetic_energy(answer.scene.world);
            if (!(std::abs(lost - answer.dissipated_J) <= 1e-11 * before))
                violate("lost " + std::to_string(lost) + " J, reported " + std::to_string(answer.dissipated_J), scene);
        });
    }

    void same_bits_again() const {
        for_each_scene([&](const ImpactScene& scene) {
            const Answer afresh = respond(scene);
            for (const int threads : {1, 2, 8}) {
                const auto host = make_host(threads);
                const auto stage = make(*host);
                respond(*stage, impacts(7, 0.5, options_.seed + 99));
                stage->restore({});  // it forgets
                const Answer again = respond(*stage, scene);
                expect_same(again.scene.world, afresh.scene.world,
                            "after another scene, on " + std::to_string(threads) + " threads", scene);
            }
        });
    }

    // Another object that is given what one remembers goes on to the same bits.
    void remembers_what_it_says() const {
        for_each_scene([&](const ImpactScene& scene) {
            const auto host = make_host(1);
            const auto first = make(*host), second = make(*host);
            respond(*first, scene);
            std::vector<std::uint64_t> words;
            first->save(words);
            second->restore(words);
            expect_same(respond(*second, scene).scene.world, respond(*first, scene).scene.world,
                        "in an object that was given the memory", scene);
            words.push_back(~0ull);
            try {
                second->restore(words);
            } catch (const std::invalid_argument&) {
                return;
            }
            violate("it takes a memory that it cannot have given", scene);
        });
    }

    void turned() const {
        const Quat turn(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()));
        for (std::uint64_t seed = options_.seed; seed < options_.seed + 20; ++seed) {
            const ImpactScene scene = impacts(2, 1, seed);
            const World here = respond(scene).scene.world;
            const World there = respond(moved(scene, turn, Vec3::Zero())).scene.world;
            for (std::uint32_t i = 0; i < here.size(); ++i)
                if (!close(there, i, turn * here.velocity[i], turn * here.angular_velocity[i]))
                    violate("body " + std::to_string(i) + " moves otherwise when all is turned", scene);
        }
    }

    // Arms are relative to the centres of mass: where these are has no part in the velocities.
    void moved_far_away() const {
        for_each_scene([&](const ImpactScene& scene) {
            const World here = respond(scene).scene.world;
            const ImpactScene far = moved(scene, Quat::Identity(), Vec3(1e6, -2e6, 3e6));
            expect_same(respond(far).scene.world, here, "moved by a thousand kilometres", scene);
        });
    }

    // Of one contact the outcome is unique.
    void bodies_renumbered() const {
        for (std::uint64_t seed = options_.seed; seed < options_.seed + 40; ++seed) {
            const ImpactScene scene = impacts(1, seed % 2 ? 1 : 0.5, seed);
            std::vector<std::uint32_t> number(scene.world.size());
            for (std::uint32_t i = 0; i < number.size(); ++i)
                number[i] = static_cast<std::uint32_t>(number.size()) - 1 - i;
            const Answer here = respond(scene), there = respond(renumbered(scene, number));
            for (std::uint32_t i = 0; i < number.size(); ++i)
                if (!close(there.scene.world, number[i], here.scene.world.velocity[i],
                           here.scene.world.angular_velocity[i]))
                    violate("body " + std::to_string(i) + " moves otherwise when it has another number", scene);
            std::vector<std::uint32_t> expected = removals(here);
            for (std::uint32_t& body : expected) body = number[body];
            std::sort(expected.begin(), expected.end());
            if (removals(there) != expected) violate("other bodies are removed when they have other numbers", scene);
        }
    }

    void events_are_of_touching_bodies() const {
        for_each_scene([&](const ImpactScene& scene) {
            const std::vector<std::uint8_t> touched = touched_bodies(scene);
            std::vector<std::uint8_t> gone(scene.world.size(), 0);
            for (const Event& event : respond(scene).events) {
                if (event.body >= touched.size() || !touched[event.body] || scene.world.is_static[event.body])
                    violate("an event is of static or untouched body " + std::to_string(event.body), scene);
                if (!event.position.allFinite()) violate("an event has no finite position", scene);
                if (event.kind == EventKind::removal && gone[event.body]++)
                    violate("body " + std::to_string(event.body) + " is removed twice", scene);
            }
        });
    }

    // Whatever the restitution, the answer is that of restitution 0.
    void settling_bodies_do_not_bounce() const {
        for (std::uint64_t seed = options_.seed; seed < options_.seed + 10; ++seed) {
            const ImpactScene scene = settling(5, 0.7, seed, 0);
            const Answer answer = respond(scene, 0.01);
            const World expected = respond(settling(5, 0, seed, 0)).scene.world;
            for (std::uint32_t i = 0; i < expected.size(); ++i)
                if (!close(answer.scene.world, i, expected.velocity[i], expected.angular_velocity[i]))
                    violate("body " + std::to_string(i) + " moves otherwise than with restitution 0", scene);
            const double lost = kinetic_energy(scene.world) - kinetic_energy(answer.scene.world);
            if (!(std::abs(lost - answer.dissipated_J) <= 1e-11 * kinetic_energy(scene.world)))
                violate("lost " + std::to_string(lost) + " J, reported " + std::to_string(answer.dissipated_J), scene);
        }
    }

    // A gap that nothing closes in time is left alone; and one that has to open does.
    void settling_bodies_keep_their_gaps() const {
        for (std::uint64_t seed = options_.seed; seed < options_.seed + 10; ++seed) {
            const ImpactScene wide = settling(5, 1, seed, -1e3);
            if (removals(respond(wide)).empty())
                expect_same(respond(wide, 0.01).scene.world, wide.world, "with wide gaps", wide);
            const ImpactScene one = settling(1, 1, seed, 1e-3);
            const Answer parted = respond(one, 0.01);
            if (!(parted.scene.contacts[0].impulse > 0)) continue;
            const double speed = normal_velocity(parted.scene.world, parted.scene.contacts[0]);
            if (!(std::abs(speed - 0.1) <= 1e-12 * (1 + kinetic_energy(one.world))))
                violate("the contact parts at " + std::to_string(speed) + " m/s, not at 0.1", one);
        }
    }

    // Bodies at rest, coincident centres, and masses and speeds thirty decades apart.
    void finite_stays_finite() const {
        for (const double scale : {0.0, 1e-150, 1e-15, 1e15, 1e100}) {
            ImpactScene scene = impacts(12, 1, options_.seed);
            for (std::size_t i = 0; i < scene.world.size(); ++i) {
                scene.world.velocity[i] *= scale;
                scene.world.angular_velocity[i] *= scale;
                if (i % 3 == 0) scene.world.inverse_mass[i] *= 1e15;
                if (i % 5 == 0) scene.world.inverse_inertia[i] *= 1e-15;
            }
            for (Contact& c : scene.contacts) c.arm_a = c.arm_b = Vec3::Zero();
            const Answer answer = respond(scene);
            for (std::size_t i = 0; i < scene.world.size(); ++i)
                if (!answer.scene.world.velocity[i].allFinite() || !answer.scene.world.angular_velocity[i].allFinite())
                    violate("body " + std::to_string(i) + " has a velocity that is not finite", scene);
        }
    }

    void warm_calls_allocate_nothing() const {
        if (capabilities().allocates) throw Inapplicable("it declares that its calls allocate");
        if (!options_.allocations) throw Inapplicable("this program does not count allocations");
        const auto host = make_host(1);
        const auto stage = make(*host);
        const ImpactScene start = impacts(200, 1, options_.seed);
        ImpactScene scene = start;
        std::vector<Event> events;
        std::size_t count = 0;
        for (int call = 0; call < 4; ++call) {
            scene = start;
            events.clear();
            ResponseOutput output{events};
            const std::size_t before = options_.allocations();
            stage->respond({scene.contacts, scene.hit, 0.01}, scene.world, output);
            count = options_.allocations() - before;
        }
        if (count > 0) throw Violation(std::to_string(count) + " allocations in the fourth call on 200 contacts");
    }

private:
    // With this for the depth of all contacts.
    ImpactScene settling(std::size_t count, double restitution, std::uint64_t seed, double depth) const {
        ImpactScene scene = impacts(count, restitution, seed);
        for (Contact& c : scene.contacts) c.depth = depth;
        return scene;
    }

    // As far as the plugin models it: without rotation where bodies count as spheres.
    double normal_velocity(const World& world, const Contact& c) const {
        if (capabilities().bounding_spheres) return c.normal.dot(world.velocity[c.b] - world.velocity[c.a]);
        return c.normal.dot(world.velocity_at(c.b, c.arm_b) - world.velocity_at(c.a, c.arm_a));
    }

    // Ascending.
    static std::vector<std::uint32_t> removals(const Answer& answer) {
        std::vector<std::uint32_t> bodies;
        for (const Event& event : answer.events)
            if (event.kind == EventKind::removal) bodies.push_back(event.body);
        std::sort(bodies.begin(), bodies.end());
        return bodies;
    }
};

}  // namespace

std::vector<Check> check_response(const PluginLibrary& library, const LoadedPlugin& plugin,
                                  const ConformanceOptions& options) {
    const ResponseChecks checks(library, plugin, options);
    Suite suite;
    suite.run("no contacts, no change", [&] { checks.nothing_to_answer(); });
    suite.run("writes velocities of touching bodies only", [&] { checks.writes_nothing_else(); });
    suite.run("reports every impulse", [&] { checks.reports_every_impulse(); });
    suite.run("accounts for kinetic energy", [&] { checks.energy_is_accounted_for(); });
    suite.run("same bits again, 1, 2 and 8 threads", [&] { checks.same_bits_again(); });
    suite.run("what it remembers can be saved", [&] { checks.remembers_what_it_says(); });
    suite.run("the whole turned", [&] { checks.turned(); });
    suite.run("the whole moved far away, same bits", [&] { checks.moved_far_away(); });
    suite.run("bodies renumbered", [&] { checks.bodies_renumbered(); });
    suite.run("events are of touching bodies", [&] { checks.events_are_of_touching_bodies(); });
    suite.run("bodies that settle do not bounce", [&] { checks.settling_bodies_do_not_bounce(); });
    suite.run("bodies that settle keep their gaps", [&] { checks.settling_bodies_keep_their_gaps(); });
    suite.run("finite input, finite output", [&] { checks.finite_stays_finite(); });
    suite.run("warm calls allocate nothing", [&] { checks.warm_calls_allocate_nothing(); });
    check_metamorphic_response(library, plugin, options, suite);
    return suite.take();
}

}  // namespace kolize
