// Expectations: what a scene must give, kept beside it in expect.toml; `kolize run --expect` and the tests check them.
//
//     [[expect]]
//     pipeline = "pipelines/accurate.toml"   # "" or absent: the scene's own
//     time = 20                              # s, or steps = 4800; absent: the scene's step.time
//     set = { "step.dt" = 0.001 }
//     energy_drift = { max = 1e-12 }         # any numeric field of RunResult, with min, max or both
//     contacts = { min = 10 }
#pragma once

#include <kolize/simulation.h>

#include <filesystem>
#include <string>
#include <vector>

namespace kolize {

struct Bound {
    std::string field;  // of RunResult
    double min = -infinity;
    double max = infinity;
    SourceLocation where;
};

struct Expectation {
    std::string pipeline;                 // as written; "" for the scene's own
    std::filesystem::path pipeline_file;  // relative to the working directory
    std::vector<std::pair<std::string, std::string>> set;
    double time = 0;          // s; 0: see steps
    std::uint64_t steps = 0;  // 0 as well as time: the scene's step.time
    std::vector<Bound> bounds;
    SourceLocation where;
};

// Throws Error with file:line:column.
KOLIZE_API std::vector<Expectation> read_expectations(const std::filesystem::path& file);

// One sentence for each bound that the result breaks; empty if it holds them all. A value that is not finite breaks
// any bound.
KOLIZE_API std::vector<std::string> failures(const Expectation& expectation, const RunResult& result);

struct ExpectationOutcome {
    std::string what;  // "pipelines/accurate.toml, 4800 steps"
    std::vector<std::string> failures;
};

// Runs the scene as the expectation says. Throws Error for a scene or pipeline that cannot be built.
KOLIZE_API ExpectationOutcome run_expectation(const Expectation& expectation, const std::filesystem::path& scene,
                                              const PluginDefaults& defaults, const PluginLibrary& plugins, Host& host);

}  // namespace kolize
