// A narrowphase plugin and what it is asked about, for the files of its suite.
#pragma once

#include "suite.h"
#include "two_solids.h"

#include <kolize/simulation.h>

namespace kolize {

class NarrowphaseUnderTest {
public:
    NarrowphaseUnderTest(const PluginLibrary& library, const LoadedPlugin& plugin, const ConformanceOptions& options)
        : library_(library), plugin_(plugin), options_(options) {}

protected:
    static constexpr double tolerance = 1e-9;  // m, rad: for solids of size 1 seen from another side

    [[noreturn]] static void violate(const std::string& what, const World& world) {
        throw Violation(what + ": " + to_text(world));
    }

    const Capabilities& capabilities() const { return plugin_.descriptor->capabilities; }
    // What it finds to overlap are bounding volumes, of bodies that may be apart.
    bool answers_for_volumes() const { return capabilities().bounding_spheres; }

    World solids(std::mt19937_64& random) const { return random_two_solids(random, capabilities().shape_kinds); }

    template <class CheckWorld>
    void for_each_world(CheckWorld&& check, int rounds = 150) const {
        std::mt19937_64 random(options_.seed);
        for (int round = 0; round < rounds; ++round) check(solids(random));
    }

    // Many bodies of all kinds close together.
    World crowd() const;
    static std::vector<Pair> all_pairs(const World& world);

    using Settings = std::map<std::string, Setting>;
    StagePtr<Narrowphase> make(Host& host, const World& world, const Settings& settings = {}) const;
    Detail gives() const;

    static Contacts find(Narrowphase& stage, const World& world, const std::vector<Pair>& pairs, Detail detail);
    Contacts find(const World& world, const std::vector<Pair>& pairs, Detail detail, int threads = 1) const;
    Contacts find_pair(const World& world, Detail detail) const { return find(world, {{0, 1}}, detail); }

    const PluginLibrary& library_;
    const LoadedPlugin& plugin_;
    const ConformanceOptions& options_;
};

bool same_bits(const std::vector<Contact>& a, const std::vector<Contact>& b);

// Each contact of `a` has its like in `b`, wherever it stands there.
bool same_geometry(const std::vector<Contact>& a, const std::vector<Contact>& b, double within);

}  // namespace kolize
