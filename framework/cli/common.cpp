#include "common.h"

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <thread>

namespace kolize::cli {
namespace {

std::pair<std::string, std::string> split_assignment(const std::string& argument, const std::string& option) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || equals == 0)
        throw Error(SourceLocation{option + " " + argument}, "KEY=VALUE is wanted, such as broadphase.plugin=grid");
    return {argument.substr(0, equals), argument.substr(equals + 1)};
}

// Splits at commas that stand neither in brackets nor in quotes.
std::vector<std::string> split_values(const std::string& text) {
    std::vector<std::string> values(1);
    int depth = 0;
    char quote = 0;
    for (const char c : text) {
        if (c == ',' && depth == 0 && !quote) {
            values.emplace_back();
            continue;
        }
        if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? 0 : c;
        if (!quote) depth += (c == '[' || c == '{') - (c == ']' || c == '}');
        values.back() += c;
    }
    return values;
}

}  // namespace

PluginDefaults plugin_defaults() { return {"grid", "moller", "impulse", "gl"}; }

PluginLibrary open_plugins(const std::vector<std::string>& plugin_path, const std::filesystem::path& scene_folder) {
    const std::vector<std::filesystem::path> folders(plugin_path.begin(), plugin_path.end());
    return PluginLibrary(PluginLibrary::search_path(folders, scene_folder));
}

Settings parse_settings(const std::vector<std::string>& arguments) {
    Settings settings;
    for (const std::string& argument : arguments) settings.push_back(split_assignment(argument, "--set"));
    return settings;
}

std::vector<Variation> parse_variations(const std::vector<std::string>& arguments) {
    std::vector<Variation> variations;
    for (const std::string& argument : arguments) {
        const auto [key, values] = split_assignment(argument, "--vary");
        variations.push_back({key, split_values(values)});
    }
    return variations;
}

std::vector<Settings> combinations(const std::vector<Variation>& variations) {
    std::vector<Settings> result(1);
    for (const Variation& variation : variations) {
        std::vector<Settings> longer;
        for (const Settings& settings : result)
            for (const std::string& value : variation.values) {
                longer.push_back(settings);
                longer.back().emplace_back(variation.key, value);
            }
        result = std::move(longer);
    }
    return result;
}

std::string label(const Settings& settings) {
    std::string text;
    for (const auto& [key, value] : settings)
        text += (text.empty() ? "" : " ") + (key.ends_with(".plugin") ? value : key + "=" + value);
    return text;
}

std::uint64_t RunLength::count(double dt, double fallback) const {
    return steps ? *steps : steps_in(time.value_or(fallback), dt);
}

void add_set_option(CLI::App& command, std::vector<std::string>& set) {
    command.add_option("--set", set, "Override a key of scene or pipeline (KEY=VALUE, repeatable)")
        ->allow_extra_args(false);
}

void add_plugin_path_option(CLI::App& command, std::vector<std::string>& plugin_path) {
    command.add_option("--plugin-path", plugin_path, "Folder to search for plugins first (repeatable)")
        ->allow_extra_args(false)
        ->check(CLI::ExistingDirectory);
}

void add_length_options(CLI::App& command, RunLength& length) {
    CLI::Option* time = command.add_option("--time", length.time, "Simulated time in s")->check(CLI::PositiveNumber);
    command.add_option("--steps", length.steps, "Number of steps")->check(CLI::Range(1, 1000000000))->excludes(time);
}

int all_cores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

void add_threads_option(CLI::App& command, int& threads) {
    command.add_option("--threads", threads, "Number of threads; results do not depend on it")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
}

void add_json_option(CLI::App& command, std::string& json) {
    command.add_option("--json", json, "Write the results as JSON to this file; - is stdout, and nothing else there");
}

void Table::print(std::ostream& out) const {
    std::vector<std::size_t> width;
    for (const auto& row : rows_)
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (i >= width.size()) width.push_back(0);
            width[i] = std::max(width[i], row[i].size());
        }
    for (const auto& row : rows_) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string gap(width[i] - row[i].size(), ' ');
            line += i == 0 ? row[i] + gap : "  " + gap + row[i];
        }
        out << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
    }
}

std::string number(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

double quantile(std::vector<double> samples, double p) {
    if (samples.empty()) return 0;
    std::sort(samples.begin(), samples.end());
    const double place = p * static_cast<double>(samples.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, samples.size() - 1);
    return samples[low] + (place - static_cast<double>(low)) * (samples[high] - samples[low]);
}

Progress::Progress(std::string what, std::uint64_t total)
    : what_(std::move(what)),
      total_(total),
      terminal_(isatty(STDERR_FILENO)),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

Progress::~Progress() {
    if (drawn_) std::cerr << "\r\033[K" << std::flush;
}

void Progress::advance(std::uint64_t count) {
    done_ += count;
    if (!terminal_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - start_ > std::chrono::seconds(2) && now - last_ > std::chrono::milliseconds(100)) draw(now);
}

void Progress::draw(std::chrono::steady_clock::time_point now) {
    constexpr int width = 40;
    const double share = total_ ? static_cast<double>(done_) / static_cast<double>(total_) : 1;
    const int filled = static_cast<int>(share * width);
    std::cerr << '\r' << what_ << " [" << std::string(filled, '#') << std::string(width - filled, ' ') << "] "
              << static_cast<int>(100 * share) << " %\033[K" << std::flush;
    last_ = now;
    drawn_ = true;
}

}  // namespace kolize::cli
