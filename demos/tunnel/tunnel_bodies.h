// The bodies that a tunnel's file names.
#pragma once

#include "tunnel_scene.h"

namespace kolize::tunnel {

enum MaterialId : std::uint32_t { hull, loose };  // of the tunnel and the fighter; of what moves in it

// Adds the statics and dynamics of all cells to the scene's world. Throws Error for files that are missing or not
// closed, and for bodies that reach out of their cells.
void add_bodies(TunnelScene& tunnel);

}  // namespace kolize::tunnel
