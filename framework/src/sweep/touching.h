// Contacts of two bodies that touch without overlapping: what the response is given at a time of impact.
#pragma once

#include "sweep/impact_search.h"

namespace kolize {

struct TouchingPoint {
    Vec3 point = Vec3::Zero();   // frame of A (see MovingPair), between the surfaces
    Vec3 normal = Vec3::Zero();  // unit, from A to B
    double gap = 0;              // m, between the surfaces along the normal, at most; 0: they touch
};

// Appends every point at which the surfaces come nearer than `reach` or four times the pair's touch distance, which is
// when they touch: a corner over a face, two edges that cross, the corners of an area that two faces or edges share.
void find_touching_points(const MovingPair& pair, const PairMoment& moment, double reach, ImpactScratch& scratch,
                          std::vector<TouchingPoint>& points);

}  // namespace kolize
