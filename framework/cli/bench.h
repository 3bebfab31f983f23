// kolize bench: one stage alone on a recorded input, in as many variants as asked for.
#pragma once

#include "common.h"

namespace kolize::cli {

struct BenchOptions {
    std::string workload;
    std::vector<std::string> vary;
    std::vector<std::string> set;
    std::vector<std::string> plugin_path;
    int repeat = 5;
    int threads = 1;
    std::string json;
};

struct PlannedVariant {
    Settings varied;
    StageConfig config;
    const LoadedPlugin* plugin;

    std::string name() const { return varied.empty() ? plugin->descriptor->name : label(varied); }
};

// What --set and --vary ask for; where neither names a plugin, one variant of each plugin of the stage. Throws Error.
std::vector<PlannedVariant> plan_variants(const BenchOptions& options, StageKind stage,
                                          const std::string& default_plugin, const PluginLibrary& library);
bool names_plugin(const BenchOptions& options, StageKind stage);

// The keys that every stage's result begins with.
Json bench_json(const BenchOptions& options, StageKind stage);
// Whether a stage is the one that a run was made with, to the last parameter.
bool is_maker(const StageConfig& maker, const LoadedPlugin& plugin, const Stage& stage);

// The plugin, with the parameters in force.
Json stage_json(const LoadedPlugin& plugin, const Stage& stage);

// Exit codes.
int bench_broadphase(const BenchOptions& options);
int bench_narrowphase(const BenchOptions& options);
int bench_narrowphase_calls(const BenchOptions& options);  // of a workload that is a folder
int bench_response(const BenchOptions& options);

}  // namespace kolize::cli
