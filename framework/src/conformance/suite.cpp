#include "suite.h"

#include <algorithm>
#include <iomanip>
#include <ostream>

namespace kolize {

namespace {

const char* word(Check::Outcome outcome) {
    switch (outcome) {
    case Check::Outcome::pass: return "pass";
    case Check::Outcome::fail: return "FAIL";
    case Check::Outcome::skip: return "skip";
    }
    return "";
}

}  // namespace

std::vector<Value> values_to_try(const Parameter& parameter) {
    std::vector<Value> values{parameter.default_value};
    for (const std::string& choice : parameter.choices) values.push_back(choice);
    if (std::holds_alternative<bool>(parameter.default_value)) values = {false, true};
    constexpr double most = std::numeric_limits<double>::max();
    for (const double end : {parameter.min, parameter.max}) {
        if (end == -most || end == most) continue;
        if (std::holds_alternative<double>(parameter.default_value)) values.push_back(end);
        if (std::holds_alternative<std::int64_t>(parameter.default_value))
            values.push_back(static_cast<std::int64_t>(end));
    }
    return values;
}

void Suite::run(const char* name, const std::function<void()>& check) {
    Check& result = checks_.emplace_back(Check{name, Check::Outcome::pass, ""});
    try {
        check();
    } catch (const Inapplicable& e) {
        result.outcome = Check::Outcome::skip;
        result.detail = e.what();
    } catch (const std::exception& e) {
        result.outcome = Check::Outcome::fail;
        result.detail = e.what();
    } catch (...) {
        result.outcome = Check::Outcome::fail;
        result.detail = "threw something that is not a std::exception";
    }
}

std::vector<Check> check_plugin(const PluginLibrary& library, const LoadedPlugin& plugin,
                                const ConformanceOptions& options) {
    switch (plugin.descriptor->stage) {
    case StageKind::broadphase: return check_broadphase(library, plugin, options);
    case StageKind::narrowphase: return check_narrowphase(library, plugin, options);
    case StageKind::response: return check_response(library, plugin, options);
    case StageKind::render: return check_renderer(library, plugin, options);
    }
    throw std::invalid_argument("no conformance suite for this stage kind");
}

bool passed(const std::vector<Check>& checks) {
    return std::none_of(checks.begin(), checks.end(),
                        [](const Check& check) { return check.outcome == Check::Outcome::fail; });
}

void print_matrix(std::ostream& out, const std::vector<ConformanceReport>& reports) {
    if (reports.empty()) return;
    std::size_t width = 0;
    for (const Check& check : reports.front().checks) width = std::max(width, check.name.size());
    const auto first_column = static_cast<int>(width);
    const auto column = [](const ConformanceReport& report) {
        return 2 + static_cast<int>(std::max<std::size_t>(4, report.plugin.size()));
    };
    out << std::setw(first_column) << "";
    for (const ConformanceReport& report : reports) out << std::setw(column(report)) << report.plugin;
    out << '\n';
    for (std::size_t row = 0; row < reports.front().checks.size(); ++row) {
        out << std::left << std::setw(first_column) << reports.front().checks[row].name << std::right;
        for (const ConformanceReport& report : reports)
            out << std::setw(column(report)) << word(report.checks.at(row).outcome);
        out << '\n';
    }
    for (const ConformanceReport& report : reports)
        for (const Check& check : report.checks)
            if (check.outcome != Check::Outcome::pass)
                out << report.plugin << ", " << check.name << ": " << word(check.outcome) << ": " << check.detail
                    << '\n';
}

}  // namespace kolize
