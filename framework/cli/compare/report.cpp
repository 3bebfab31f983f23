#include "compare/report.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

namespace kolize::cli {
namespace {

std::string file_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string hash_of(const std::string& bytes) {
    std::uint64_t hash = 14695981039346656037ull;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    return hex(hash);
}

std::string estimate_text(const Estimate& e) {
    return number(e.value) + " (" + number(e.low) + "-" + number(e.high) + ")";
}

std::string front_mark(const Variant& v) { return v.safe_front ? "*" : v.front ? "o" : ""; }

std::string missed_text(const Variant& v) { return v.judged ? std::to_string(v.judged->misses.count) : "-"; }
std::string false_text(const Variant& v) { return v.judged ? std::to_string(v.judged->false_hits.count) : "-"; }

void print_table(const Comparison& comparison, std::ostream& out) {
    Table table({"pipeline", "", "step us (95 %)", "p95 us", "ms/s", "broad us", "narrow us", "resp us", "pairs",
                 "contacts", "energy drift", "mom. drift", "deepest m", "missed", "false", "escaped", "stuck", "hash"});
    for (const Variant& v : comparison.variants) {
        const RunResult& r = v.summary;
        table.add({v.label, front_mark(v), estimate_text(v.step), number(r.step.p95_us), number(v.cost_ms()),
                   number(r.broadphase.median_us), number(r.narrowphase.median_us), number(r.response.median_us),
                   std::to_string(r.pairs), std::to_string(r.contacts), number(r.energy_drift),
                   number(r.momentum_drift), number(r.max_penetration_m), missed_text(v), false_text(v),
                   std::to_string(r.escaped), std::to_string(r.stuck), v.repeatable ? hex(r.state_hash) : "DIFFERS"});
    }
    table.print(out);
}

double at_share(const std::vector<double>& values, double share) {
    return values.empty() ? 0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// When the bodies have left the reference by a hundredth of their size; infinity if never.
double horizon(const Course& course) {
    for (std::size_t i = 0; i < course.path_error.size(); ++i)
        if (course.path_error[i] > 0.01) return course.time[i];
    return infinity;
}

void print_paths(const Comparison& comparison, std::ostream& out) {
    if (comparison.options.reference == 0) return;
    out << "\nPath error: root of the mean square distance of the bodies from those of row 1 with steps "
        << comparison.options.reference
        << " times shorter and\nfollowed to every time of impact, where its narrowphase can do that; over their size. "
           "Bodies "
           "that collide part from any\nreference sooner or later: only what comes before says which row is more "
           "accurate.\n\n";
    Table table({"pipeline", "at 1/10", "at 1/2", "at the end", "left by 1 % after s", "energy error per s"});
    for (const Variant& v : comparison.variants) {
        const std::vector<double>& error = v.course.path_error;
        const double left = horizon(v.course);
        table.add({v.label, number(at_share(error, 0.1)), number(at_share(error, 0.5)), number(at_share(error, 1)),
                   std::isinf(left) ? "never" : number(left), number(v.course.energy_slope)});
    }
    table.print(out);
}

void print_verdicts(const Comparison& comparison, std::ostream& out) {
    Table table({"pipeline", "against the baseline", "beaten by"});
    for (const Variant& v : comparison.variants) table.add({v.label, v.verdict, v.dominated_by});
    table.print(out);
}

void print_notes(const Comparison& comparison, std::ostream& out) {
    out << "\n* no other row is both faster (as shown by the interval of their ratio; with fewer than six runs: by "
        << 100 * time_noise << " %) and at least as\n  accurate (energy drift, equal below " << drift_floor
        << "), or not slower and more accurate, of those in which nothing escaped, stuck or was missed; o: of all.\n"
        << "ms/s: work for a second of simulated time, which rows are compared by.\n"
        << "Intervals hold the true median with 95 % confidence: by bootstrap for times, by order statistics of the "
           "ratios "
           "within each round for verdicts.\n";
    for (const Variant& v : comparison.variants) {
        if (!v.repeatable)
            out << "\nNOT REPEATABLE: " << v.label
                << " gave different results for the same input; none of its numbers can be trusted.\n";
        for (const std::string& broken : v.breaks)
            if (!v.again) out << "\nGATE: " << v.label << ": " << broken << '\n';
    }
    for (const std::string& warning : comparison.warnings) out << "\nWARNING: " << warning << '\n';
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
}

std::string first_line(const char* file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

Json machine_json() {
    Json machine = host_block();
    double load[1] = {0};
    machine["load"] = getloadavg(load, 1) == 1 ? Json(load[0]) : Json();
    const std::string governor = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
    machine["governor"] = governor.empty() ? Json("unknown") : Json(governor);
    machine["date"] = today();
    return machine;
}

template <class T>
Json optional_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

Json options_json(const CompareOptions& o) {
    return {{"scenes", o.scenes},
            {"pipelines", o.pipelines},
            {"vary", o.vary},
            {"set", o.set},
            {"plugin_path", o.plugin_path},
            {"time", optional_json(o.length.time)},
            {"steps", optional_json(o.length.steps)},
            {"repeat", o.repeat},
            {"baseline", o.baseline},
            {"judge", o.judge},
            {"reference", o.reference},
            {"budget_ms", optional_json(o.gates.budget_ms)},
            {"max_drift", optional_json(o.gates.drift)},
            {"max_missed", optional_json(o.gates.missed)},
            {"threads", o.threads}};
}

Json estimate_json(const Estimate& e) {
    return {{"median", e.value}, {"low", e.low}, {"high", std::isinf(e.high) ? Json() : Json(e.high)}};
}

Json variant_json(const Variant& v) {
    Json vary = Json::object();
    for (const auto& [key, value] : v.vary) vary[key] = value;
    Json json{{"label", v.label}, {"scene_file", v.scene_file}, {"pipeline_file", v.pipeline}, {"vary", vary}};
    json.update(to_json(v.summary, v.effective));
    json["repeatable"] = v.repeatable;
    json["front"] = v.safe_front;
    json["front_of_all"] = v.front;
    json["again"] = v.again;
    json["ranked"] = v.ranked;
    json["question"] = hex(v.question);
    json["step_us"] = estimate_json(v.step);
    json["cost_ms_per_s"] = v.cost_ms();
    json["step_us_of_runs"] = v.step_us();
    json["ratio"] = estimate_json(v.ratio);
    json["verdict"] = v.verdict;
    json["dominated_by"] = v.dominated_by.empty() ? Json() : Json(v.dominated_by);
    json["breaks"] = v.breaks;
    if (v.judged)
        json["judged"] = {
            {"pairs", v.judged->asked},
            {"missed", v.judged->misses.count},
            {"missed_rate", {v.judged->misses.value(), v.judged->misses.low(), v.judged->misses.high()}},
            {"false_hits", v.judged->false_hits.count},
            {"false_rate", {v.judged->false_hits.value(), v.judged->false_hits.low(), v.judged->false_hits.high()}},
            {"max_angle_rad", v.judged->angle.largest()},
            {"max_depth_error_radii", v.judged->depth.largest()}};
    json["course"] = {{"time", v.course.time},
                      {"energy_error", v.course.energy_error},
                      {"path_error", v.course.path_error},
                      {"energy_slope", v.course.energy_slope}};
    return json;
}

std::string quoted(const std::string& text) {
    std::string cell = "\"";
    for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
    return cell + "\"";
}

}  // namespace

std::string scenes_text(const CompareOptions& options) {
    std::string text;
    for (const std::string& scene : options.scenes) text += (text.empty() ? "" : ", ") + scene;
    return text;
}

std::vector<PluginFile> plugin_files(const std::vector<Variant>& variants, const PluginLibrary& plugins) {
    std::set<std::pair<StageKind, std::string>> names;
    for (const Variant& variant : variants) {
        const PipelineConfig& pipeline = variant.scene.pipeline;
        names.emplace(StageKind::broadphase, pipeline.broadphase.plugin);
        names.emplace(StageKind::narrowphase, pipeline.narrowphase.plugin);
        for (const ResponseRule& rule : pipeline.responses) names.emplace(StageKind::response, rule.stage.plugin);
    }
    std::vector<PluginFile> files;
    for (const auto& [stage, name] : names) {
        const std::filesystem::path file = plugins.require(stage, name).file;
        files.push_back({to_string(stage), name, file.filename().string(), hash_of(file_bytes(file))});
    }
    return files;
}

std::vector<std::string> machine_warnings() {
    std::vector<std::string> warnings;
    const double cores = std::max(1u, std::thread::hardware_concurrency());
    double load[1] = {0};
    if (getloadavg(load, 1) == 1 && load[0] > 0.5 * cores)
        warnings.push_back("the machine is busy (load " + number(load[0]) + " on " + number(cores) +
                           " cores): read ratios, not times");
    const std::string build = host_block()["build_type"].get<std::string>();
    if (build != "Release" && build != "RelWithDebInfo")
        warnings.push_back("this is a build of type " + build + ": its times say nothing of a release");
    return warnings;
}

std::string comparison_text(const Comparison& comparison) {
    std::ostringstream out;
    const CompareOptions& o = comparison.options;
    out << scenes_text(o) << ": " << comparison.variants.size() - 1 << " pipelines, "
        << comparison.variants.front().runs.size() << " runs of each after " << comparison.warm_up_rounds
        << " to warm up, interleaved with seed " << order_seed << ", " << o.threads
        << (o.threads == 1 ? " thread" : " threads")
        << (comparison.judge.empty() ? "" : ", judged by " + comparison.judge) << "\n\n";
    print_table(comparison, out);
    out << '\n';
    print_verdicts(comparison, out);
    print_paths(comparison, out);
    print_notes(comparison, out);
    return out.str();
}

// One row a variant, full precision.
std::string comparison_csv(const Comparison& comparison) {
    std::ostringstream out;
    out.precision(17);
    out << "pipeline,bodies,steps,dt,step_median_us,step_low_us,step_high_us,step_p95_us,integrate_median_us,"
           "broadphase_median_us,narrowphase_median_us,response_median_us,pairs,contacts,triangle_tests,energy_drift,"
           "momentum_drift,angular_momentum_drift,max_penetration_m,missed,false_hits,escaped,stuck,state_hash,"
           "repeatable,"
           "front,ratio,ratio_low,ratio_high,verdict\n";
    for (const Variant& v : comparison.variants) {
        if (v.again) continue;
        const RunResult& r = v.summary;
        out << quoted(v.label) << ',' << r.bodies << ',' << r.steps << ',' << r.dt << ',' << v.step.value << ','
            << v.step.low << ',' << v.step.high << ',' << r.step.p95_us << ',' << r.integrate.median_us << ','
            << r.broadphase.median_us << ',' << r.narrowphase.median_us << ',' << r.response.median_us << ',' << r.pairs
            << ',' << r.contacts << ',' << r.triangle_tests << ',' << r.energy_drift << ',' << r.momentum_drift << ','
            << r.angular_momentum_drift << ',' << r.max_penetration_m << ',' << missed_text(v) << ',' << false_text(v)
            << ',' << r.escaped << ',' << r.stuck << ',' << hex(r.state_hash) << ',' << v.repeatable << ','
            << v.safe_front << ',' << v.ratio.value << ',' << v.ratio.low << ',' << v.ratio.high << ','
            << quoted(v.verdict) << '\n';
    }
    return out.str();
}

Json comparison_json(const Comparison& comparison) {
    Json rows = Json::array(), plugins = Json::array();
    for (const Variant& variant : comparison.variants)
        if (!variant.again) rows.push_back(variant_json(variant));
    for (const PluginFile& p : comparison.plugins)
        plugins.push_back({{"stage", p.stage}, {"name", p.name}, {"file", p.file}, {"hash", p.hash}});
    Json hashes = Json::array();
    for (const std::string& scene : comparison.options.scenes) hashes.push_back(hash_of(file_bytes(scene)));
    return {{"scene", scenes_text(comparison.options)},
            {"scene_hashes", hashes},
            {"repeat", comparison.variants.front().runs.size()},
            {"warm_up_rounds", comparison.warm_up_rounds},
            {"order_seed", order_seed},
            {"baseline", comparison.variants[comparison.baseline].label},
            {"judge", comparison.judge},
            {"variants", rows},
            {"again", variant_json(comparison.variants.back())},
            {"plugins", plugins},
            {"warnings", comparison.warnings},
            {"options", options_json(comparison.options)},
            {"host", machine_json()},
            {"command", command_line()}};
}

Json read_report(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw Error("report '" + file.string() + "' cannot be read");
    Json report = Json::parse(in, nullptr, false);
    if (!report.is_object() || !report.contains("options") || !report.contains("variants"))
        throw Error("'" + file.string() + "' is no compare.json of this version");
    return report;
}

CompareOptions options_from(const Json& report, const std::filesystem::path& file) {
    const Json& json = report["options"];
    CompareOptions o;
    try {
        const auto read = [&](const char* key, auto& optional) {
            using T = typename std::remove_reference_t<decltype(optional)>::value_type;
            if (!json.at(key).is_null()) optional = json.at(key).get<T>();
        };
        json.at("scenes").get_to(o.scenes);
        json.at("pipelines").get_to(o.pipelines);
        json.at("vary").get_to(o.vary);
        json.at("set").get_to(o.set);
        json.at("plugin_path").get_to(o.plugin_path);
        read("time", o.length.time);
        read("steps", o.length.steps);
        json.at("repeat").get_to(o.repeat);
        json.at("baseline").get_to(o.baseline);
        json.at("judge").get_to(o.judge);
        json.at("reference").get_to(o.reference);
        read("budget_ms", o.gates.budget_ms);
        read("max_drift", o.gates.drift);
        read("max_missed", o.gates.missed);
        json.at("threads").get_to(o.threads);
    } catch (const Json::exception& e) {
        throw Error("'" + file.string() + "' is no compare.json of this version: " + e.what());
    }
    return o;
}

std::vector<std::string> compare_reports(const Json& first, const Json& second) {
    std::vector<std::string> differences;
    if (first["scene_hashes"] != second["scene_hashes"]) differences.push_back("a scene file is another one");
    const Json &rows = first["variants"], &others = second["variants"];
    if (rows.size() != others.size()) return {"it has " + std::to_string(others.size()) + " rows now"};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string label = rows[i]["label"];
        for (const char* key : {"label", "bodies", "steps", "counts", "accuracy", "state_hash", "question", "course"})
            if (rows[i][key] != others[i][key]) differences.push_back(label + ": " + key);
        const auto bound = [](const Json& value, double otherwise) {
            return value.is_null() ? otherwise : value.get<double>();
        };
        const Json &a = rows[i]["ratio"], &b = others[i]["ratio"];
        if (bound(a["low"], 0) > bound(b["high"], infinity) || bound(b["low"], 0) > bound(a["high"], infinity))
            differences.push_back(label + ": the ratio to the baseline, " + number(b["median"]) + " where it was " +
                                  number(a["median"]));
    }
    return differences;
}

}  // namespace kolize::cli
