// The frames along the spine of an Extrusion.
#pragma once

#include <kolize/math.h>

#include <vector>

namespace kolize::mesh_io::vrml {

// For each point of the spine the axes x, y and z (columns) of the plane that carries the cross-section there: y runs
// along the spine, z is normal to the bend (6.18). Bends below a microradian are taken as straight. A straight spine
// turns all frames as it turns the y axis; a spine of one place does not turn them.
std::vector<Mat3> spine_frames(const std::vector<Vec3>& spine);

}  // namespace kolize::mesh_io::vrml
