// What one chunk of pairs works with when it is swept.
#pragma once

#include "sweep/touching.h"

#include <kolize/mesh_narrowphase.h>

namespace kolize {

struct MeshNarrowphase::SweepWorkspace {
    SweepWorkspace() {
        scratch.reserve();
        points.reserve(256);
    }
    ImpactScratch scratch;
    std::vector<TouchingPoint> points;
};

}  // namespace kolize
