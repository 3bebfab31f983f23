// Volumes that enclose a set of points, from the cheapest to the tightest: what a body costs in false alarms when it is
// tested by its bounds. Every one contains all points to within a few ulp of their extent.
#pragma once

#include <kolize/export.h>
#include <kolize/math.h>

#include <span>
#include <vector>

namespace kolize {

struct BoundingSphere {
    Vec3 center = Vec3::Zero();  // in the frame of the points, as everywhere below
    double radius = 0;

    KOLIZE_API double volume() const;
};

struct OrientedBox {
    Vec3 center = Vec3::Zero();
    Mat3 axes = Mat3::Identity();  // columns: unit axes, right-handed
    Vec3 half_extents = Vec3::Zero();

    double volume() const { return 8 * half_extents.prod(); }
};

// The points between pairs of parallel planes: minima[i] <= directions[i] . p <= maxima[i].
struct SlabPolytope {
    std::vector<Vec3> directions;  // x, y, z first; coordinates -1, 0, 1: not unit, but exact for integers
    std::vector<double> minima, maxima;

    KOLIZE_API double volume() const;
};

// Each of the following throws an Error unless there is a point, and all are finite (to 1e100: no volume overflows).
KOLIZE_API Aabb bounding_box(std::span<const Vec3> points);
// The smallest sphere about a given centre.
KOLIZE_API BoundingSphere sphere_about(const Vec3& center, std::span<const Vec3> points);
// The smallest sphere of all.
KOLIZE_API BoundingSphere smallest_enclosing_sphere(std::span<const Vec3> points);
// A box of small volume: never larger than the box along the axes or the box along the principal components.
KOLIZE_API OrientedBox oriented_box(std::span<const Vec3> points);
// planes: 6 (the box along the axes), 18 (and the edge directions) or 26 (and the corner directions).
KOLIZE_API SlabPolytope slab_polytope(std::span<const Vec3> points, int planes);

}  // namespace kolize
