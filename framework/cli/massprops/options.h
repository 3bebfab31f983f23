// What kolize massprops is asked for.
#pragma once

#include <kolize/voxel_mass_properties.h>

#include <optional>
#include <string>
#include <vector>

namespace kolize::cli {

struct MassPropsOptions {
    std::string model;
    double scale = 1;  // from the file's unit of length to the one of the results

    std::string method;  // exact or voxel; empty: voxel if there is a step, else exact
    std::optional<double> step;
    VoxelOptions voxel;
    std::string rays = "rasteriser";  // or embree
    std::vector<double> study;
    std::string plot;

    std::string output;
    std::string format = "text";  // or urdf, mjcf, sdf
    std::optional<double> mass, density;
    int threads = 1;
    std::string json;

    bool wants_voxels() const { return method.empty() ? step.has_value() : method == "voxel"; }
};

}  // namespace kolize::cli
