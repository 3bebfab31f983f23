// Two axes at once: what holds where, a cell for a decade or so of both.
#pragma once

#include "stability/study.h"

namespace kolize::cli::stability {

struct Map {
    const Study* study;
    const Subject* subject;
    std::size_t across_index, up_index;  // axes of the study
    std::vector<double> columns, rows;   // decades, from easy to hard
    std::vector<Outcome> cells;          // row after row

    const Axis& across() const { return study->axes[across_index]; }
    const Axis& up() const { return study->axes[up_index]; }
    const Outcome& at(std::size_t row, std::size_t column) const { return cells[row * columns.size() + column]; }
};

// The axis's index; none if the study has no such axis.
std::optional<std::size_t> axis_index(const Study& study, const std::string& name);

Map make_map(const Study& study, const Subject& subject, std::size_t across, std::size_t up);

// A letter a cell, the easy ends at the lower left.
std::string text(const Map& map);

// How many rows hold in each column before the first that fails: the contour of first failure.
std::vector<std::size_t> contour(const Map& map);

}  // namespace kolize::cli::stability
