// The page of kolize stability: a table for each study, bars for how much of each axis holds, and maps.
#include "stability/report.h"

#include <algorithm>
#include <sstream>

namespace kolize::cli::stability {
namespace {

constexpr const char* head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Stability envelope</title><style>
body{font:15px/1.45 system-ui,sans-serif;margin:0 auto;padding:1em;max-width:62em;color:#222;background:#fff}
h2{margin:2em 0 .3em;border-top:1px solid #ccc;padding-top:.6em}
.wide{overflow-x:auto}table{border-collapse:collapse}
th,td{text-align:left;padding:.25em .6em;border-bottom:1px solid #e4e4e4;white-space:nowrap;font-variant-numeric:tabular-nums}
td.limit{min-width:7em}.bar{height:5px;background:#eee;margin-top:2px}.bar i{display:block;height:5px}
.holds i{background:#2e8b57}.refuses i{background:#d39b00}.silent i{background:#c0392b}
.holds b{color:#1f6b42}.refuses b{color:#8a6500}.silent b{color:#a02818}b{font-weight:600}
dl{display:grid;grid-template-columns:max-content 1fr;gap:.1em 1em;color:#555;margin:.5em 0}dt{font-family:monospace}dd{margin:0}
details{margin:.5em 0;color:#444}li{margin:.2em 0;overflow-wrap:anywhere}
figure{display:inline-block;margin:.6em .8em .6em 0;vertical-align:top}figcaption{font-size:13px;color:#444}svg{max-width:100%;height:auto}
</style></head><body>
)";

constexpr const char* colours[] = {"#1b6ca8", "#c0392b", "#2e8b57", "#8e44ad", "#d35400", "#16a085", "#7f6000",
                                   "#c2185b", "#455a64", "#5d4037", "#0097a7", "#689f38", "#303f9f"};

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return result;
}

const char* style(const Envelope& envelope) {
    return envelope.to_the_end() ? "holds" : envelope.silent ? "silent" : "refuses";
}

void write_cell(std::ostream& page, const Row& row) {
    const Axis& axis = row.axis();
    const double share = row.envelope.holds_to ? (*row.envelope.holds_to - axis.from) / (axis.to - axis.from) : 0;
    page << "<td class=\"limit " << style(row.envelope) << "\" title=\"" << escaped(note(row)) << "\"><b>"
         << escaped(cell(row.envelope)) << "</b><div class=bar><i style=\"width:" << std::lround(100 * share)
         << "%\"></i></div></td>";
}

void write_table(std::ostream& page, const Survey& survey, const Study& study) {
    const auto rows_of = [&](const Subject& subject) {
        std::vector<const Row*> rows;
        for (const Row& row : survey.rows)
            if (row.study == &study && row.subject == &subject) rows.push_back(&row);
        return rows;
    };
    page << "<div class=wide><table><tr><th>" << study.stage << "</th>";
    for (const Row* row : rows_of(study.subjects.front())) page << "<th>" << row->axis().name << "</th>";
    page << "</tr>\n";
    for (const Subject& subject : study.subjects) {
        page << "<tr><td>" << escaped(subject.name) << "</td>";
        for (const Row* row : rows_of(subject)) write_cell(page, *row);
        page << "</tr>\n";
    }
    page << "</table></div>\n";
}

void write_notes(std::ostream& page, const Survey& survey, const Study& study) {
    std::ostringstream notes;
    for (const Row& row : survey.rows)
        if (row.study == &study && !row.envelope.to_the_end()) notes << "<li>" << escaped(note(row)) << "</li>\n";
    for (const std::string& who : study.left_out) notes << "<li>Not asked: " << escaped(who) << "</li>\n";
    if (!notes.str().empty())
        page << "<details><summary>What happens there</summary><ul>" << notes.str() << "</ul></details>\n";
}

// --- Maps ----------------------------------------------------------------------------------------------------------

constexpr int cell_size = 13, left = 48, below = 34;  // px

int width_of(const Map& map) { return left + cell_size * static_cast<int>(map.columns.size()) + 6; }
int height_of(const Map& map) { return below + cell_size * static_cast<int>(map.rows.size()) + 6; }

void begin_svg(std::ostream& page, const Map& map, const std::string& title) {
    const int width = width_of(map), height = height_of(map);
    page << "<figure><figcaption>" << escaped(title) << "</figcaption><svg viewBox=\"0 0 " << width << ' ' << height
         << "\" width=\"" << width << "\" height=\"" << height
         << "\" font-size=\"10\" font-family=\"sans-serif\" role=\"img\"><title>" << escaped(title) << "</title>\n";
    const int base = height - below;
    const auto label = [&](int x, int y, const char* anchor, const std::string& text) {
        page << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\" fill=\"#444\">" << text
             << "</text>\n";
    };
    label(left - 4, base - 2, "end", magnitude(map.rows.front()));
    label(left - 4, 14, "end", magnitude(map.rows.back()));
    label(left, base + 12, "start", magnitude(map.columns.front()));
    label(width - 2, base + 12, "end", magnitude(map.columns.back()));
    label((left + width) / 2, base + 27, "middle", map.across().name);
    page << "<text transform=\"translate(11 " << base / 2 << ") rotate(-90)\" text-anchor=\"middle\" fill=\"#444\">"
         << map.up().name << "</text>\n";
}

void write_map(std::ostream& page, const Map& map) {
    begin_svg(page, map, map.subject->name);
    const int base = height_of(map) - below;
    for (std::size_t row = 0; row < map.rows.size(); ++row)
        for (std::size_t column = 0; column < map.columns.size(); ++column) {
            const Outcome& outcome = map.at(row, column);
            const char* colour = outcome.holds() ? "#bfe3cd" : outcome.silent() ? "#d9705f" : "#ecc766";
            page << "<rect x=\"" << left + cell_size * static_cast<int>(column) << "\" y=\""
                 << base - cell_size * static_cast<int>(row + 1) << "\" width=\"" << cell_size - 1 << "\" height=\""
                 << cell_size - 1 << "\" fill=\"" << colour << "\"><title>" << map.across().name << ' '
                 << magnitude(map.columns[column]) << ", " << map.up().name << ' ' << magnitude(map.rows[row]) << ": "
                 << word(outcome.failure) << (outcome.holds() ? "" : ": ") << escaped(outcome.sentence)
                 << "</title></rect>\n";
        }
    page << "</svg></figure>\n";
}

// All plugins in one picture: below its line each of them holds.
void write_contours(std::ostream& page, const std::vector<const Map*>& maps) {
    const Map& first = *maps.front();
    begin_svg(page, first, "Contours of first failure");
    const int base = height_of(first) - below;
    for (std::size_t i = 0; i < maps.size(); ++i) {
        page << "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" << colours[i % std::size(colours)]
             << "\" points=\"";
        const std::vector<std::size_t> heights = contour(*maps[i]);
        const double aside = 0.7 * static_cast<double>(i);  // lines that lie on each other can be told apart
        for (std::size_t column = 0; column < heights.size(); ++column)
            for (const std::size_t side : {column, column + 1})
                page << left + cell_size * static_cast<int>(side) << ','
                     << base - cell_size * static_cast<double>(heights[column]) + aside << ' ';
        page << "\"><title>" << escaped(maps[i]->subject->name) << "</title></polyline>\n";
    }
    page << "</svg><figcaption>";
    for (std::size_t i = 0; i < maps.size(); ++i)
        page << "<span style=\"color:" << colours[i % std::size(colours)] << "\">&#9632; "
             << escaped(maps[i]->subject->name) << "</span><br>";
    page << "</figcaption></figure>\n";
}

void write_maps(std::ostream& page, const Survey& survey, const Study& study) {
    std::vector<const Map*> maps;
    for (const Map& map : survey.maps)
        if (map.study == &study) maps.push_back(&map);
    if (maps.empty()) return;
    page << "<h3>" << maps.front()->across().name << " and " << maps.front()->up().name << "</h3>\n";
    if (maps.size() > 1) write_contours(page, maps);
    for (const Map* map : maps) write_map(page, *map);
}

void write_study(std::ostream& page, const Survey& survey, const Study& study) {
    page << "<h2>" << study.stage << ": " << study.output << "</h2>\n<p>" << escaped(study.asks) << "</p>\n<dl>";
    for (const Axis& axis : study.axes)
        page << "<dt>" << axis.name << "</dt><dd>" << escaped(axis.doc) << ", " << magnitude(axis.from) << " to "
             << magnitude(axis.to) << ' ' << axis.unit << " (else " << magnitude(axis.usual) << ")</dd>";
    page << "</dl>\n";
    write_table(page, survey, study);
    write_notes(page, survey, study);
    write_maps(page, survey, study);
}

}  // namespace

std::string html_report(const Survey& survey) {
    std::ostringstream page;
    page << head << "<h1>Stability envelope</h1>\n<p>The last magnitude of each axis up to which answers hold, to "
         << resolution << " decade, and what happens beyond it; the bar is the share of the axis. Green holds to the "
         << "end, amber refuses with a message, red fails without one. * holds again farther on. Seed " << survey.seed
         << ".</p>\n<p><code>" << escaped(command_line()) << "</code></p>\n";
    for (const Study& study : survey.studies)
        if (std::any_of(survey.rows.begin(), survey.rows.end(), [&](const Row& row) { return row.study == &study; }))
            write_study(page, survey, study);
    page << "</body></html>\n";
    return page.str();
}

}  // namespace kolize::cli::stability
