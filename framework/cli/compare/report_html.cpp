// The report as one HTML file: tables, charts drawn here as SVG, and the raw data. No script, nothing from a network.
#include "compare/report.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace kolize::cli {
namespace {

// Of the Okabe-Ito palette, which colour-blind readers can tell apart; repeated with dashes where there are more rows.
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#8c6d31", "#777777"};
std::string colour(std::size_t i) { return colours[i % std::size(colours)]; }
std::string dash(std::size_t i) {
    return i < std::size(colours) ? ""
                                  : " stroke-dasharray=\"" + std::to_string(2 + 2 * (i / std::size(colours))) + " 3\"";
}

constexpr const char* style = R"(
:root{color-scheme:light dark;--ink:#1b1b1b;--paper:#fff;--soft:#666;--line:#ccc;--mark:#f2f5f9}
@media(prefers-color-scheme:dark){:root{--ink:#e8e8e8;--paper:#16181c;--soft:#a0a0a0;--line:#444;--mark:#22262d}}
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:72rem;margin:0 auto;padding:1rem}
h1{font-size:1.5rem;margin:.2em 0}h2{font-size:1.15rem;margin:2rem 0 .5rem}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:.85rem;font-variant-numeric:tabular-nums}
th,td{padding:.25rem .6rem;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}
th:first-child,td:first-child{text-align:left;position:sticky;left:0;background:var(--paper)}
tr.front td{background:var(--mark)}td.text{text-align:left;white-space:normal;min-width:12rem}
dl{display:grid;grid-template-columns:max-content 1fr;gap:.1rem 1rem;font-size:.85rem}dt{color:var(--soft)}dd{margin:0;overflow-wrap:anywhere}
svg{width:100%;height:auto;max-width:60rem;display:block}svg text{fill:var(--ink);font:12px system-ui,sans-serif}
svg .axis{stroke:var(--soft);stroke-width:1}svg .grid{stroke:var(--line);stroke-width:.5}svg .soft{fill:var(--soft)}
.warning{border-left:4px solid #d55e00;padding:.2rem .8rem;margin:.5rem 0;background:var(--mark)}
.legend{display:flex;flex-wrap:wrap;gap:.2rem 1rem;font-size:.85rem;padding:0;list-style:none}
.swatch{display:inline-block;width:.8em;height:.8em;margin-right:.4em;border-radius:2px}
pre{overflow-x:auto;background:var(--mark);padding:.6rem;font-size:.8rem}
)";

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) switch (c) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        default: result += c;
        }
    return result;
}

// An axis of a chart: values to pixels, with ticks at powers of ten or at round numbers.
class Axis {
public:
    Axis(double low, double high, double from, double to, bool logarithmic)
        : low_(logarithmic ? std::floor(std::log10(low)) : 0),
          high_(logarithmic ? std::ceil(std::log10(high)) : high),
          from_(from),
          to_(to),
          logarithmic_(logarithmic) {
        if (!(high_ > low_)) high_ = low_ + 1;
    }

    double at(double value) const {
        const double x = logarithmic_ ? std::log10(value) : value;
        return from_ + (to_ - from_) * std::clamp((x - low_) / (high_ - low_), 0.0, 1.0);
    }
    std::vector<double> ticks() const {
        std::vector<double> all;
        if (logarithmic_) {
            const double step = std::max(1.0, std::ceil((high_ - low_) / 8));
            for (double e = low_; e <= high_; e += step) all.push_back(std::pow(10, e));
        } else {
            const double raw = high_ / 5, ten = std::pow(10, std::floor(std::log10(raw)));
            const double step = raw > 5 * ten ? 10 * ten : raw > 2 * ten ? 5 * ten : raw > ten ? 2 * ten : ten;
            for (double v = 0; v <= high_ * (1 + 1e-9); v += step) all.push_back(v);
        }
        return all;
    }

private:
    double low_, high_, from_, to_;
    bool logarithmic_;
};

constexpr double width = 720, left = 64, right = 700;

std::string text(double x, double y, const std::string& what, const std::string& more = "") {
    std::ostringstream out;
    out << "<text x=\"" << x << "\" y=\"" << y << "\" " << more << ">" << escaped(what) << "</text>";
    return out.str();
}

