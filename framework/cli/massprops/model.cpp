#include "massprops/model.h"

#include "massprops/parts.h"

#include "common.h"

#include <kolize/mesh_io.h>
#include <kolize/voxel_mass_properties.h>

namespace kolize::cli {
namespace {

std::string count_of(std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// Corners of triangles, each vertex once: others take up no space.
std::vector<Vec3> used_vertices(const TriangleSoup& surface) {
    std::vector<bool> used(surface.vertices.size(), false);
    for (const Triangle& triangle : surface.triangles)
        for (const std::uint32_t v : triangle) used[v] = true;
    std::vector<Vec3> points;
    for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v]) points.push_back(surface.vertices[v]);
    return points;
}

void close_by_joining(Model& model) {
    TriangleSoup joined = join_equal_vertices(model.surface);
    const MeshDefects defects = inspect(joined);
    if (!defects.bounds_volume()) return;
    const std::size_t gone = used_vertices(model.surface).size() - used_vertices(joined).size();
    model.remarks.push_back("the surface is closed once vertices at the same place are joined (" +
                            std::to_string(gone) + " fewer)");
    model.surface = std::move(joined);
    model.defects = defects;
}

void turn_outward(Model& model) {
    const double volume = mass_properties(model.surface).volume;
    if (volume == 0) throw Error(SourceLocation{model.surface.file}, "the surface is closed but encloses no volume");
    if (volume < 0) {
        for (Triangle& triangle : model.surface.triangles) std::swap(triangle[1], triangle[2]);
        model.remarks.push_back("its triangles face inward: all are turned");
    }
    const PartsReport parts = orient_parts(model.surface);
    model.parts = parts.parts;
    if (parts.turned)
        model.remarks.push_back(count_of(parts.turned, "part") + " of " + std::to_string(parts.parts) +
                                " faced inward without being a cavity: turned");
    if (parts.nested)
        model.remarks.push_back(count_of(parts.nested, "part") + " of " + std::to_string(parts.parts) +
                                " lie within others without being a cavity: what is inside both counts twice");
    model.defects = inspect(model.surface);
}

void describe_defects(Model& model) {
    const MeshDefects& found = model.defects;
    const auto note = [&](std::size_t count, const std::string& one, const std::string& many) {
        if (count) model.remarks.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
    };
    note(found.open_edges, "edge has one triangle only", "edges have one triangle only");
    note(found.non_manifold_edges, "edge has more than two triangles", "edges have more than two triangles");
    note(found.misoriented_edges, "edge joins triangles of opposite orientation",
         "edges join triangles of opposite orientation");
    note(found.repeated_triangles, "triangle repeats another one", "triangles repeat others");
    note(found.degenerate_triangles, "triangle has no area", "triangles have no area");
    if (!found.first.empty()) model.remarks.push_back("the first: " + found.first);
}

void look_for_crossings(Model& model) {
    model.crossings = find_self_intersections(model.surface);
    if (model.crossings.pairs == 0) return;
    const TriangleSoup& surface = model.surface;
    const auto name = [&](std::uint32_t triangle) {
        if (surface.lines.empty()) return "triangle " + std::to_string(triangle);
        return "triangle " + std::to_string(triangle) + " (" +
               to_string(SourceLocation{surface.file, surface.lines[triangle]}) + ")";
    };
    model.remarks.push_back("the surface passes through itself: " + count_of(model.crossings.pairs, "pair") +
                            " of triangles cross, the first " + name(model.crossings.triangle_a) + " and " +
                            name(model.crossings.triangle_b));
}

// Crossings that are exact, and sheets that only look closed, show up in how often rays find themselves inside.
void look_inside(Model& model) {
    VoxelOptions coarse;
    coarse.step = -64;
    const std::unique_ptr<Host> host = make_host(1);
    double twice = 0, inside_out = 0;
    for (const VoxelPass& pass : voxel_mass_properties(model.surface, coarse, make_line_rasteriser, *host).passes) {
        twice = std::max(twice, pass.covered_twice);
        inside_out = std::max(inside_out, pass.inside_out);
    }
    const double worth_telling = 1e-9 * std::abs(mass_properties(model.surface).volume);
    if (twice > worth_telling)
        model.remarks.push_back("a volume of about " + number(twice) + " is enclosed more than once, and counts so");
    if (inside_out > worth_telling)
        model.remarks.push_back("a volume of about " + number(inside_out) +
                                " is enclosed inside out, and is subtracted");
}

// Volumes and tensors take the fifth power of a length.
void require_measurable(const TriangleSoup& surface, double scale) {
    constexpr double largest = 1e50;
    for (const Vec3& vertex : surface.vertices)
        if (!(vertex.cwiseAbs().maxCoeff() < largest))
            throw Error(SourceLocation{surface.file}, "a coordinate of " + number(vertex.cwiseAbs().maxCoeff()) +
                                                          (scale == 1 ? "" : ", after --scale,") +
                                                          " is too large: up to " + number(largest) +
                                                          " can be measured");
}

}  // namespace

Model load_model(const std::string& file, double scale) {
    Model model;
    model.surface = read_mesh(file);
    model.remarks = model.surface.notes;
    for (Vec3& vertex : model.surface.vertices) vertex *= scale;
    require_measurable(model.surface, scale);
    model.defects = inspect(model.surface);
    if (!model.bounds_volume()) close_by_joining(model);
    if (model.bounds_volume()) turn_outward(model);
    describe_defects(model);
    look_for_crossings(model);
    if (model.bounds_volume()) look_inside(model);
    model.area = surface_area(model.surface);
    return model;
}

BoundingVolumes bounding_volumes(const TriangleSoup& surface, const Vec3& center_of_mass) {
    const std::vector<Vec3> points = used_vertices(surface);
    return {bounding_box(points),
            sphere_about(center_of_mass, points),
            smallest_enclosing_sphere(points),
            oriented_box(points),
            slab_polytope(points, 18),
            slab_polytope(points, 26)};
}

}  // namespace kolize::cli
