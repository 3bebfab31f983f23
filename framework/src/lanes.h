// Four floats at a time, in the vector extension of GCC and Clang: SSE on any x86-64, and the same bits everywhere.
#pragma once

#include <cstring>

namespace kolize {

using Lanes = float __attribute__((vector_size(16)));
using LaneMask = int __attribute__((vector_size(16)));

inline Lanes load_lanes(const void* four_floats) {
    Lanes lanes;
    std::memcpy(&lanes, four_floats, sizeof lanes);
    return lanes;
}

inline Lanes all_lanes(float x) { return Lanes{x, x, x, x}; }

// Where one of the two is not a number: the second one.
inline Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes min(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes abs(Lanes a) { return max(a, -a); }

// Bit i: lane i is not certainly positive. A lane that is not a number is not.
inline unsigned not_positive(Lanes a) {
    const LaneMask bits = ~(a > 0) & LaneMask{1, 2, 4, 8};
    return static_cast<unsigned>(bits[0] | bits[1] | bits[2] | bits[3]);
}

}  // namespace kolize