std::string frame(const Axis& x, const Axis& y, double top, double bottom, const std::string& x_name,
                  const std::string& y_name) {
    std::ostringstream out;
    for (const double t : x.ticks())
        out << "<line class=\"grid\" x1=\"" << x.at(t) << "\" x2=\"" << x.at(t) << "\" y1=\"" << top << "\" y2=\""
            << bottom << "\"/>" << text(x.at(t), bottom + 16, number(t), "text-anchor=\"middle\" class=\"soft\"");
    for (const double t : y.ticks())
        out << "<line class=\"grid\" x1=\"" << left << "\" x2=\"" << right << "\" y1=\"" << y.at(t) << "\" y2=\""
            << y.at(t) << "\"/>" << text(left - 6, y.at(t) + 4, number(t), "text-anchor=\"end\" class=\"soft\"");
    out << "<path class=\"axis\" fill=\"none\" d=\"M" << left << ' ' << top << 'V' << bottom << 'H' << right << "\"/>"
        << text(0.5 * (left + right), bottom + 34, x_name, "text-anchor=\"middle\"") << text(left, top - 8, y_name);
    return out.str();
}

std::string chart(double height, const std::string& title, const std::string& body) {
    std::ostringstream out;
    out << "<svg viewBox=\"0 0 " << width << ' ' << height << "\" role=\"img\" aria-label=\"" << escaped(title) << "\">"
        << body << "</svg>\n";
    return out.str();
}

using Rows = std::vector<const Variant*>;  // without the baseline's second run

std::string legend(const Rows& rows) {
    std::string out = "<ul class=\"legend\">";
    for (std::size_t i = 0; i < rows.size(); ++i)
        out += "<li><span class=\"swatch\" style=\"background:" + colour(i) + "\"></span>" + std::to_string(i + 1) +
               ". " + escaped(rows[i]->label) + "</li>";
    return out + "</ul>\n";
}

double error_of(const Variant& v) { return std::max(v.summary.energy_drift, 1e-16); }

// Time against drift, both logarithmic: what lies to the lower left is better.
std::string front_chart(const Rows& rows) {
    constexpr double top = 28, bottom = 330;
    double fast = infinity, slow = 0, good = infinity, bad = 0;
    for (const Variant* v : rows) {
        fast = std::min(fast, v->cost_ms()), slow = std::max(slow, v->cost_ms());
        good = std::min(good, error_of(*v)), bad = std::max(bad, std::isfinite(error_of(*v)) ? error_of(*v) : 1);
    }
    const Axis x(std::max(fast, 1e-6), slow, left, right, true), y(good, bad, bottom, top, true);
    std::ostringstream out;
    out << frame(x, y, top, bottom, "ms of work for a second of simulated time", "energy drift");
    for (const bool safe : {false, true}) {
        Rows front;
        for (const Variant* v : rows)
            if (safe ? v->safe_front : v->front) front.push_back(v);
        std::sort(front.begin(), front.end(), [](auto a, auto b) { return a->cost_ms() < b->cost_ms(); });
        if (front.size() < 2) continue;
        out << "<polyline fill=\"none\" stroke=\"" << (safe ? "#009e73" : "#999") << "\" stroke-width=\""
            << (safe ? 2 : 1) << "\" points=\"";
        for (const Variant* v : front) out << x.at(v->cost_ms()) << ',' << y.at(error_of(*v)) << ' ';
        out << "\"/>";
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Variant& v = *rows[i];
        const double px = x.at(v.cost_ms()), per_us = v.cost_ms() / v.step.value, py = y.at(error_of(v));
        out << "<line x1=\"" << x.at(std::max(per_us * v.step.low, 1e-6)) << "\" x2=\"" << x.at(per_us * v.step.high)
            << "\" y1=\"" << py << "\" y2=\"" << py << "\" stroke=\"" << colour(i) << "\"/><circle cx=\"" << px
            << "\" cy=\"" << py << "\" r=\"" << (v.safe_front ? 6 : 4) << "\" fill=\""
            << (v.front || v.safe_front ? colour(i) : "none") << "\" stroke=\"" << colour(i)
            << "\" stroke-width=\"2\"><title>" << escaped(v.label) << "</title></circle>"
            << text(px + 8, std::max(py - 6 - 11 * double(i % 3), top + 10), std::to_string(i + 1));
    }
    return chart(372, "Time against accuracy", out.str());
}

