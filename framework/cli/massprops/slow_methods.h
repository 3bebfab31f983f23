// The methods that take a while, as the command runs them: caster by name, all threads, with a progress bar.
#pragma once

#include "massprops/options.h"

#include <kolize/winding_number.h>

namespace kolize::cli {

struct TimedVoxels {
    VoxelMassProperties result;
    double seconds = 0;
};

TimedVoxels run_voxels(const TriangleSoup& surface, const MassPropsOptions& options, double step);

MassEstimate run_estimate(const TriangleSoup& surface, const MassPropsOptions& options);

}  // namespace kolize::cli
