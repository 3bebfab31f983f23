// The search for the axes of a box of small volume.
#pragma once

#include <kolize/bounding_volumes.h>

#include <span>
#include <vector>

namespace kolize {

// All points here are local (local_points.h).
struct BoxAxes {
    Mat3 axes = Mat3::Identity();  // columns: unit axes, right-handed
    double volume = infinity;      // with extents of least_extent at least (smallest_rectangle.h)

    // By more than rounding, so that of equal boxes the first one stays.
    bool smaller_than(const BoxAxes& other) const { return volume < (1 - 1e-14) * other.volume; }
};

// The box with these axes.
BoxAxes measured(const Mat3& axes, std::span<const Vec3> points);

// Holds one axis of the box after the other and turns the box about it to the smallest rectangle, until the volume no
// longer falls (Chang, Gorissen & Melchior, "Fast oriented bounding box optimization on the rotation group SO(3,R)",
// ACM Trans. Graphics 30(5), 2011).
BoxAxes turned_about_axes(const BoxAxes& box, std::span<const Vec3> points);

// The points that are farthest in one of many directions, or all points where they are few.
std::vector<Vec3> outermost(std::span<const Vec3> points);

// Smallest of the boxes that the search comes to from many directions, and from the given boxes. It looks at all points
// a few thousand times.
BoxAxes search_box(std::span<const Mat3> starts, std::span<const Vec3> points);

// The box along the principal components: found at once, up to a few times as large as the smallest.
OrientedBox principal_box(std::span<const Vec3> points);

}  // namespace kolize
