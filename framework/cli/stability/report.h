// What kolize stability found, as text, CSV, JSON and HTML.
#pragma once

#include "stability/map.h"
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
    std::vector<Row> rows;  // by study, then subject, then axis
    std::vector<Map> maps;  // by study, then subject
};

// "2e+07 missed": the last magnitude that holds and what happens then; "all": to the end; "none wrong": nowhere.
std::string cell(const Envelope& envelope);
// The silent failures, the lower magnitudes that fail and what the plugin did, a sentence a row; "" if it holds.
std::string note(const Row& row);

std::string text_report(const Survey& survey);
std::string csv_report(const Survey& survey);
Json to_json(const Survey& survey);
// A page that needs no other file and no network.
std::string html_report(const Survey& survey);

}  // namespace kolize::cli::stability
