// Points as the searches for tight volumes want them: near the origin and of size one.
#pragma once

#include <kolize/math.h>

#include <span>
#include <vector>

namespace kolize {

// Throws an Error unless there is a point, and no coordinate so large (or not a number) that a volume overflows.
void require_points(std::span<const Vec3> points);

// p = origin + unit * points[i]. The unit is a power of two that brings the largest coordinate to between a half and
// one (1 if all points are equal): the map costs at most one rounding, and no product of coordinates overflows.
struct LocalPoints {
    Vec3 origin = Vec3::Zero();  // middle of the box along the axes
    double unit = 1;
    std::vector<Vec3> points;
};

LocalPoints local_points(std::span<const Vec3> points);

}  // namespace kolize
