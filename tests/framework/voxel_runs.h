// The voxel method as tests call it.
#pragma once

#include <kolize/simulation.h>
#include <kolize/voxel_mass_properties.h>

namespace kolize::test {

inline VoxelMassProperties voxels(const TriangleSoup& surface, const VoxelOptions& options, int threads = 1) {
    return voxel_mass_properties(surface, options, make_line_rasteriser, *make_host(threads));
}

inline std::uint64_t lines_of(const VoxelMassProperties& result) {
    std::uint64_t lines = 0;
    for (const VoxelPass& pass : result.passes) lines += pass.lines;
    return lines;
}

inline std::uint64_t odd_lines_of(const VoxelMassProperties& result) {
    std::uint64_t lines = 0;
    for (const VoxelPass& pass : result.passes) lines += pass.odd_lines;
    return lines;
}

}  // namespace kolize::test
