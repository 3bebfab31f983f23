// A comparison as text, CSV, JSON and one HTML file.
#pragma once

#include "compare/comparison.h"

namespace kolize::cli {

struct CompareOptions {
    std::vector<std::string> scenes;
    std::vector<std::string> pipelines, vary, set, plugin_path;
    RunLength length;
    int repeat = 0;
    std::string baseline;
    std::string judge;
    int reference = 0;
    Gates gates;
    int threads = 1;
    std::string report;
    std::string json;
};

struct PluginFile {
    std::string stage, name, file;
    std::string hash;  // of the file's bytes
};

struct Comparison {
    CompareOptions options;
    std::vector<Variant> variants;  // the last is the baseline again
    std::size_t baseline = 0;
    std::string judge;
    int warm_up_rounds = 0;
    std::vector<PluginFile> plugins;
    std::vector<std::string> warnings;  // what makes times doubtful
};

std::vector<PluginFile> plugin_files(const std::vector<Variant>& variants, const PluginLibrary& plugins);
// A busy machine, a build without optimisation.
std::vector<std::string> machine_warnings();

// "a.toml, b.toml"
std::string scenes_text(const CompareOptions& options);
std::string comparison_text(const Comparison& comparison);
std::string comparison_csv(const Comparison& comparison);
Json comparison_json(const Comparison& comparison);
// Self-contained: no script, nothing from the network. `json` is embedded.
std::string comparison_html(const Comparison& comparison, const Json& json);

// Throw Error for a file that is no report.
Json read_report(const std::filesystem::path& file);
CompareOptions options_from(const Json& report, const std::filesystem::path& file);
// What the second one has otherwise, a sentence each.
std::vector<std::string> compare_reports(const Json& first, const Json& second);

}  // namespace kolize::cli
