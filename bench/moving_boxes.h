// The standard workload for a broadphase: unit boxes that move a little from frame to frame.
#pragma once

#include <kolize/math.h>

#include <cstdint>
#include <random>
#include <vector>

namespace bench {

using Frame = std::vector<kolize::Aabb>;

// Boxes of side 1 m in a cube of side (4 count)^(1/3) m, so that a box overlaps two others on average. From each frame
// to the next each box moves by up to 5 % of its side in every axis, and never goes back on purpose: a library that
// keeps boxes with a margin must not find them where they were. All coordinates are multiples of 2^-16 m: they are the
// same numbers in float and in double, and as centre and half size, so that every library is asked the same question.
class MovingBoxes {
public:
    MovingBoxes(std::size_t count, std::uint64_t seed);

    // The next frames of the motion.
    std::vector<Frame> take(std::size_t frames);

private:
    using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

    std::mt19937_64 random_;
    std::vector<Cell> centers_;  // in steps of 2^-16 m
};

}  // namespace bench
