// One row of a CSV workload.
#pragma once

#include <span>
#include <string_view>

namespace kolize::cli {

// Reads as many numbers, separated by commas, as there is room for: no fewer, no more. `columns` is the header line.
// Throws std::invalid_argument that says what is wrong.
void parse_row(std::string_view line, std::string_view columns, std::span<double> numbers);

}  // namespace kolize::cli
