// The result of one pair before it is written as contacts: regions in a frame that hangs on body A.
#pragma once

#include <kolize/math.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kolize {

// Origin: the centre of mass of A. Axes: whatever the maker says (world, or A's body frame).
struct ContactRegion {
    Vec3 normal = Vec3::Zero();  // unit, from A to B
    Vec3 center = Vec3::Zero();  // the one point to use when only one is wanted
    double depth = 0;            // m, > 0
    int count = 0;               // points in use, 1..4
    std::array<Vec3, 4> points;
    std::array<double, 4> depths{};  // m, per point

    static ContactRegion single(const Vec3& normal, const Vec3& point, double depth);
};

// The same region seen from the other body, whose centre stands at `b` in the region's frame.
ContactRegion swapped(const ContactRegion& region, const Vec3& b);

// Indices of up to four well-spread points: the one farthest from the mean, the one farthest from that, the one
// farthest from the line of the two, and the one farthest from the line on the other side. Ties go to the lower index.
std::span<const std::uint32_t> spread_points(std::span<const Vec3> points, std::array<std::uint32_t, 4>& chosen);

}  // namespace kolize
