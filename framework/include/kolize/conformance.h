// Conformance: holds a loaded plugin to the contract of its stage, as written in that stage's header.
#pragma once

#include <kolize/plugin_library.h>

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace kolize {

struct Check {
    enum class Outcome : std::uint32_t { pass, fail, skip };

    std::string name;
    Outcome outcome = Outcome::pass;
    std::string detail;  // fail: what happened, with input that pastes into a test; skip: the reason; pass: empty
};

struct ConformanceOptions {
    std::uint64_t seed = 1;  // of all random input
    // Number of heap allocations of the program so far; empty: the checks that need it are skipped.
    std::function<std::size_t()> allocations;
};

// All checks of the plugin's stage, always the same ones in the same order for a stage. `library` holds the plugin.
// Whatever the plugin throws becomes a failed check.
KOLIZE_API std::vector<Check> check_plugin(const PluginLibrary& library, const LoadedPlugin& plugin,
                                           const ConformanceOptions& options = {});

// One for each stage kind; check_plugin chooses.
std::vector<Check> check_broadphase(const PluginLibrary&, const LoadedPlugin&, const ConformanceOptions&);
std::vector<Check> check_narrowphase(const PluginLibrary&, const LoadedPlugin&, const ConformanceOptions&);
std::vector<Check> check_response(const PluginLibrary&, const LoadedPlugin&, const ConformanceOptions&);
std::vector<Check> check_renderer(const PluginLibrary&, const LoadedPlugin&, const ConformanceOptions&);

// No check failed.
KOLIZE_API bool passed(const std::vector<Check>& checks);

struct ConformanceReport {
    std::string plugin;
    std::vector<Check> checks;
};

// A row a check, a column a plugin, then the details of what failed or was skipped. The reports are of one stage.
KOLIZE_API void print_matrix(std::ostream& out, const std::vector<ConformanceReport>& reports);

// How often a plugin is wrong about one family of input, against exact answers.
struct AccuracyRow {
    std::string family;
    std::size_t pairs = 0;       // that it was asked about
    std::size_t hits = 0;        // of them, those that are true
    std::size_t false_hits = 0;  // found, and not true
    std::size_t misses = 0;      // true, and not found
};

// Triangle tests on families of triangle pairs, broadphases on crowds of boxes; empty for all other plugins. The same
// numbers for the same seed.
KOLIZE_API std::vector<AccuracyRow> measure_accuracy(const PluginLibrary& library, const LoadedPlugin& plugin,
                                                     std::uint64_t seed = 1);

}  // namespace kolize
