// The voxel method as the command runs it: caster by name, all threads, with a progress bar.
#pragma once

#include "massprops/options.h"

namespace kolize::cli {

struct TimedVoxels {
    VoxelMassProperties result;
    double seconds = 0;
};

TimedVoxels run_voxels(const TriangleSoup& surface, const MassPropsOptions& options, double step);

}  // namespace kolize::cli
