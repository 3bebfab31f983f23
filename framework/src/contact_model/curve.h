// The curve of intersection of two closed meshes: its segments, the loops they form, and the regions these bound.
#pragma once

#include "contact_model/contact_model.h"

namespace kolize {

// Fills `segments` (in the order of their triangles) and `ends`. Every crossing is shared by two segments; where a
// triangle test near a tie has missed a pair, the loop is followed over the missing pair and closed.
void find_segments(const MeshPair& pair, std::span<const TriangleHit> hits, Nudge& nudge, ContourScratch& scratch);

// Names loops and regions: two loops bound the same part of the overlap if an edge runs inside from one to the other,
// or if they are connected over vertices that lie inside. Marks the pierced and repeated edges.
void join_segments(const MeshPair& pair, ContourScratch& scratch);

}  // namespace kolize
