// A response plugin and what it answers, for the files of its suite.
#pragma once

#include "impacts.h"
#include "suite.h"

#include <kolize/simulation.h>

#include <cstring>

namespace kolize {

class ResponseUnderTest {
public:
    ResponseUnderTest(const PluginLibrary& library, const LoadedPlugin& plugin, const ConformanceOptions& options)
        : library_(library), plugin_(plugin), options_(options) {}

protected:
    struct Answer {
        ImpactScene scene;  // after the response
        std::vector<Event> events;
        double dissipated_J = 0;
        std::uint64_t unresolved = 0;
    };
    using Settings = std::map<std::string, Setting>;

    const Capabilities& capabilities() const { return plugin_.descriptor->capabilities; }

    [[noreturn]] static void violate(const std::string& what, const ImpactScene& scene) {
        throw Violation(what + ": " + to_text(scene));
    }
    static void expect_same(const World& got, const World& expected, const std::string& what, const ImpactScene& scene);

    StagePtr<Response> make(Host& host, const Settings& settings = {}) const;

    ImpactScene impacts(std::size_t count, double restitution, std::uint64_t seed) const {
        return random_impacts(count, capabilities().uses, restitution, seed);
    }
    template <class CheckScene>
    void for_each_scene(CheckScene&& check) const {
        for (std::uint64_t seed = options_.seed; seed < options_.seed + 5; ++seed)
            for (const std::size_t count : {1, 2, 5, 20})
                for (const double restitution : {1.0, 0.5, 0.0}) check(impacts(count, restitution, seed));
    }

    static Answer respond(Response& stage, const ImpactScene& scene, double settle = 0);
    Answer respond(const ImpactScene& scene, double settle = 0) const;

    // The body's velocities, to rounding.
    static bool close(const World& world, std::uint32_t body, const Vec3& velocity, const Vec3& angular_velocity) {
        return (world.velocity[body] - velocity).norm() <= 1e-12 * (1 + velocity.norm()) &&
               (world.angular_velocity[body] - angular_velocity).norm() <= 1e-12 * (1 + angular_velocity.norm());
    }

    const PluginLibrary& library_;
    const LoadedPlugin& plugin_;
    const ConformanceOptions& options_;
};

inline bool same_bits(const Vec3& a, const Vec3& b) { return std::memcmp(a.data(), b.data(), sizeof(Vec3)) == 0; }

}  // namespace kolize
