#include <kolize/error.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace kolize {

std::string to_string(const SourceLocation& where) {
    std::string text = where.file;
    if (where.line > 0) text.append(":").append(std::to_string(where.line));
    if (where.line > 0 && where.column > 0) text.append(":").append(std::to_string(where.column));
    return text;
}

Error::Error(const SourceLocation& where, const std::string& message)
    : std::runtime_error(where.file.empty() ? message : to_string(where) + ": " + message) {}

// Levenshtein's distance (insert, delete, replace) by dynamic programming; Wagner and Fischer 1974. One row of the
// table is kept: row[j] is the distance of a's prefix so far to the first j characters of b.
int edit_distance(const std::string& a, const std::string& b) {
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (const char c : a) {
        int diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int replaced = diagonal + (c != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

}  // namespace kolize
