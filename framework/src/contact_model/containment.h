// One solid wholly inside another: their surfaces do not cross, yet they overlap.
#pragma once

#include "contact_region.h"
#include "mesh_contacts.h"

#include <kolize/mesh_narrowphase.h>

#include <optional>

namespace kolize {

// Needs two closed meshes whose surfaces do not cross. The region, in the body frame of mesh A, leads the inner solid
// out by the point of the outer surface that is nearest to the inner one's centre: the normal is the surface's there,
// or points there where the surface has an edge or corner; the depth is how far the inner solid has to move to have all
// of it outside that point. Of a mesh in several pieces the first vertex speaks for all.
std::optional<ContactRegion> contained_region(const MeshPair& pair, MeshScratch& scratch);

}  // namespace kolize
