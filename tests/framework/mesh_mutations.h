// Faults that befall mesh files, and what must hold whatever a file is like.
#pragma once

#include <kolize/mesh.h>

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

namespace kolize::test {

// One to four bytes changed, and at times a piece lost or repeated.
inline std::string mutated(std::string bytes, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
    for (std::size_t changes = below(4) + 1; changes > 0; --changes) {
        char& byte = bytes[below(bytes.size())];
        const std::string likely = "0123456789 -.\n/e#\\";
        byte = below(2) ? static_cast<char>(below(256)) : likely[below(likely.size())];
    }
    if (below(4) == 0) bytes.resize(below(bytes.size()) + 1);
    if (below(8) == 0) bytes.insert(below(bytes.size()), bytes.substr(below(bytes.size()), 40));
    return bytes;
}

// What every reader promises of a soup.
inline void check_promises(const TriangleSoup& soup) {
    REQUIRE_FALSE(soup.triangles.empty());
    REQUIRE((soup.lines.empty() || soup.lines.size() == soup.triangles.size()));
    REQUIRE(std::all_of(soup.vertices.begin(), soup.vertices.end(), [](const Vec3& v) { return v.allFinite(); }));
    REQUIRE(std::all_of(soup.triangles.begin(), soup.triangles.end(), [&](const Triangle& t) {
        return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return v < soup.vertices.size(); });
    }));
}

}  // namespace kolize::test
