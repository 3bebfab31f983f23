// What kolize stability found, as text, CSV and JSON.
#pragma once

#include "stability/search.h"

namespace kolize::cli::stability {

struct Row {
    const Study* study;
    const Subject* subject;
    std::size_t axis_index;
    Envelope envelope;

    const Axis& axis() const { return study->axes[axis_index]; }
};

struct Survey {
    std::uint64_t seed = 1;
    std::vector<Study> studies;
    std::vector<Row> rows;                   // by study, then subject, then axis
    std::vector<std::string> left_out = {};  // who was not asked what, and why, in sentences
};

// "2e+07", a magnitude in the axis's unit.
std::string magnitude(double decades);
// "2e+07 missed": the last magnitude that holds and what happens then; "all": to the end; "none wrong": nowhere.
std::string cell(const Envelope& envelope);
// The silent failures, the lower magnitudes that fail and what the plugin did, a sentence a row; "" if it holds.
std::string note(const Row& row);

std::string text_report(const Survey& survey);
std::string csv_report(const Survey& survey);
Json to_json(const Survey& survey);

}  // namespace kolize::cli::stability
