// What the judges found, for people and for programs.
#include "judges.h"

#include <nlohmann/json.hpp>

namespace kolize::cli {
namespace {

const char* to_string(Role role) { return role == Role::driver ? "drives" : role == Role::truth ? "truth" : "judge"; }

// "3 (0.1 %, 0.05 to 0.3)" with the interval, "0 (< 0.2 %)", or "-" where there was nothing that could go wrong.
std::string text(const Rate& rate) {
    if (rate.of == 0) return "-";
    if (rate.count == 0) return "0 (< " + number(100 * rate.high()) + " %)";
    return std::to_string(rate.count) + " (" + number(100 * rate.value(), 2) + " %, " + number(100 * rate.low(), 2) +
           " to " + number(100 * rate.high(), 2) + ")";
}

std::string text(const Spread& spread, double p) { return spread.count() ? number(spread.quantile(p)) : "-"; }

std::string largest(const Spread& spread) { return spread.count() ? number(spread.largest()) : "-"; }

std::vector<std::string> row(const Verdict& v) {
    const bool is_truth = v.role == Role::truth;
    return {v.plugin,
            to_string(v.role),
            std::to_string(v.asked),
            std::to_string(v.not_asked),
            is_truth ? "-" : text(v.misses),
            is_truth ? "-" : text(v.false_hits),
            text(v.angle, 0.5),
            largest(v.angle),
            text(v.depth, 0.5),
            largest(v.depth),
            text(v.call_us, 0.5),
            text(v.call_us, 0.95)};
}

Json json_of(const Rate& rate) {
    return {{"count", rate.count}, {"of", rate.of}, {"rate", rate.value()}, {"low", rate.low()}, {"high", rate.high()}};
}

Json json_of(const Spread& spread) {
    return {{"count", spread.count()}, {"p50", spread.quantile(0.5)}, {"max", spread.largest()}};
}

Json json_of(const Verdict& v) {
    Json json{{"plugin", v.plugin}, {"role", to_string(v.role)}, {"asked", v.asked}, {"not_asked", v.not_asked}};
    if (v.role != Role::truth) {
        json["misses"] = json_of(v.misses);
        json["false_hits"] = json_of(v.false_hits);
        json["normal_angle_rad"] = json_of(v.angle);
        json["depth_error_in_radii"] = json_of(v.depth);
    }
    json["call_us"] = {{"count", v.call_us.count()},
                       {"p50", v.call_us.quantile(0.5)},
                       {"p95", v.call_us.quantile(0.95)},
                       {"max", v.call_us.largest()}};
    json["total_s"] = v.total_s;
    json["failures"] = v.failures;
    json["failed_calls"] = v.failed_calls;
    if (v.failed_calls) json["first_failure"] = v.first_failure;
    return json;
}

}  // namespace

void Judges::print(std::ostream& out) const {
    out << "judged by " << verdicts_[1].plugin << ": " << calls_ << " calls\n\n";
    Table table({"narrowphase", "", "pairs", "not asked", "misses (95 %)", "false hits (95 %)", "angle p50", "max rad",
                 "depth p50", "max radii", "call us", "p95 us"});
    for (const Verdict& verdict : verdicts_) table.add(row(verdict));
    table.print(out);
    for (const Verdict& v : verdicts_)
        if (v.failed_calls)
            out << v.plugin << " failed in " << v.failed_calls << " calls, whose pairs are not counted as asked; "
                << v.first_failure << '\n';
    if (touching_calls_)
        out << touching_calls_ << " calls were for bodies that touch without overlapping, and are not judged\n";
    if (!options_.disagreements.empty())
        out << disagreements_ << " disagreements, " << kept_.size() << " kept in " << options_.disagreements << '\n';
}

Json Judges::json() const {
    Json verdicts = Json::array(), kept = Json::array();
    for (const Verdict& verdict : verdicts_) verdicts.push_back(json_of(verdict));
    for (const std::filesystem::path& file : kept_) kept.push_back(file.string());
    return {{"truth", verdicts_[1].plugin},
            {"calls", calls_},
            {"touching_calls_not_judged", touching_calls_},
            {"median_radius_m", median_radius_},
            {"verdicts", verdicts},
            {"disagreements", {{"count", disagreements_}, {"kept", kept}}}};
}

}  // namespace kolize::cli
