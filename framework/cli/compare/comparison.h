// One scene through several pipelines: runs them interleaved, so that a slow minute of the machine hits all alike,
// measures each run's errors, and finds those that no other beats in both speed and accuracy.
#pragma once

#include "common.h"
#include "compare/statistics.h"
#include "judge/judges.h"

#include <nlohmann/json.hpp>

namespace kolize::cli {

// How a run went, by time: some hundred moments, of the same run that gave the hash.
struct Course {
    std::vector<double> time;          // s
    std::vector<double> energy_error;  // |E - E0 - W| over its scale, so far the largest
    std::vector<double>
        path_error;  // mean distance of the bodies from the reference, over their size; empty where there is none
    double energy_slope = 0;  // 1/s, of energy_error: Theil-Sen
};

struct Variant {
    std::string label;   // pipeline file and varied keys, after the scene's name where there are several
    std::string method;  // the same without the scene: rows of several scenes with one method belong together
    std::string scene_file;
    std::string pipeline;  // file; "" for the scene's own
    Settings vary;
    bool again = false;  // the baseline a second time: what differs from it is noise
    Scene scene;
    std::uint64_t steps = 0;
    double time = 0;              // simulated, s, as it was asked for: steps may not divide it
    std::uint64_t question = 0;   // hash of all that the run is asked for: the scene without its pipeline, and how long
    Json effective;               // pipeline as it is in force
    std::vector<RunResult> runs;  // one a round
    RunResult summary;            // accuracy of the runs, medians of their times
    bool repeatable = true;       // accuracy, counts and hash were the same in every run
    Course course;
    std::optional<Verdict> judged;  // of the narrowphase, by the judge

    std::vector<double> step_us() const;  // median step of each run
    Estimate step;                        // their median, us
    // ms of work for a second of simulated time, by the median step: what rows are ranked by, whatever their dt.
    double cost_ms() const { return 1e-3 * step.value / scene.pipeline.step.dt; }
    Estimate ratio;  // of costs, to the baseline's, round by round
    std::string verdict;
    bool ranked = true;               // answers the same question as the baseline
    bool front = false;               // of all that are ranked
    bool safe_front = false;          // of those that nothing escaped, stuck or was missed in
    std::string dominated_by;         // label of a row that is faster and no worse, or as fast and better
    std::vector<std::string> breaks;  // gates
};

// Nothing escaped, stuck, was missed or differed from run to run.
bool is_safe(const Variant& variant);

struct Gates {
    std::optional<double> budget_ms;  // median step
    std::optional<double> drift;      // of energy
    std::optional<std::uint64_t> missed;
};

inline constexpr unsigned order_seed = 20080;  // of the order within the rounds
inline constexpr double time_noise = 0.03;     // costs closer than this are the same, where there are too few runs
inline constexpr double drift_floor = 1e-12;   // smaller energy drifts are equally good

// Runs each variant once and measures its errors; whatever is wrong with any of them comes out before the first timed
// run. `judge`: see Judges; none where empty. `finer`: where not 0, every path is held against that of the first
// variant with steps so many times shorter.
void measure_errors(std::vector<Variant>& variants, const std::string& judge, int finer, const PluginLibrary& plugins,
                    Host& host);

// Rounds, each of every variant once in shuffled order; fills runs, summary, repeatable and step. With repeat = 0 until
// each has run for two seconds, 7 to 31 times. Before them rounds that are not counted, until three medians in a row of
// the first variant are within 2 %, five at most; returns how many these were.
int run_rounds(std::vector<Variant>& variants, int repeat, const PluginLibrary& plugins, Host& host);

// Sets ratio, verdict, fronts, dominated_by and breaks. Each scene has a baseline of its own, with the same method.
void draw_conclusions(std::vector<Variant>& variants, std::size_t baseline, const Gates& gates);

}  // namespace kolize::cli
