#include "csv_row.h"

#include <charconv>
#include <stdexcept>
#include <string>

namespace kolize::cli {

void parse_row(std::string_view line, std::string_view columns, std::span<double> numbers) {
    const char* at = line.data();
    const char* const end = line.data() + line.size();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        while (at < end && *at == ' ') ++at;
        const auto [after, error] = std::from_chars(at, end, numbers[i]);
        if (error != std::errc()) throw std::invalid_argument("column " + std::to_string(i + 1) + " is not a number");
        at = after;
        while (at < end && *at == ' ') ++at;
        const bool last = i + 1 == numbers.size();
        if (last ? at != end : at == end || *at++ != ',')
            throw std::invalid_argument(std::to_string(numbers.size()) +
                                        " numbers are wanted: " + std::string(columns));
    }
}

}  // namespace kolize::cli
