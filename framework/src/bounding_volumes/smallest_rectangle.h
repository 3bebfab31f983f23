// The rectangle of least area about points in the plane.
#pragma once

#include <kolize/math.h>

#include <vector>

namespace kolize {

using Vec2 = Eigen::Vector2d;

// Extents of local points (local_points.h) below this are rounding. They count as this much, so that flat sets are
// compared by their area and straight ones by their length.
inline constexpr double least_extent = 16 * std::numeric_limits<double>::epsilon();

// Unit vector along one side. One side is flush with an edge of the convex hull (Freeman & Shapira 1975), so the edges
// are tried in turn while calipers run round the hull (Toussaint 1983). Sorts the points and leaves their hull.
Vec2 smallest_rectangle_side(std::vector<Vec2>& points);

}  // namespace kolize
