// Where a surface passes through itself.
#pragma once

#include <kolize/mesh.h>

namespace kolize {

struct SelfIntersections {
    std::size_t pairs = 0;                         // of triangles without a common vertex that cross
    std::uint32_t triangle_a = 0, triangle_b = 0;  // the first such pair (by its lower, then its higher id)
    Vec3 point = Vec3::Zero();                     // where these two cross
};

// Counts crossings that are certain: an edge of one triangle has its ends on different sides of the other one and goes
// through its interior by more than rounding. Triangles that only touch, or lie in one plane, do not count.
KOLIZE_API SelfIntersections find_self_intersections(const TriangleSoup& surface);

}  // namespace kolize
