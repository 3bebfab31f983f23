// Numbers in words of a text file.
#pragma once

#include <string_view>

namespace kolize::mesh_io {

// from_chars knows no plus sign.
std::string_view without_plus(std::string_view word);

enum class NumberFault { none, not_a_number, not_finite };

// The whole word as a number: +1, .5, 1. and -1e-3 are.
NumberFault parse_number(std::string_view word, double& value);

}  // namespace kolize::mesh_io
