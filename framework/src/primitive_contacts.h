// Closed-form contacts between spheres, boxes and half-spaces.
//
// Every function appends the regions (at most one) of an overlapping pair. Regions: world axes, origin at the centre of
// mass of A, the first shape. `b` is the centre of mass of B minus that of A, world axes.
#pragma once

#include "contact_region.h"

#include <kolize/shape.h>

namespace kolize {

using Regions = std::vector<ContactRegion>;

void sphere_sphere(double radius_a, double radius_b, const Vec3& b, Regions& regions);
void sphere_box(double radius, const Vec3& half_b, const Mat3& rotation_b, const Vec3& b, Regions& regions);
// normal_b: the half-space's outward normal, world axes.
void sphere_half_space(double radius, const Vec3& normal_b, const Vec3& b, Regions& regions);
void box_half_space(const Vec3& half, const Mat3& rotation_a, const Vec3& normal_b, const Vec3& b, Regions& regions);
// Separating axes (Gottschalk 1996), then the clipped incident face or the closest points of two edges (Gregorius, GDC
// 2013). A face axis is preferred to an edge axis that is not clearly better.
void box_box(const Vec3& half_a, const Mat3& rotation_a, const Vec3& half_b, const Mat3& rotation_b, const Vec3& b,
             Regions& regions);

}  // namespace kolize
