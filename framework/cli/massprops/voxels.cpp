#include "massprops/voxels.h"

#include "common.h"
#include "massprops/embree_lines.h"

#include <mutex>

namespace kolize::cli {

TimedVoxels run_voxels(const TriangleSoup& surface, const MassPropsOptions& options, double step) {
    VoxelOptions voxel = options.voxel;
    voxel.step = step;
    const MakeLineCaster caster = options.rays == "embree" ? embree_line_caster() : make_line_rasteriser;
    const std::unique_ptr<Host> host = make_host(options.threads);
    std::mutex mutex;
    std::optional<Progress> progress;
    const auto advance = [&](std::size_t bands, std::size_t of) {
        const std::lock_guard lock(mutex);
        if (!progress) progress.emplace("rays", of);
        progress->advance(bands);
    };
    const auto start = std::chrono::steady_clock::now();
    VoxelMassProperties result = voxel_mass_properties(surface, voxel, caster, *host, advance);
    return {std::move(result), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

}  // namespace kolize::cli
