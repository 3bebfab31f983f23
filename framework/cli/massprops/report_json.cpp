#include "massprops/result.h"

#include <nlohmann/json.hpp>

namespace kolize::cli {
namespace {

Json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json rows_of(const Mat3& m) { return {to_json(Vec3(m.row(0))), to_json(Vec3(m.row(1))), to_json(Vec3(m.row(2)))}; }

Json to_json(const MassProperties& mass) {
    return {{"volume", mass.volume},
            {"center_of_mass", to_json(mass.center_of_mass)},
            {"inertia_over_mass", rows_of(mass.inertia_over_mass)}};
}

Json sphere_json(const BoundingSphere& sphere, double volume) {
    return {{"center", to_json(sphere.center)},
            {"radius", sphere.radius},
            {"volume", sphere.volume()},
            {"fill", volume / sphere.volume()}};
}

Json slabs_json(const SlabPolytope& slabs, double volume) {
    Json directions = Json::array();
    for (const Vec3& direction : slabs.directions) directions.push_back(to_json(direction));
    return {{"directions", directions},
            {"min", slabs.minima},
            {"max", slabs.maxima},
            {"volume", slabs.volume()},
            {"fill", volume / slabs.volume()}};
}

void add_bounds(const BoundingVolumes& bounds, double volume, Json& json) {
    const double box_volume = (bounds.box.max - bounds.box.min).prod();
    const OrientedBox& oriented = bounds.oriented;
    json["bounding_sphere"] = sphere_json(bounds.about_center, volume);
    json["enclosing_sphere"] = sphere_json(bounds.smallest, volume);
    json["aabb"] = {{"min", to_json(bounds.box.min)},
                    {"max", to_json(bounds.box.max)},
                    {"volume", box_volume},
                    {"fill", volume / box_volume}};
    json["obb"] = {{"center", to_json(oriented.center)},
                   {"axes", rows_of(oriented.axes.transpose())},  // an axis a row
                   {"half_extents", to_json(oriented.half_extents)},
                   {"volume", oriented.volume()},
                   {"fill", volume / oriented.volume()}};
    json["kdop18"] = slabs_json(bounds.slabs_18, volume);
    json["kdop26"] = slabs_json(bounds.slabs_26, volume);
}

void add_voxels(const MassPropsResult& result, Json& json) {
    const VoxelMassProperties& voxel = *result.voxel;
    json["step"] = voxel.grid.spacing.maxCoeff();
    json["divisions"] = voxel.grid.cells.maxCoeff();
    json["axes"] = voxel.passes.size();
    json["rays"] = result.rays();
    json["odd_rays"] = result.odd_rays();
    json["time_s"] = result.voxel_seconds;
    Json passes = Json::array();
    for (const VoxelPass& pass : voxel.passes) {
        Json entry = to_json(pass.mass);
        entry["axis"] = std::string(1, "xyz"[pass.axis]);
        entry["rays"] = pass.lines;
        entry["odd_rays"] = pass.odd_lines;
        entry["covered_twice"] = pass.covered_twice;
        entry["inside_out"] = pass.inside_out;
        passes.push_back(std::move(entry));
    }
    Json odd = Json::array();
    for (const OddLine& line : voxel.odd_lines)
        odd.push_back({{"axis", std::string(1, "xyz"[line.axis])},
                       {"first_crossing", to_json(line.point)},
                       {"crossings", line.crossings}});
    Json& block = json["voxel"] = to_json(voxel.mass);
    block["volume_uncertainty"] = result.voxel_volume_uncertainty();
    block["spacing"] = to_json(voxel.grid.spacing);
    block["cells"] = {voxel.grid.cells[0], voxel.grid.cells[1], voxel.grid.cells[2]};
    block["ray_caster"] = result.options.rays;
    block["passes"] = std::move(passes);
    block["first_odd_rays"] = std::move(odd);
}

void add_estimate(const MassEstimate& estimate, Json& json) {
    json["winding_number"] = to_json(estimate.mass);
    json["winding_number"]["samples"] = estimate.samples;
    json["winding_number"]["uncertainty"] = {{"volume", estimate.volume},
                                             {"center_of_mass", to_json(estimate.center_of_mass)},
                                             {"inertia_over_mass", rows_of(estimate.inertia_over_mass)}};
}

}  // namespace

Json to_json(const MassPropsResult& result) {
    const Model& model = result.model;
    const Quat& axes = result.principal.axes;
    Json json{{"model", result.options.model},
              {"method", result.method},
              {"vertices", model.surface.vertices.size()},
              {"triangles", model.surface.triangles.size()},
              {"closed", model.bounds_volume()},
              {"area", model.area}};
    json.update(to_json(result.mass));
    json["principal_moments"] = to_json(result.principal.moments);
    json["principal_axes"] = rows_of(axes.toRotationMatrix().transpose());  // an axis a row
    json["principal_orientation"] = {axes.w(), axes.x(), axes.y(), axes.z()};
    add_bounds(result.bounds, result.mass.volume, json);
    if (result.exact) json["exact"] = to_json(*result.exact);
    if (result.estimate) add_estimate(*result.estimate, json);
    if (result.voxel) add_voxels(result, json);
    if (model.parts) json["parts"] = model.parts;
    json["self_intersections"] = model.crossings.pairs;
    json["remarks"] = model.remarks;
    json["info"] = model.surface.info;
    json["scale"] = result.options.scale;
    json["threads"] = result.options.threads;
    json["host"] = host_block();
    json["command"] = command_line();
    return json;
}

}  // namespace kolize::cli
