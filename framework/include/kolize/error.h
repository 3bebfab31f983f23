// What the user did wrong, in one sentence: what, where, and what would be right.
#pragma once

#include <kolize/export.h>

#include <stdexcept>
#include <string>

namespace kolize {

// A place in a text file. Line and column count from 1; 0 means unknown and is not printed.
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

// "file:line:column" as far as known.
KOLIZE_API std::string to_string(const SourceLocation& where);

// Bad input: the program prints what() and exits with code 2.
class KOLIZE_API Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
    Error(const SourceLocation& where, const std::string& message);
};

// The candidate nearest to `word` by edit distance, or "" if none is near enough to be a likely slip.
template <class Names>
std::string nearest_name(const std::string& word, const Names& candidates);

KOLIZE_API int edit_distance(const std::string& a, const std::string& b);

template <class Names>
std::string nearest_name(const std::string& word, const Names& candidates) {
    std::string best;
    int best_distance = 1 + static_cast<int>(word.size()) / 4;
    for (const std::string& candidate : candidates)
        if (const int d = edit_distance(word, candidate); d <= best_distance && d < 4) {
            best = candidate;
            best_distance = d - 1;
        }
    return best;
}

}  // namespace kolize
