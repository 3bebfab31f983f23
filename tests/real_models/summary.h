// What is compared of a mesh, found in a process of its own.
#pragma once

#include "oracle_readers.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace kolize::real_models {

// Plain data: it comes through a pipe.
struct Summary {
    bool read = false;
    bool curved = false;
    bool bounds_volume = false;
    std::size_t triangles = 0;
    double minima[3] = {}, maxima[3] = {};  // of the triangles' corners, file units
    double area = 0;
    double volume = 0;       // 0 unless bounds_volume
    char surface[32] = {};   // in words: "closed", "3 open edges"
    char refusal[256] = {};  // why it was not read

    double size() const {
        double largest = 0;
        for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, maxima[axis] - minima[axis]);
        return largest;
    }
    double largest_coordinate() const {
        double largest = 0;
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max({largest, std::abs(minima[axis]), std::abs(maxima[axis])});
        return largest;
    }
};

using Reader = OracleMesh (*)(const std::string& file);

// A reader that throws, crashes, or takes more than two minutes comes back as not read, with the reason.
Summary summary_by(Reader reader, const std::string& file);

}  // namespace kolize::real_models
