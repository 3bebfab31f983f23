#include "conformance/impact_times.h"

#include "conformance/steady_flow.h"
#include "conformance/two_solids.h"

#include <kolize/simulation.h>

#include <algorithm>

namespace kolize {

namespace {

constexpr double until = 0.5;  // s

[[noreturn]] void violate(const std::string& what, const World& world) {
    throw Violation(what + ": " + to_text(world) + ", velocities " + std::to_string(world.velocity[0].norm()) +
                    " and " + std::to_string(world.velocity[1].norm()) + " m/s");
}

World moved_to(const World& world, double time) {
    const SteadyFlow flow(world);
    World moved = world;
    for (const std::uint32_t body : {0u, 1u}) moved.set_state(body, flow.at(body, time));
    return moved;
}

class ImpactChecks {
public:
    ImpactChecks(const PluginLibrary& library, const LoadedPlugin& plugin, const ConformanceOptions& options)
        : library_(library), plugin_(plugin), options_(options) {
        if (!plugin.descriptor->capabilities.time_of_impact)
            throw Inapplicable("it declares that it finds no times of impact");
    }

    void nothing_overlaps_before() const {
        constexpr int samples = 16;
        int impacts = 0;
        for_each_motion([&](const World& world) {
            const double time = impact(world);
            impacts += time < until;
            for (int i = 0; i <= samples; ++i) {
                const double sample = until * i / samples;
                if (sample < time && reference_overlap(moved_to(world, sample)) == Overlap::overlapping)
                    violate("the solids overlap after " + std::to_string(sample) + " s, and the time of impact is " +
                                std::to_string(time) + " s",
                            world);
            }
        });
        if (impacts < 10) throw Violation("the suite's own input does not cover impacts");
    }

    void contacts_approach() const {
        for_each_motion([&](const World& world) {
            const double time = impact(world);
            if (!(time > 0 && time < until)) return;
            const World there = moved_to(world, time);
            const auto rows = touching(there);
            const auto approaches = [&](const Contact& c) {
                return c.normal.dot(there.velocity_at(c.b, c.arm_b) - there.velocity_at(c.a, c.arm_a)) < 0;
            };
            if (std::none_of(rows.begin(), rows.end(), approaches))
                violate("no contact approaches at the time of impact", world);
        });
    }

    void exchanged_and_elsewhere() const {
        std::mt19937_64 random(options_.seed + 1);
        for_each_motion([&](const World& world) {
            const double time = impact(world);
            const Mat3 turn = random_rotation(random);
            require_close(time, impact(with_ids_exchanged(world)), 1e-9, "exchanging the bodies changes the time",
                          world);
            require_close(time, impact(turned(world, turn, Vec3(3, -2, 1))), 1e-9, "turning the whole does", world);
            require_close(time, impact(turned(world, Mat3::Identity(), Vec3(1e6, -2e6, 3e6))), 1e-5,
                          "going a million metres away does", world);
        });
    }

private:
    static World with_ids_exchanged(const World& world) {
        World other = exchanged(world);
        for (const std::uint32_t body : {0u, 1u}) {
            other.velocity[body] = world.velocity[1 - body];
            other.angular_velocity[body] = world.angular_velocity[1 - body];
        }
        return other;
    }

    static World turned(const World& world, const Mat3& turn, const Vec3& offset) {
        World moved = placed_elsewhere(world, turn, offset);
        for (const std::uint32_t body : {0u, 1u}) {
            moved.velocity[body] = turn * world.velocity[body];
            moved.angular_velocity[body] = turn * world.angular_velocity[body];
        }
        return moved;
    }

    // A graze may be an impact in one place and none in another.
    void require_close(double time, double other, double within, const std::string& what, const World& world) const {
        constexpr double graze = 0.05;  // m/s
        if (time == other || std::abs(time - other) < within) return;
        const World there = moved_to(world, std::min(time, other));
        double fastest = 0;
        for (const Contact& c : touching(there))
            fastest =
                std::max(fastest, -c.normal.dot(there.velocity_at(c.b, c.arm_b) - there.velocity_at(c.a, c.arm_a)));
        if (fastest > graze) violate(what + " from " + std::to_string(time) + " to " + std::to_string(other), world);
    }

    template <class CheckWorld>
    void for_each_motion(CheckWorld&& check) const {
        std::mt19937_64 random(options_.seed);
        std::normal_distribution<double> speed(0, 3);
        for (int round = 0; round < 100; ++round) {
            World world = random_two_solids(random, plugin_.descriptor->capabilities.shape_kinds);
            const Vec3 apart = world.position[1] - world.position[0];
            for (const std::uint32_t body : {0u, 1u}) {
                if (world.is_static[body]) continue;
                world.velocity[body] =
                    (body == 0 ? 2.0 : -2.0) * apart + Vec3(speed(random), speed(random), speed(random));
                world.angular_velocity[body] = Vec3(speed(random), speed(random), speed(random));
            }
            if (reference_overlap(world) == Overlap::apart) check(world);
        }
    }

    StagePtr<Narrowphase> make(Host& host, const World& world) const {
        auto stage = library_.make<Narrowphase>(default_config(plugin_), host);
        stage->prepare(world);
        return stage;
    }

    double impact(const World& world) const {
        const auto host = make_host(1);
        const Pair pair{0, 1};
        double time = 0;
        make(*host, world)->find_impacts({world, SteadyFlow(world), {&pair, 1}, 0, until}, {&time, 1});
        return time;
    }

    std::vector<Contact> touching(const World& world) const {
        const auto host = make_host(1);
        const Pair pair{0, 1};
        const Detail detail = Detail::manifold;
        Contacts contacts;
        make(*host, world)->find_touching({world, {&pair, 1}, {&detail, 1}}, contacts);
        return contacts.rows;
    }

    const PluginLibrary& library_;
    const LoadedPlugin& plugin_;
    const ConformanceOptions& options_;
};

}  // namespace

void check_impact_times(const PluginLibrary& library, const LoadedPlugin& plugin, const ConformanceOptions& options,
                        Suite& suite) {
    const auto run = [&](const char* name, void (ImpactChecks::*check)() const) {
        suite.run(name, [&] { (ImpactChecks(library, plugin, options).*check)(); });
    };
    run("nothing overlaps before the time of impact", &ImpactChecks::nothing_overlaps_before);
    run("a contact approaches at the time of impact", &ImpactChecks::contacts_approach);
    run("times of impact elsewhere, turned, exchanged", &ImpactChecks::exchanged_and_elsewhere);
}

}  // namespace kolize
