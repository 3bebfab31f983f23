#include "triangle_workload.h"

#include "csv_row.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace kolize::cli {
namespace {

constexpr std::size_t coordinates = 18;
const std::string csv_header = "a0x,a0y,a0z,a1x,a1y,a1z,a2x,a2y,a2z,b0x,b0y,b0z,b1x,b1y,b1z,b2x,b2y,b2z";

// Throws std::invalid_argument.
void add_row(const std::string& line, bool with_hit, TriangleWorkload& workload) {
    std::array<double, coordinates + 1> numbers{};
    const std::size_t count = coordinates + with_hit;
    parse_row(line, with_hit ? csv_header + ",hit" : csv_header, std::span(numbers).first(count));
    if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        throw std::invalid_argument("a number is not finite");
    if (with_hit && numbers.back() != 0 && numbers.back() != 1) throw std::invalid_argument("hit must be 0 or 1");
    TrianglePair& pair = workload.pairs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pair.a[k][static_cast<int>(axis)] = numbers[3 * k + axis];
            pair.b[k][static_cast<int>(axis)] = numbers[9 + 3 * k + axis];
        }
    if (with_hit) workload.hit.push_back(numbers.back() == 1);
}

bool next_line(std::istream& stream, SourceLocation& where, std::string& line) {
    ++where.line;
    if (!std::getline(stream, line)) return false;
    if (line.ends_with('\r')) line.pop_back();
    return true;
}

}  // namespace

TriangleWorkload read_triangle_pairs(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!std::filesystem::is_regular_file(file) || !stream)
        throw Error("workload '" + file.string() + "' cannot be read");
    SourceLocation where{file.string(), 0, 0};
    std::string line;
    next_line(stream, where, line);
    const bool with_hit = line == csv_header + ",hit";
    if (!with_hit && line != csv_header)
        throw Error(where, "the first line must be " + csv_header + ", with or without ,hit at the end");
    TriangleWorkload workload;
    while (next_line(stream, where, line)) {
        if (line.empty()) continue;
        try {
            add_row(line, with_hit, workload);
        } catch (const std::invalid_argument& error) {
            throw Error(where, error.what());
        }
    }
    if (workload.pairs.empty()) throw Error(where, "there are no triangles");
    return workload;
}

}  // namespace kolize::cli
