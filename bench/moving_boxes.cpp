#include "moving_boxes.h"

#include <cmath>

namespace bench {

namespace {

constexpr double step = 0x1p-16;  // m

}  // namespace

MovingBoxes::MovingBoxes(std::size_t count, std::uint64_t seed) : random_(seed) {
    const auto side = static_cast<std::int64_t>(std::cbrt(4.0 * static_cast<double>(count)) / step);
    std::uniform_int_distribution<std::int64_t> place(0, side);
    for (std::size_t box = 0; box < count; ++box) {
        const std::int64_t x = place(random_), y = place(random_), z = place(random_);
        centers_.emplace_back(x, y, z);
    }
}

std::vector<Frame> MovingBoxes::take(std::size_t frames) {
    const auto stride = static_cast<std::int64_t>(0.05 / step);
    std::uniform_int_distribution<std::int64_t> move(-stride, stride);
    const kolize::Vec3 half = kolize::Vec3::Constant(0.5);
    std::vector<Frame> result(frames);
    for (Frame& frame : result)
        for (Cell& center : centers_) {
            const std::int64_t x = move(random_), y = move(random_), z = move(random_);
            center += Cell(x, y, z);
            frame.push_back({step * center.cast<double>() - half, step * center.cast<double>() + half});
        }
    return result;
}

}  // namespace bench
