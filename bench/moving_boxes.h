// The standard workloads for a broadphase: boxes that move a little from frame to frame.
#pragma once

#include <kolize/math.h>

#include <cstdint>
#include <random>
#include <vector>

namespace bench {

struct Frame {
    std::vector<kolize::Aabb> boxes;
    std::vector<std::uint32_t> moved;  // those whose box is not that of the frame before
};

enum class Workload {
    uniform,    // side 1 m in a cube of side (4 count)^(1/3) m: a box overlaps two others on average
    clustered,  // the same cube, but Gaussian clusters of 1000 boxes, 3.5 m wide: about six overlaps a box
    power_law   // sides from 1 mm to 1 km, as many in each decade: about two overlaps a box
};

enum class Movers { all, same_tenth, random_tenth };

// From each frame to the next each box that moves does so by up to 5 % of its side in every axis, and never goes back
// on purpose: a library that keeps boxes with a margin must not find them where they were. All coordinates are
// multiples of 2^-16 m: they are the same numbers as centre and half size, and in all workloads but power_law the same
// in float, so that every library is asked the same question.
class MovingBoxes {
public:
    MovingBoxes(Workload workload, std::size_t count, Movers movers);

    // The next frames of the motion.
    std::vector<Frame> take(std::size_t frames);

private:
    using Steps = Eigen::Matrix<std::int64_t, 3, 1>;  // of 2^-16 m

    void place_clustered(std::int64_t cube);
    void move(std::uint32_t box);
    void choose_movers();

    std::mt19937_64 random_{1};
    Movers movers_;
    std::vector<std::uint32_t> moved_;
    std::vector<std::int64_t> half_sides_;
    std::vector<Steps> centers_;
};

}  // namespace bench
