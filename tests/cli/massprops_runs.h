// kolize massprops as its tests run it: models as OBJ text, results as JSON.
#pragma once

#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace kolize::test {

inline std::string as_obj(const TriangleSoup& soup) {
    std::ostringstream out;
    for (const Vec3& v : soup.vertices) out << "v " << words(v) << '\n';
    for (const Triangle& t : soup.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    return out.str();
}

// (0, 0, 0), (1, 0, 0), (0, 2, 0) and (0, 0, 3): volume 1, centre of mass a quarter of the sides (a, b, c), inertia
// over mass 3 (b^2 + c^2) / 80 and so on, and a b / 80 and so on off the diagonal.
inline const Vec3 corner_sides(1, 2, 3);

inline TriangleSoup corner_solid() {
    TriangleSoup soup;
    soup.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 3)};
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return soup;
}

inline Mat3 corner_tensor() {
    const Vec3& s = corner_sides;
    return (3 * s.squaredNorm() * Mat3::Identity() - 4 * Mat3(s.cwiseAbs2().asDiagonal()) + s * s.transpose()) / 80;
}

inline std::size_t times(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

// The JSON of a run that goes well.
inline nlohmann::json measured(const Shell& shell, const std::string& arguments) {
    const Outcome outcome = shell.kolize("massprops " + arguments + " --json -");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return nlohmann::json::parse(outcome.out);
}

// All numbers in nested arrays, row by row.
inline std::vector<double> flat(const nlohmann::json& value) {
    if (!value.is_array()) return {value.get<double>()};
    std::vector<double> numbers;
    for (const nlohmann::json& part : value)
        for (const double number : flat(part)) numbers.push_back(number);
    return numbers;
}

inline Vec3 vector_of(const nlohmann::json& value) { return Vec3(flat(value).data()); }

inline Mat3 tensor_of(const nlohmann::json& rows) { return Mat3(flat(rows).data()).transpose(); }

}  // namespace kolize::test
