#include "moving_boxes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bench {

namespace {

constexpr double step = 0x1p-16;  // m
constexpr double decades = 6, smallest = 1e-3, largest = 1e3;

std::int64_t steps(double metres) { return static_cast<std::int64_t>(metres / step); }

// The mean of (a + b)^3, in which the boxes of sides a and b overlap, over two sides of the power law.
double mean_reach_cubed() {
    const auto moment = [](int k) {
        return (std::pow(largest, k) - std::pow(smallest, k)) / (k * decades * std::log(10.0));
    };
    return 2 * moment(3) + 6 * moment(2) * moment(1);
}

}  // namespace

MovingBoxes::MovingBoxes(Workload workload, std::size_t count, Movers movers) : movers_(movers) {
    const double room = workload == Workload::power_law ? mean_reach_cubed() / 2 : 4;  // m^3 a box
    const std::int64_t cube = steps(std::cbrt(room * static_cast<double>(count)));
    std::uniform_int_distribution<std::int64_t> place(0, cube);
    std::uniform_real_distribution<double> decade(0, decades);
    for (std::size_t box = 0; box < count; ++box) {
        const std::int64_t x = place(random_), y = place(random_), z = place(random_);
        centers_.emplace_back(x, y, z);
        const double side = workload == Workload::power_law ? smallest * std::pow(10, decade(random_)) : 1;
        half_sides_.push_back(steps(side / 2));
    }
    if (workload == Workload::clustered) place_clustered(cube);
    moved_.resize(movers == Movers::all ? count : count / 10);
    for (std::size_t i = 0; i < moved_.size(); ++i)
        moved_[i] = static_cast<std::uint32_t>(movers == Movers::all ? i : 10 * i);
}

void MovingBoxes::place_clustered(std::int64_t cube) {
    constexpr std::size_t boxes_in_a_cluster = 1000;
    std::uniform_int_distribution<std::int64_t> place(0, cube);
    std::normal_distribution<double> offset(0, 3.5);
    Steps middle;
    for (std::size_t box = 0; box < centers_.size(); ++box) {
        if (box % boxes_in_a_cluster == 0)
            for (std::int64_t& coordinate : middle) coordinate = place(random_);
        for (int axis = 0; axis < 3; ++axis) centers_[box][axis] = middle[axis] + steps(offset(random_));
    }
    std::shuffle(centers_.begin(), centers_.end(), random_);  // as they lie in memory, boxes have no neighbours
}

void MovingBoxes::move(std::uint32_t box) {
    const std::int64_t stride = half_sides_[box] / 10;
    std::uniform_int_distribution<std::int64_t> by(-stride, stride);
    const std::int64_t x = by(random_), y = by(random_), z = by(random_);
    centers_[box] += Steps(x, y, z);
}

void MovingBoxes::choose_movers() {
    if (movers_ != Movers::random_tenth) return;
    std::vector<std::uint32_t> all(centers_.size());
    std::iota(all.begin(), all.end(), 0u);
    std::sample(all.begin(), all.end(), moved_.begin(), moved_.size(), random_);
}

std::vector<Frame> MovingBoxes::take(std::size_t frames) {
    std::vector<Frame> result(frames);
    for (Frame& frame : result) {
        choose_movers();
        for (const std::uint32_t box : moved_) move(box);
        frame.moved = moved_;
        for (std::size_t box = 0; box < centers_.size(); ++box) {
            const Steps half = Steps::Constant(half_sides_[box]);
            frame.boxes.push_back({step * (centers_[box] - half).cast<double>(),  //
                                   step * (centers_[box] + half).cast<double>()});
        }
    }
    return result;
}

}  // namespace bench
