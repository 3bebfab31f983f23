// Checks that need no right answer to compare with: what has to stay, or change in a known way, when the input is
// changed; and whether a plugin keeps what its capabilities claim.
#pragma once

#include "suite.h"

namespace kolize {

void check_metamorphic_broadphase(const PluginLibrary& library, const LoadedPlugin& plugin,
                                  const ConformanceOptions& options, Suite& suite);
void check_metamorphic_narrowphase(const PluginLibrary& library, const LoadedPlugin& plugin,
                                   const ConformanceOptions& options, Suite& suite);
void check_metamorphic_response(const PluginLibrary& library, const LoadedPlugin& plugin,
                                const ConformanceOptions& options, Suite& suite);

}  // namespace kolize
