// What kolize massprops found out, and how it is shown.
#pragma once

#include "common.h"
#include "massprops/model.h"
#include "massprops/options.h"

#include <kolize/winding_number.h>

namespace kolize::cli {

struct MassPropsResult {
    const MassPropsOptions& options;
    const Model& model;
    std::string method;  // of `mass`: exact, voxel or winding number
    MassProperties mass;
    PrincipalFrame principal;
    BoundingVolumes bounds;
    std::optional<MassProperties> exact;       // of a surface that bounds a volume
    std::optional<MassEstimate> estimate;      // of one that does not
    std::optional<VoxelMassProperties> voxel;  // if asked for, or if there is nothing exact
    double voxel_seconds = 0;

    // Half-width of the range in which the volume found by voxels may be: passes differ (each by the share of its lines
    // that pair up), and the lines that are left out may hold something.
    double voxel_volume_uncertainty() const;
    std::uint64_t rays() const;
    std::uint64_t odd_rays() const;
};

void print_text(const MassPropsResult& result, std::ostream& out);
Json to_json(const MassPropsResult& result);

// The body's inertial element in the convention of a simulator's format (urdf, mjcf or sdf): in the model's frame,
// about the centre of mass, SI units if the model is in metres. mass in kg.
std::string inertial_element(const std::string& format, const MassProperties& body, double mass);

// The model about its centre of mass. What was computed goes into `info`, in numbers that read back to the same bits.
TriangleSoup recentred(const MassPropsResult& result);

}  // namespace kolize::cli