std::string stage_chart(const Rows& rows) {
    constexpr double bar = 22, top = 28;
    const double bottom = top + bar * static_cast<double>(rows.size());
    double longest = 0;
    const auto stages = [](const Variant& v) {
        const RunResult& r = v.summary;
        const double steps = std::max<double>(1, static_cast<double>(r.steps));
        const auto us = [&](const StageTime& t) { return 1e6 * t.total_s / steps; };
        const double sum = us(r.integrate) + us(r.broadphase) + us(r.narrowphase) + us(r.response);
        return std::array{us(r.integrate), us(r.broadphase), us(r.narrowphase), us(r.response),
                          std::max(0.0, us(r.step) - sum)};
    };
    for (const Variant* v : rows) {
        double sum = 0;
        for (const double us : stages(*v)) sum += us;
        longest = std::max(longest, sum);
    }
    const Axis x(0, longest, left, right, false), y(0, 1, bottom, top, false);
    constexpr const char* names[] = {"integrate", "broadphase", "narrowphase", "response", "the rest"};
    std::ostringstream out;
    for (const double t : x.ticks())
        out << "<line class=\"grid\" x1=\"" << x.at(t) << "\" x2=\"" << x.at(t) << "\" y1=\"" << top << "\" y2=\""
            << bottom << "\"/>" << text(x.at(t), bottom + 16, number(t), "text-anchor=\"middle\" class=\"soft\"");
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double from_top = top + bar * static_cast<double>(i);
        double sum = 0;
        const auto parts = stages(*rows[i]);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            out << "<rect x=\"" << x.at(sum) << "\" y=\"" << from_top + 3 << "\" width=\""
                << x.at(sum + parts[k]) - x.at(sum) << "\" height=\"" << bar - 6 << "\" fill=\"" << colour(k)
                << "\"><title>" << names[k] << ' ' << number(parts[k]) << " \u00b5s</title></rect>";
            sum += parts[k];
        }
        out << text(left - 8, from_top + 16, std::to_string(i + 1), "text-anchor=\"end\"");
    }
    out << text(0.5 * (left + right), bottom + 34, "mean of a step, \u00b5s", "text-anchor=\"middle\"");
    double at = left;
    for (std::size_t k = 0; k < std::size(names); ++k) {
        out << "<rect x=\"" << at << "\" y=\"8\" width=\"10\" height=\"10\" fill=\"" << colour(k) << "\"/>"
            << text(at + 14, 17, names[k]);
        at += 112;
    }
    return chart(bottom + 44, "Cost of the stages", out.str());
}

// Over time, on a logarithmic scale; values of 0 lie on its lower end.
std::string course_chart(const Rows& rows, std::vector<double> Course::*values, const std::string& name, double least) {
    constexpr double top = 28, bottom = 300;
    double last = 0, high = 10 * least, low = infinity;
    for (const Variant* v : rows) {
        if (!v->course.time.empty()) last = std::max(last, v->course.time.back());
        for (const double value : v->course.*values)
            if (std::isfinite(value) && value > 0)
                high = std::max(high, value), low = std::min(low, std::max(value, least));
    }
    const Axis x(0, last, left, right, false), y(std::isinf(low) ? least : low, high, bottom, top, true);
    std::ostringstream out;
    out << frame(x, y, top, bottom, "simulated time, s", name);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Course& course = rows[i]->course;
        out << "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"" << colour(i) << '"' << dash(i) << " points=\"";
        for (std::size_t k = 0; k < (course.*values).size(); ++k)
            if (std::isfinite((course.*values)[k]))
                out << number(x.at(course.time[k]), 5) << ',' << number(y.at(std::max((course.*values)[k], least)), 5)
                    << ' ';
        out << "\"><title>" << escaped(rows[i]->label) << "</title></polyline>";
    }
    return chart(342, name, out.str());
}

// Rows of several scenes by their method, in the order of the first scene.
std::vector<std::pair<std::string, Rows>> by_method(const Rows& rows) {
    std::vector<std::pair<std::string, Rows>> methods;
    for (const Variant* v : rows) {
        const auto known =
            std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.first == v->method; });
        (known == methods.end() ? methods.emplace_back(v->method, Rows{}) : *known).second.push_back(v);
    }
    return methods;
}

std::string method_legend(const std::vector<std::pair<std::string, Rows>>& methods) {
    std::string out = "<ul class=\"legend\">";
    for (std::size_t i = 0; i < methods.size(); ++i)
        out += "<li><span class=\"swatch\" style=\"background:" + colour(i) + "\"></span>" + escaped(methods[i].first) +
               "</li>";
    return out + "</ul>\n";
}

