#include "massprops/result.h"

#include <charconv>

namespace kolize::cli {
namespace {

std::string line(const std::string& name, std::initializer_list<double> values) {
    std::string text = name;
    for (const double value : values) {
        char digits[32];
        text += ' ' + std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    }
    return text;
}

std::string line(const std::string& name, const Vec3& v) { return line(name, {v.x(), v.y(), v.z()}); }

std::string line(const std::string& name, const Mat3& m) {
    return line(name, {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)});
}

std::string line(const std::string& name, const BoundingSphere& sphere, const Vec3& origin) {
    const Vec3 c = sphere.center - origin;
    return line(name, {c.x(), c.y(), c.z(), sphere.radius});
}

}  // namespace

double MassPropsResult::voxel_volume_uncertainty() const {
    const Vec3 sides = bounds.box.max - bounds.box.min;
    double spread = 0;
    for (const VoxelPass& pass : voxel->passes) {
        const double paired = 1 - static_cast<double>(pass.odd_lines) / static_cast<double>(pass.lines);
        spread = std::max(spread, paired * std::abs(pass.mass.volume - voxel->mass.volume));
    }
    return spread + sides.prod() * static_cast<double>(odd_rays()) / static_cast<double>(rays());
}

std::uint64_t MassPropsResult::rays() const {
    std::uint64_t sum = 0;
    for (const VoxelPass& pass : voxel->passes) sum += pass.lines;
    return sum;
}

std::uint64_t MassPropsResult::odd_rays() const {
    std::uint64_t sum = 0;
    for (const VoxelPass& pass : voxel->passes) sum += pass.odd_lines;
    return sum;
}

TriangleSoup recentred(const MassPropsResult& result) {
    const MassProperties& mass = result.mass;
    const BoundingVolumes& bounds = result.bounds;
    const OrientedBox& box = bounds.oriented;
    const Vec3& origin = mass.center_of_mass;
    TriangleSoup soup = result.model.surface;
    for (Vec3& vertex : soup.vertices) vertex -= origin;
    soup.info = {"mass properties by kolize " KOLIZE_VERSION ", method: " + result.method,
                 "from " + result.options.model + ", moved so that the origin is the centre of mass",
                 line("center_of_mass_in_original", origin),
                 line("volume", {mass.volume}),
                 line("area", {result.model.area}),
                 line("inertia_over_mass", mass.inertia_over_mass),
                 line("principal_moments", result.principal.moments),
                 line("principal_axes", Mat3(result.principal.axes.toRotationMatrix().transpose())),
                 line("bounding_sphere", bounds.about_center, origin),
                 line("enclosing_sphere", bounds.smallest, origin),
                 line("aabb_min", Vec3(bounds.box.min - origin)),
                 line("aabb_max", Vec3(bounds.box.max - origin)),
                 line("obb_center", Vec3(box.center - origin)),
                 line("obb_axes", Mat3(box.axes.transpose())),
                 line("obb_half_extents", box.half_extents)};
    return soup;
}

}  // namespace kolize::cli
