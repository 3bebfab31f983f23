#include "mesh_io/number.h"

#include <charconv>
#include <cmath>

namespace kolize::mesh_io {

std::string_view without_plus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

NumberFault parse_number(std::string_view word, double& value) {
    const std::string_view digits = without_plus(word);
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), value);
    if (end != digits.end() || error == std::errc::invalid_argument) return NumberFault::not_a_number;
    return error == std::errc() && std::isfinite(value) ? NumberFault::none : NumberFault::not_finite;
}

}  // namespace kolize::mesh_io
