// The recorded input of a broadphase: the same boxes in one frame after another.
#pragma once

#include <kolize/error.h>
#include <kolize/math.h>

#include <filesystem>
#include <vector>

namespace kolize::cli {

using BoxFrames = std::vector<std::vector<Aabb>>;  // every frame has the same number of boxes

// A CSV file with the header frame,min_x,min_y,min_z,max_x,max_y,max_z and a row per box, frame after frame; or, by the
// ending .npy, a NumPy array [frames, boxes, 6] of float or double in C order. Throws Error that says where (line of
// the CSV file; frame and box of the array): unreadable, malformed, not finite, min > max, frames of different length.
BoxFrames read_box_frames(const std::filesystem::path& file);

}  // namespace kolize::cli