// Cost over the number of bodies, both logarithmic: a slope of 1 is cost in proportion.
std::string scaling_chart(const std::vector<std::pair<std::string, Rows>>& methods) {
    constexpr double top = 28, bottom = 300;
    double few = infinity, many = 0, cheap = infinity, dear = 0;
    for (const auto& [name, rows] : methods)
        for (const Variant* v : rows) {
            few = std::min(few, double(v->summary.bodies)), many = std::max(many, double(v->summary.bodies));
            cheap = std::min(cheap, v->cost_ms()), dear = std::max(dear, v->cost_ms());
        }
    if (!(many > few)) return {};
    const Axis x(few, many, left, right, true), y(std::max(cheap, 1e-6), dear, bottom, top, true);
    std::ostringstream out;
    out << frame(x, y, top, bottom, "bodies", "ms of work for a second of simulated time");
    for (std::size_t i = 0; i < methods.size(); ++i) {
        Rows rows = methods[i].second;
        std::stable_sort(rows.begin(), rows.end(),
                         [](auto a, auto b) { return a->summary.bodies < b->summary.bodies; });
        out << "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"" << colour(i) << '"' << dash(i) << " points=\"";
        for (const Variant* v : rows) out << x.at(double(v->summary.bodies)) << ',' << y.at(v->cost_ms()) << ' ';
        out << "\"/>";
        for (const Variant* v : rows)
            out << "<circle r=\"3\" cx=\"" << x.at(double(v->summary.bodies)) << "\" cy=\"" << y.at(v->cost_ms())
                << "\" fill=\"" << colour(i) << "\"><title>" << escaped(v->label) << "</title></circle>";
    }
    return "<h2>Scaling</h2>\n" + chart(342, "Scaling with the number of bodies", out.str()) + method_legend(methods);
}

// Performance profile (Dolan and More 2002): the share of scenes in which a method takes at most so many times as long
// as the fastest safe one there; a row that is not on equal terms, or not safe, counts as infinitely slow.
std::string profile_chart(const Comparison& comparison, const std::vector<std::pair<std::string, Rows>>& methods) {
    constexpr double top = 28, bottom = 300;
    const std::vector<std::string>& scenes = comparison.options.scenes;
    const auto cost = [](const Variant* v) { return v->ranked && is_safe(*v) ? v->cost_ms() : infinity; };
    std::vector<double> best;
    for (const std::string& scene : scenes) {
        best.push_back(infinity);
        for (const auto& [name, rows] : methods)
            for (const Variant* v : rows)
                if (v->scene_file == scene) best.back() = std::min(best.back(), cost(v));
    }
    double worst = 1;
    std::vector<std::vector<double>> times_best;
    for (const auto& [name, rows] : methods) {
        times_best.emplace_back();
        for (const Variant* v : rows) {
            const auto scene =
                static_cast<std::size_t>(std::find(scenes.begin(), scenes.end(), v->scene_file) - scenes.begin());
            times_best.back().push_back(cost(v) / best[scene]);
            if (std::isfinite(times_best.back().back())) worst = std::max(worst, times_best.back().back());
        }
        std::sort(times_best.back().begin(), times_best.back().end());
    }
    const Axis x(1, std::max(worst, 1.1), left, right, true), y(0, 1, bottom, top, false);
    std::ostringstream out;
    out << frame(x, y, top, bottom, "times as long as the fastest of the scene", "share of scenes");
    for (std::size_t i = 0; i < methods.size(); ++i) {
        out << "<path fill=\"none\" stroke-width=\"1.5\" stroke=\"" << colour(i) << '"' << dash(i) << " d=\"M" << left
            << ' ' << y.at(0);
        double share = 0;
        for (const double times : times_best[i])
            if (std::isfinite(times)) out << 'H' << x.at(times) << 'V' << y.at(share += 1 / double(scenes.size()));
        out << 'H' << right << "\"><title>" << escaped(methods[i].first) << "</title></path>";
    }
    return "<h2>Profile over the scenes</h2>\n" + chart(342, "Performance profile", out.str()) + method_legend(methods);
}

