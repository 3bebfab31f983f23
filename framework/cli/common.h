// What the subcommands share: options, KEY=VALUE settings, variants, tables, progress and JSON.
//
// A subcommand is a function add_NAME that declares its options and a callback. The callback prints results to stdout,
// stores the exit code where it is not 0, and lets kolize::Error out for bad input: main() prints it and exits with 2.
#pragma once

#include <kolize/expectation.h>
#include <kolize/scene.h>
#include <kolize/simulation.h>

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

// Declared only: both libraries take seconds to compile.
namespace CLI {
class App;
}

namespace kolize::cli {

void add_advise(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_explain(CLI::App& app, int& exit_code);
void add_massprops(CLI::App& app);
void add_plugins(CLI::App& app, int& exit_code);
void add_run(CLI::App& app, int& exit_code);
void add_stability(CLI::App& app);
void add_view(CLI::App& app, int& exit_code);

// --- Plugins -------------------------------------------------------------------------------------------------------

// What is taken where neither scene nor pipeline names a plugin. The framework itself names none.
PluginDefaults plugin_defaults();

// --plugin-path folders, then the usual places; `scene_folder` may be empty.
PluginLibrary open_plugins(const std::vector<std::string>& plugin_path, const std::filesystem::path& scene_folder);

// --- Settings and variants -----------------------------------------------------------------------------------------

using Settings = std::vector<std::pair<std::string, std::string>>;  // dotted key, value

// "KEY=VALUE" each. Throws Error.
Settings parse_settings(const std::vector<std::string>& arguments);

// "KEY=V1,V2,..." each; commas inside brackets or quotes do not separate. Throws Error.
struct Variation {
    std::string key;
    std::vector<std::string> values;
};
std::vector<Variation> parse_variations(const std::vector<std::string>& arguments);

// Cartesian product; the last variation changes fastest. One empty entry where there is nothing to vary.
std::vector<Settings> combinations(const std::vector<Variation>& variations);

// "broadphase.plugin=grid dt=0.01": what tells a variant from the others.
std::string label(const Settings& settings);

// --- Options that several subcommands have -------------------------------------------------------------------------

struct RunLength {
    std::optional<double> time;          // simulated, s
    std::optional<std::uint64_t> steps;  // instead of time

    // Steps to take with the scene's dt; `fallback` seconds where neither was given.
    std::uint64_t count(double dt, double fallback) const;
};

void add_set_option(CLI::App& command, std::vector<std::string>& set);
void add_plugin_path_option(CLI::App& command, std::vector<std::string>& plugin_path);
void add_length_options(CLI::App& command, RunLength& length);
// The present value is the default: all_cores() where one answer is wanted soon, 1 where times are compared.
void add_threads_option(CLI::App& command, int& threads);
int all_cores();
void add_json_option(CLI::App& command, std::string& json);

// --- JSON ----------------------------------------------------------------------------------------------------------

using Json = nlohmann::ordered_json;  // keys stay in the order in which they are written

Json to_json(const Value& value);
// Every stage with the parameters in force.
Json pipeline_json(const Simulation& simulation);
// "run --json", without the host block.
Json to_json(const RunResult& result, const Json& pipeline);
// Program version, compiler, build type, CPU model, cores.
Json host_block();
// What this program was called with.
std::string command_line();
// 16 lower-case hexadecimal digits.
std::string hex(std::uint64_t bits);

// Writes to a temporary file beside `destination` and renames it, so that nobody sees half a file; "-" is stdout.
// Throws Error.
void write_text(const std::string& text, const std::filesystem::path& destination);
void write_json(const Json& json, const std::filesystem::path& destination);

// --- Text ----------------------------------------------------------------------------------------------------------

// Columns as wide as their widest cell; the first is flush left, the others flush right.
class Table {
public:
    explicit Table(std::vector<std::string> head) : rows_{std::move(head)} {}
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    void print(std::ostream& out) const;

private:
    std::vector<std::vector<std::string>> rows_;
};

// Three or so significant digits: "12.3", "0.0123", "4.5e-13".
std::string number(double value, int digits = 3);

// p in [0, 1]: linear interpolation between order statistics; 0 for no samples.
double quantile(std::vector<double> samples, double p);
inline double median(std::vector<double> samples) { return quantile(std::move(samples), 0.5); }

// A bar on stderr for work that takes longer than two seconds; silent when stderr is no terminal.
class Progress {
public:
    Progress(std::string what, std::uint64_t total);
    ~Progress();
    void advance(std::uint64_t count = 1);

private:
    void draw(std::chrono::steady_clock::time_point now);

    std::string what_;
    std::uint64_t total_;
    std::uint64_t done_ = 0;
    bool terminal_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point start_;
    std::chrono::steady_clock::time_point last_;
};

}  // namespace kolize::cli
