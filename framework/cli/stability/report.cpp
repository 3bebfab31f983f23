#include "stability/report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace kolize::cli::stability {
namespace {

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text)
        result += c == '"' ? std::string("\"\"") : c == '\n' ? std::string(" ") : std::string(1, c);
    return result.append("\"");
}

std::string with_unit(double decades, const Axis& axis) {
    return magnitude(decades) + (axis.unit.empty() ? "" : " " + axis.unit);
}

void print_table(std::ostream& out, const Survey& survey, const Study& study) {
    std::vector<std::string> head{study.stage};
    std::vector<std::size_t> columns;
    for (const Row& row : survey.rows)
        if (row.study == &study && std::find(columns.begin(), columns.end(), row.axis_index) == columns.end())
            columns.push_back(row.axis_index);
    for (const std::size_t axis : columns) head.push_back(study.axes[axis].name);
    Table table(head);
    for (const Subject& subject : study.subjects) {
        std::vector<std::string> cells{subject.name};
        for (const Row& row : survey.rows)
            if (row.study == &study && row.subject == &subject) cells.push_back(cell(row.envelope));
        table.add(cells);
    }
    table.print(out);
}

Json to_json(const std::optional<Sample>& sample) {
    if (!sample) return {};
    return {
        {"decades", sample->decades}, {"failure", word(sample->outcome.failure)}, {"what", sample->outcome.sentence}};
}

Json to_json(const std::optional<double>& decades) { return decades ? Json(*decades) : Json(); }

}  // namespace

std::string cell(const Envelope& envelope) {
    if (envelope.to_the_end()) return "all";
    const std::string limit = envelope.holds_to ? magnitude(*envelope.holds_to) : "none";
    return limit + " " + word(envelope.beyond->outcome.failure) + (envelope.again ? " *" : "");
}

std::string note(const Row& row) {
    const Envelope& envelope = row.envelope;
    if (envelope.to_the_end()) return "";
    const auto at = [&](const Sample& sample) {
        return "at " + with_unit(sample.decades, row.axis()) + ": " + sample.outcome.sentence;
    };
    std::string text = row.subject->name + ", " + row.axis().name + ", " + at(*envelope.beyond);
    if (envelope.silent && envelope.silent->decades != envelope.beyond->decades)
        text += "; without a message " + at(*envelope.silent);
    if (envelope.again) text += "; * holds again, at last at " + with_unit(*envelope.again, row.axis());
    return text;
}

std::string text_report(const Survey& survey) {
    std::ostringstream out;
    out << "Stability envelope, seed " << survey.seed
        << ": the last magnitude of each axis up to which answers hold, to " << resolution
        << " decade, and what happens beyond it. all: to the end of the axis.\n";
    for (const Study& study : survey.studies) {
        const auto of_study = [&](const Row& row) { return row.study == &study; };
        if (std::none_of(survey.rows.begin(), survey.rows.end(), of_study)) continue;
        out << "\n" << study.stage << ", " << study.output << "\n" << study.asks << "\n";
        for (const Axis& axis : study.axes)
            out << "  " << axis.name << ": " << axis.doc << ", " << magnitude(axis.from) << " to "
                << with_unit(axis.to, axis) << " (else " << magnitude(axis.usual) << ")\n";
        out << "\n";
        print_table(out, survey, study);
        for (const Row& row : survey.rows)
            if (of_study(row) && !row.envelope.to_the_end()) out << "  " << note(row) << "\n";
        for (const Map& map : survey.maps)
            if (map.study == &study) out << "\n" << text(map);
        for (const std::string& who : study.left_out) out << "  Not asked: " << who << "\n";
    }
    return out.str();
}

std::string csv_report(const Survey& survey) {
    std::ostringstream out;
    out.precision(17);
    out << "stage,output,plugin,axis,unit,from_decades,to_decades,holds_to_decades,failure,fails_at_decades,"
           "silent_failure,silent_at_decades,again_decades,seed,what\n";
    const auto value = [](const std::optional<double>& x) { return x ? number(*x, 6) : std::string(); };
    const auto place = [](const std::optional<Sample>& s) { return s ? number(s->decades, 6) : std::string(); };
    const auto kind = [](const std::optional<Sample>& s) { return s ? word(s->outcome.failure) : ""; };
    for (const Row& row : survey.rows) {
        const Envelope& e = row.envelope;
        out << row.study->stage << ',' << quoted(row.study->output) << ',' << quoted(row.subject->name) << ','
            << row.axis().name << ',' << row.axis().unit << ',' << row.axis().from << ',' << row.axis().to << ','
            << value(e.holds_to) << ',' << kind(e.beyond) << ',' << place(e.beyond) << ',' << kind(e.silent) << ','
            << place(e.silent) << ',' << value(e.again) << ',' << survey.seed << ','
            << quoted(e.beyond ? e.beyond->outcome.sentence : "") << '\n';
    }
    return out.str();
}

Json to_json(const Survey& survey) {
    Json json{{"seed", survey.seed},       {"resolution_decades", resolution}, {"host", host_block()},
              {"command", command_line()}, {"studies", Json::array()},         {"rows", Json::array()}};
    for (const Study& study : survey.studies) {
        Json axes = Json::array();
        for (const Axis& axis : study.axes)
            axes.push_back({{"name", axis.name},
                            {"unit", axis.unit},
                            {"doc", axis.doc},
                            {"from_decades", axis.from},
                            {"to_decades", axis.to},
                            {"usual_decades", axis.usual}});
        json["studies"].push_back({{"stage", study.stage},
                                   {"output", study.output},
                                   {"asks", study.asks},
                                   {"axes", axes},
                                   {"left_out", study.left_out}});
    }
    for (const Row& row : survey.rows) {
        const Envelope& e = row.envelope;
        json["rows"].push_back({{"stage", row.study->stage},
                                {"output", row.study->output},
                                {"plugin", row.subject->name},
                                {"axis", row.axis().name},
                                {"holds_to_the_end", e.to_the_end()},
                                {"holds_to_decades", to_json(e.holds_to)},
                                {"beyond", to_json(e.beyond)},
                                {"silent", to_json(e.silent)},
                                {"again_decades", to_json(e.again)},
                                {"probes", e.probes}});
    }
    if (!survey.maps.empty()) json["maps"] = Json::array();
    for (const Map& map : survey.maps) {
        Json cells = Json::array();
        for (const Outcome& outcome : map.cells) cells.push_back(word(outcome.failure));
        json["maps"].push_back({{"stage", map.study->stage},
                                {"output", map.study->output},
                                {"plugin", map.subject->name},
                                {"across", {{"axis", map.across().name}, {"decades", map.columns}}},
                                {"up", {{"axis", map.up().name}, {"decades", map.rows}}},
                                {"cells", cells}});
    }
    return json;
}

}  // namespace kolize::cli::stability
