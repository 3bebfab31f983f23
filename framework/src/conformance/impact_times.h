// The part of the narrowphase suite about bodies in motion.
#pragma once

#include "conformance/suite.h"

#include <kolize/plugin_library.h>

namespace kolize {

// Adds the checks of Narrowphase::find_impacts and find_touching to the suite.
void check_impact_times(const PluginLibrary& library, const LoadedPlugin& plugin, const ConformanceOptions& options,
                        Suite& suite);

}  // namespace kolize
