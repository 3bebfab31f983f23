// Exact geometric predicates: the sign that real arithmetic would give for the coordinates as they stand.
//
// A floating-point filter answers nearly always; what it cannot decide is computed exactly. Any finite input, of any
// magnitude. The framework's own decisions about touching, coplanar and degenerate triangles rest on these.
#pragma once

#include <kolize/export.h>
#include <kolize/math.h>

namespace kolize {

// +1 if d lies on the side of the plane through a, b, c that ((b - a) x (c - a)) points to, -1 on the other, 0 on it
// (or if a, b, c lie on one line). Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
// predicates", DCG 18, 1997.
KOLIZE_API int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// Whether two closed triangles have a point in common: touching and coplanar ones too, and triangles without area.
// Devillers & Guigue, "Faster triangle-triangle intersection tests", INRIA RR-4488, 2002, over exact predicates.
KOLIZE_API bool triangles_intersect(const Vec3 (&a)[3], const Vec3 (&b)[3]);

// What two triangles that intersect have in common: the ends of a segment, each coordinate within a few roundings of
// the exact one. Of triangles in one plane, and where one has no area, a single point as both ends.
struct CommonSegment {
    Vec3 begin;
    Vec3 end;
};
KOLIZE_API CommonSegment common_segment(const Vec3 (&a)[3], const Vec3 (&b)[3]);

}  // namespace kolize
