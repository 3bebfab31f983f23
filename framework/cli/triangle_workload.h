// The recorded input of a triangle-triangle test: pairs of triangles, and whether they intersect.
#pragma once

#include <kolize/mesh_narrowphase.h>

#include <filesystem>
#include <vector>

namespace kolize::cli {

struct TriangleWorkload {
    std::vector<TrianglePair> pairs;
    std::vector<std::uint8_t> hit;  // per pair, the true answer; empty if the file does not tell
};

// A CSV file with the header a0x,a0y,a0z,a1x,...,b2z (m), a row per pair, and an optional last column `hit` of 0 and 1.
// Throws Error with the line: unreadable, malformed, not finite, no pairs.
TriangleWorkload read_triangle_pairs(const std::filesystem::path& file);

}  // namespace kolize::cli
