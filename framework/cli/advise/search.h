// The search behind kolize advise: which of many pipelines answers best for one scene.
//
// What a run may at most get wrong only ever grows with time: the largest drift so far, bodies that have escaped, pairs
// that were stuck, pairs that were missed, the deepest penetration. So a pipeline that breaks a limit within a short
// run needs no long one, and nothing is lost by leaving it out. Broadphases that find all pairs change no bit of a run:
// one is chosen by itself, for the pipeline that has won.
#pragma once

#include "common.h"

namespace kolize::cli {

struct Limits {
    std::optional<double> budget_ms;    // of work for as much simulated time as the scene's own step has
    std::optional<double> drift;        // of energy, see RunResult
    std::optional<double> penetration;  // m
    std::uint64_t missed = 0;           // by the judge, as false hits: who says what is not so answers another question
    std::uint64_t false_hits = 0;
};

// What one run gave.
struct Trial {
    double cost_ms = 0;  // see Limits::budget_ms
    double drift = 0;
    double penetration = 0;  // m, the deepest
    std::uint64_t missed = 0,
                  false_hits = 0;  // pairs that overlap by the judge and not by the narrowphase, and reverse
    std::uint64_t escaped = 0, stuck = 0;
    std::uint64_t hash = 0;
    std::string failure;  // why there is no answer: the stages do not fit together, or the run failed
};

struct Candidate {
    Settings settings;
    std::optional<Trial> screened;  // over a tenth of the time
    std::optional<Trial> tried;     // over the whole of it

    // Of the longer run that there is.
    const Trial& known() const { return tried ? *tried : *screened; }
};

struct Question {
    std::string scene;
    SceneOptions options;  // what holds for all
    Limits limits;
    std::vector<Variation> variations;
    double time = 0;    // simulated, s
    std::string judge;  // narrowphase that decides what overlaps, or "" if nobody asks
    bool full = false;  // every candidate over the whole time
};

struct BroadphaseTime {
    std::string plugin;
    double cost_ms = 0;  // of the whole step, as in Trial
    std::string failure;
};

struct Answer {
    std::vector<Candidate> candidates;
    std::optional<std::size_t> chosen;
    double chosen_cost_ms = 0;                // with the broadphase chosen
    std::vector<BroadphaseTime> broadphases;  // the fastest first; failures last
    std::optional<std::size_t> ten_times;     // the cheapest that is ten times as accurate as the one chosen, by drift,
    bool by_penetration = false;              // or by penetration where the drift is rounding
    std::optional<std::size_t> best_of_full;  // what a search of everything chooses
    double times_best = 1;                    // how many times as long the one chosen takes as that, interleaved
    PipelineConfig pipeline;                  // of the one chosen, all parameters in force
};

// Accuracy that nobody needs to better: below it two drifts are the same.
inline constexpr double rounding_drift = 1e-12;

Answer search(const Question& question, const PluginLibrary& plugins, Host& host);

// "" if it keeps every limit, or what it breaks.
std::string broken_limit(const Trial& trial, const Limits& limits);

}  // namespace kolize::cli
