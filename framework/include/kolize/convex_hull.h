// The smallest convex solid around a set of points.
#pragma once

#include <kolize/mesh.h>

#include <span>

namespace kolize {

// Its surface as triangles, counter-clockwise seen from outside, over those of the points that it needs (in their order,
// as they stand). Incremental, decided by exact predicates: points that coincide, or lie on a line or in a plane with
// others, make no triangle without area and no dent. De Berg et al., Computational Geometry (2008), 11. Takes the
// product of points and faces in time.
// Throws std::invalid_argument unless all points are finite and four of them span a solid.
KOLIZE_API TriangleSoup convex_hull(std::span<const Vec3> points);

}  // namespace kolize
