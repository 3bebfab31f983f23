// A broadphase plugin and how its answers are judged, for the files of its suite.
#pragma once

#include "boxes.h"
#include "suite.h"

#include <kolize/simulation.h>

namespace kolize {

class BroadphaseUnderTest {
public:
    BroadphaseUnderTest(const PluginLibrary& library, const LoadedPlugin& plugin, const ConformanceOptions& options)
        : library_(library), plugin_(plugin), options_(options) {}

protected:
    using Settings = std::map<std::string, Setting>;
    using Judge = std::string (*)(const BoxScene& scene, std::vector<Pair> pairs);

    StagePtr<Broadphase> make(Host& host, const Settings& settings = {}) const;
    static std::vector<Pair> find(Broadphase& stage, const BoxScene& scene, std::uint64_t generation);
    std::vector<Pair> find_afresh(const BoxScene& scene) const;

    // Throws Violation with as few boxes as it takes, if the judge finds fault with what a new object answers.
    void expect_right(const BoxScene& scene, Judge judge = fault) const;
    static void expect_right(const std::vector<Pair>& pairs, const BoxScene& scene, const std::string& what);
    // `pairs` are right, and the very ones that a new object finds.
    void expect_same(std::vector<Pair> pairs, const BoxScene& scene, const std::string& what) const;

    const PluginLibrary& library_;
    const LoadedPlugin& plugin_;
    const ConformanceOptions& options_;

private:
    // Leaves out boxes as long as the answer stays wrong, so that what is printed is short.
    [[noreturn]] void throw_reduced(BoxScene scene, Judge judge) const;
};

}  // namespace kolize
