// Frames of boxes as a NumPy array [frames, boxes, 6] of double, written as they come.
#pragma once

#include <kolize/math.h>

#include <filesystem>
#include <fstream>
#include <span>

namespace kolize::cli {

class NpyWriter {
public:
    NpyWriter(std::filesystem::path file, std::size_t boxes);
    void add(std::span<const Aabb> boxes);
    // Throws Error if anything could not be written.
    void finish();

private:
    void write_header();

    std::filesystem::path file_;
    std::ofstream stream_;
    std::size_t boxes_;
    std::uint64_t frames_ = 0;
};

}  // namespace kolize::cli