std::string table(const Comparison& comparison) {
    std::ostringstream out;
    out << "<div class=\"scroll\"><table><tr><th>pipeline</th><th>front</th><th>step \u00b5s (95 %)</th><th>p95 "
           "\u00b5s</th>"
           "<th>against the baseline</th><th>pairs</th><th>contacts</th><th>energy drift</th><th>momentum drift</th>"
           "<th>deepest m</th><th>missed</th><th>false</th><th>escaped</th><th>stuck</th><th>beaten by</th><th>state "
           "hash</th></tr>\n";
    std::size_t row = 0;
    for (const Variant& v : comparison.variants) {
        const RunResult& r = v.summary;
        const auto cell = [&](const std::string& content, bool words = false) {
            out << (words ? "<td class=\"text\">" : "<td>") << escaped(content) << "</td>";
        };
        out << "<tr" << (v.safe_front ? " class=\"front\"" : "") << ">";
        cell((v.again ? "" : std::to_string(++row) + ". ") + v.label, true);
        cell(v.safe_front ? "safe" : v.front ? "all" : "");
        cell(number(v.step.value) + " (" + number(v.step.low) + " to " + number(v.step.high) + ")");
        cell(number(r.step.p95_us));
        cell(number(v.cost_ms()));
        std::string words = v.verdict;
        for (const std::string& broken : v.breaks) words += "; gate: " + broken;
        cell(words, true);
        cell(std::to_string(r.pairs));
        cell(std::to_string(r.contacts));
        cell(number(r.energy_drift));
        cell(number(r.momentum_drift));
        cell(number(r.max_penetration_m));
        cell(v.judged ? std::to_string(v.judged->misses.count) : "-");
        cell(v.judged ? std::to_string(v.judged->false_hits.count) : "-");
        cell(std::to_string(r.escaped));
        cell(std::to_string(r.stuck));
        cell(v.dominated_by, true);
        cell(v.repeatable ? hex(r.state_hash) : "DIFFERS");
        out << "</tr>\n";
    }
    out << "</table></div>\n";
    return out.str();
}

std::string plain(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

std::string facts(const Comparison& comparison, const Json& json) {
    std::ostringstream out;
    const auto fact = [&](const std::string& name, const std::string& value) {
        out << "<dt>" << escaped(name) << "</dt><dd>" << escaped(value) << "</dd>";
    };
    out << "<dl>";
    const Json& host = json["host"];
    fact("repeat it by", plain(json["command"]));
    fact("check it by", "kolize compare --rerun compare.json");
    for (const char* key :
         {"date", "cpu", "cores", "governor", "load", "compiler", "build_type", "version", "plugin_api"})
        fact(key, plain(host[key]));
    for (std::size_t i = 0; i < comparison.options.scenes.size(); ++i)
        fact("scene", comparison.options.scenes[i] + ", hash " + plain(json["scene_hashes"][i]));
    fact("runs", std::to_string(comparison.variants.front().runs.size()) + " of each after " +
                     std::to_string(comparison.warm_up_rounds) + " to warm up, interleaved, order by seed " +
                     std::to_string(order_seed));
    if (!comparison.judge.empty()) fact("judged by", comparison.judge);
    for (const PluginFile& p : comparison.plugins) fact(p.stage + " " + p.name, p.file + ", hash " + p.hash);
    out << "</dl>\n";
    return out.str();
}

}  // namespace

std::string comparison_html(const Comparison& comparison, const Json& json) {
    Rows rows;
    for (const Variant& v : comparison.variants)
        if (!v.again) rows.push_back(&v);
    std::ostringstream out;
    out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
           "content=\"width=device-width,initial-scale=1\"><title>"
        << escaped(scenes_text(comparison.options)) << "</title><style>" << style << "</style></head><body>\n<h1>"
        << escaped(scenes_text(comparison.options)) << "</h1>\n";
    for (const std::string& warning : comparison.warnings)
        out << "<p class=\"warning\">" << escaped(warning) << "</p>\n";
    out << table(comparison)
        << "<p>Front: no other row is both faster and at least as accurate, or as fast and more accurate; "
           "<em>safe</em> of those in "
           "which nothing escaped, stuck or was missed. The row A/A is the baseline once more: what it differs by is "
           "noise. "
           "Intervals hold the true median with 95 % confidence.</p>\n"
        << "<h2>Time against accuracy</h2>\n"
        << front_chart(rows) << legend(rows) << "<h2>Cost of the stages</h2>\n"
        << stage_chart(rows) << "<h2>Energy error over time</h2>\n"
        << course_chart(rows, &Course::energy_error, "energy drift so far", 1e-17);
    if (comparison.options.reference > 0)
        out << "<h2>Path error over time</h2>\n"
            << course_chart(rows, &Course::path_error, "mean distance from the reference, in sizes of a body", 1e-16);
    if (comparison.options.scenes.size() > 1) {
        const auto methods = by_method(rows);
        out << scaling_chart(methods) << profile_chart(comparison, methods);
    }
    std::string data = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos; at += 6) data.replace(at, 1, "\\u003c");
    out << "<h2>How it was measured</h2>\n"
        << facts(comparison, json) << "<script type=\"application/json\" id=\"data\">" << data
        << "</script>\n</body></html>\n";
    return out.str();
}

}  // namespace kolize::cli
