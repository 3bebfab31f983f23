#include "stability/map.h"

#include <algorithm>
#include <sstream>

namespace kolize::cli::stability {
namespace {

constexpr int most_intervals = 16;

std::vector<double> places(const Axis& axis) {
    const int count = std::clamp(static_cast<int>(std::ceil(std::abs(axis.to - axis.from))), 4, most_intervals);
    std::vector<double> decades;
    for (int i = 0; i <= count; ++i) decades.push_back(axis.from + (axis.to - axis.from) * i / count);
    return decades;
}

char letter(Failure failure) { return failure == Failure::none ? '.' : word(failure)[0]; }

}  // namespace

std::optional<std::size_t> axis_index(const Study& study, const std::string& name) {
    for (std::size_t i = 0; i < study.axes.size(); ++i)
        if (study.axes[i].name == name) return i;
    return {};
}

Map make_map(const Study& study, const Subject& subject, std::size_t across, std::size_t up) {
    Map map{&study, &subject, across, up, places(study.axes[across]), places(study.axes[up]), {}};
    Point point = study.usual();
    for (const double row : map.rows)
        for (const double column : map.columns) {
            point[across] = column;
            point[up] = row;
            map.cells.push_back(ask(study, subject, point));
        }
    return map;
}

std::string text(const Map& map) {
    std::ostringstream out;
    out << map.subject->name << ": " << map.up().name << " upwards to " << magnitude(map.rows.back()) << ", "
        << map.across().name << " to the right to " << magnitude(map.columns.back()) << "\n";
    std::vector<Failure> kinds;
    for (std::size_t row = map.rows.size(); row-- > 0;) {
        std::string label = magnitude(map.rows[row]);
        label.insert(0, 9 - std::min<std::size_t>(9, label.size()), ' ');
        out << label << "  ";
        for (std::size_t column = 0; column < map.columns.size(); ++column) {
            const Failure failure = map.at(row, column).failure;
            if (std::find(kinds.begin(), kinds.end(), failure) == kinds.end()) kinds.push_back(failure);
            out << letter(failure);
        }
        out << "\n";
    }
    out << "          ";
    for (const Failure failure : kinds) out << " " << letter(failure) << " " << word(failure);
    out << "\n";
    return out.str();
}

std::vector<std::size_t> contour(const Map& map) {
    std::vector<std::size_t> holding;
    for (std::size_t column = 0; column < map.columns.size(); ++column) {
        std::size_t row = 0;
        while (row < map.rows.size() && map.at(row, column).holds()) ++row;
        holding.push_back(row);
    }
    return holding;
}

}  // namespace kolize::cli::stability
