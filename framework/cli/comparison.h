// One scene through several pipelines: runs them interleaved, so that a slow minute of the machine hits all alike, and
// finds those that no other beats in both speed and accuracy.
#pragma once

#include "common.h"

#include <nlohmann/json.hpp>

namespace kolize::cli {

struct Variant {
    std::string label;     // pipeline file and varied keys
    std::string pipeline;  // file; "" for the scene's own
    Settings vary;
    Scene scene;
    std::uint64_t steps = 0;
    Json effective;               // pipeline as it is in force
    std::vector<RunResult> runs;  // one a round
    RunResult summary;            // accuracy of the runs, medians of their times
    bool repeatable = true;       // accuracy, counts and hash were the same in every run
    bool front = false;
};

inline constexpr unsigned order_seed = 20080;  // of the order within the rounds
inline constexpr double time_noise = 0.03;     // steps closer than this are equally fast
inline constexpr double drift_floor = 1e-12;   // smaller energy drifts are equally good

// Makes each variant's simulation and takes its first steps, which are not counted: whatever is wrong with any of them
// comes out before the first measured run.
void warm_up(std::vector<Variant>& variants, const PluginLibrary& plugins, Host& host);

// `repeat` rounds, each of every variant once in shuffled order; fills runs, summary and repeatable.
void run_rounds(std::vector<Variant>& variants, int repeat, const PluginLibrary& plugins, Host& host);

// Sets front where no other row is both faster, by more than the noise, and at least as accurate. Rows with escaped or
// stuck bodies, or that did not repeat, take no part.
void mark_front(std::vector<Variant>& variants);

}  // namespace kolize::cli
