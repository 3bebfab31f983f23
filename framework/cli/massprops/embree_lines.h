// Grid lines cast by Embree: the library that the rasteriser is compared with.
#pragma once

#include <kolize/voxel_mass_properties.h>

namespace kolize {

// Packets of 16 rays, in single precision about the middle of the surface; one traversal a ray finds all of its hits.
// Rays through edges or vertices may hit both triangles or none: such lines come out odd, or count something twice
// without a sign of it. Throws Error if Embree refuses the surface.
MakeLineCaster embree_line_caster();

}  // namespace kolize
