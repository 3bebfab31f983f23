#include "massprops/slow_methods.h"

#include "common.h"
#include "massprops/embree_lines.h"

#include <mutex>

namespace kolize::cli {

namespace {

constexpr std::size_t winding_samples = 100000;

// A progress bar that several threads move on.
class SharedProgress {
public:
    explicit SharedProgress(const std::string& what) : what_(what) {}

    void operator()(std::size_t done, std::size_t of) {
        const std::lock_guard lock(mutex_);
        if (!progress_) progress_.emplace(what_, of);
        progress_->advance(done);
    }

private:
    std::string what_;
    std::mutex mutex_;
    std::optional<Progress> progress_;
};

}  // namespace

TimedVoxels run_voxels(const TriangleSoup& surface, const MassPropsOptions& options, double step) {
    VoxelOptions voxel = options.voxel;
    voxel.step = step;
    const MakeLineCaster caster = options.rays == "embree" ? embree_line_caster() : make_line_rasteriser;
    const std::unique_ptr<Host> host = make_host(options.threads);
    SharedProgress progress("rays");
    const auto start = std::chrono::steady_clock::now();
    VoxelMassProperties result = voxel_mass_properties(surface, voxel, caster, *host, std::ref(progress));
    return {std::move(result), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

MassEstimate run_estimate(const TriangleSoup& surface, const MassPropsOptions& options) {
    const std::unique_ptr<Host> host = make_host(options.threads);
    SharedProgress progress("winding numbers");
    return estimate_mass_properties(surface, winding_samples, *host, std::ref(progress));
}

}  // namespace kolize::cli
