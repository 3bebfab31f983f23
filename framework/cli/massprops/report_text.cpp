#include "massprops/result.h"

#include <algorithm>

namespace kolize::cli {
namespace {

constexpr int shown = 10;  // digits; the JSON has all
constexpr std::size_t odd_rays_shown = 3;

std::string plain(double value) { return number(value + 0.0, shown); }  // -0 becomes 0

void add_row(Table& table, const std::string& name, const Vec3& v) {
    table.add({name, plain(v.x()), plain(v.y()), plain(v.z())});
}

// What is rounding against the scale of the whole is printed as 0.
template <class Matrix>
Matrix without_rounding(const Matrix& m, double scale) {
    return m.unaryExpr([scale](double x) { return std::abs(x) < 1e-14 * scale ? 0.0 : x; });
}

double size_of(const MassPropsResult& result) { return (result.bounds.box.max - result.bounds.box.min).norm(); }

void print_properties(const MassPropsResult& result, std::ostream& out) {
    const Mat3 inertia = without_rounding(result.mass.inertia_over_mass, result.mass.inertia_over_mass.norm());
    const Mat3 axes = without_rounding(result.principal.axes.toRotationMatrix(), 1);
    Table table({"by " + result.method, "x", "y", "z"});
    table.add({"volume", plain(result.mass.volume)});
    table.add({"area", plain(result.model.area)});
    add_row(table, "centre of mass", without_rounding(result.mass.center_of_mass, size_of(result)));
    for (int i = 0; i < 3; ++i) add_row(table, i == 0 ? "inertia / mass" : "", inertia.row(i));
    add_row(table, "principal moments / mass", result.principal.moments);
    for (int i = 0; i < 3; ++i) add_row(table, i == 0 ? "principal axes (a row each)" : "", axes.col(i));
    table.print(out);
}

void print_bounds(const MassPropsResult& result, std::ostream& out) {
    const BoundingVolumes& b = result.bounds;
    const double volume = result.mass.volume;
    const Vec3 sides = b.box.max - b.box.min, extents = 2 * b.oriented.half_extents;
    const auto sphere = [](const BoundingSphere& s) { return "radius " + plain(s.radius); };
    const auto box = [](const Vec3& s) { return plain(s.x()) + " x " + plain(s.y()) + " x " + plain(s.z()); };
    Table table({"bounding volume", "size", "volume", "filled"});
    const auto add = [&](const std::string& name, const std::string& size, double around) {
        table.add({name, size, plain(around), number(100 * volume / around) + " %"});
    };
    add("sphere about the centre of mass", sphere(b.about_center), b.about_center.volume());
    add("smallest sphere", sphere(b.smallest), b.smallest.volume());
    add("axis-aligned box", box(sides), sides.prod());
    add("oriented box", box(extents), b.oriented.volume());
    add("k-DOP, 18 planes", "", b.slabs_18.volume());
    add("k-DOP, 26 planes", "", b.slabs_26.volume());
    table.print(out);
}

std::string percent_off(double value, double exact) { return number(100 * (value / exact - 1), 2) + " %"; }

void add_mass(Table& table, const std::string& name, const MassProperties& mass, double size,
              std::vector<std::string> rest = {}) {
    const Mat3& i = mass.inertia_over_mass;
    const Vec3 c = without_rounding(mass.center_of_mass, size);
    std::vector<std::string> row{name,
                                 number(mass.volume, 8),
                                 number(c.x(), 6),
                                 number(c.y(), 6),
                                 number(c.z(), 6),
                                 number(i(0, 0), 8),
                                 number(i(1, 1), 8),
                                 number(i(2, 2), 8)};
    row.insert(row.end(), rest.begin(), rest.end());
    table.add(std::move(row));
}

void print_passes(const MassPropsResult& result, std::ostream& out) {
    const VoxelMassProperties& voxel = *result.voxel;
    const Vec3& h = voxel.grid.spacing;
    const auto& n = voxel.grid.cells;
    out << "Voxels: " << n[0] << " x " << n[1] << " x " << n[2] << " cells of " << number(h.x(), 6) << " x "
        << number(h.y(), 6) << " x " << number(h.z(), 6) << ", " << result.rays() << " rays by " << result.options.rays
        << ", " << number(result.voxel_seconds) << " s\n\n";
    Table table({"rays along", "volume", "cx", "cy", "cz", "Ixx/m", "Iyy/m", "Izz/m", "rays", "odd"});
    const double size = size_of(result);
    for (const VoxelPass& pass : voxel.passes)
        add_mass(table, std::string(1, "xyz"[pass.axis]), pass.mass, size,
                 {std::to_string(pass.lines), std::to_string(pass.odd_lines)});
    if (voxel.passes.size() > 1) add_mass(table, "mean", voxel.mass, size);
    if (result.exact) {
        add_mass(table, "exact", *result.exact, size);
        const double tensor = (voxel.mass.inertia_over_mass - result.exact->inertia_over_mass).norm() /
                              result.exact->inertia_over_mass.norm();
        table.add({"mean against exact", percent_off(voxel.mass.volume, result.exact->volume), "", "", "", "tensor",
                   number(100 * tensor, 2) + " %"});
    }
    table.print(out);
}

void print_odd_rays(const MassPropsResult& result, std::ostream& out) {
    if (result.odd_rays() == 0) return;
    const double share = static_cast<double>(result.odd_rays()) / static_cast<double>(result.rays());
    out << "\n"
        << result.odd_rays() << " of " << result.rays() << " rays (" << number(100 * share)
        << " %) cross the surface in a way that does not pair up; they are left out. The first:\n";
    for (std::size_t i = 0; i < std::min(odd_rays_shown, result.voxel->odd_lines.size()); ++i) {
        const OddLine& line = result.voxel->odd_lines[i];
        out << "  along "
            << "xyz"[line.axis] << ": " << line.crossings << " crossing" << (line.crossings == 1 ? "" : "s")
            << ", the first at " << number(line.point.x(), 6) << " " << number(line.point.y(), 6) << " "
            << number(line.point.z(), 6) << "\n";
    }
}

std::string give_or_take(double value, double uncertainty) {
    return number(value, 6) + " +- " + number(uncertainty, 2);
}

void print_estimates(const MassPropsResult& result, std::ostream& out) {
    const MassEstimate& e = *result.estimate;
    const Mat3 &value = e.mass.inertia_over_mass, &spread = e.inertia_over_mass;
    out << "The surface does not bound a volume: nothing exact can be said. By winding number, " << e.samples
        << " samples:\n\n";
    Table table({"estimate", "x", "y", "z"});
    table.add({"volume", give_or_take(e.mass.volume, e.volume)});
    table.add({"volume by voxels", give_or_take(result.voxel->mass.volume, result.voxel_volume_uncertainty())});
    const Vec3 &c = e.mass.center_of_mass, &dc = e.center_of_mass;
    table.add(
        {"centre of mass", give_or_take(c.x(), dc.x()), give_or_take(c.y(), dc.y()), give_or_take(c.z(), dc.z())});
    for (int i = 0; i < 3; ++i)
        table.add({i == 0 ? "inertia / mass" : "", give_or_take(value(i, 0), spread(i, 0)),
                   give_or_take(value(i, 1), spread(i, 1)), give_or_take(value(i, 2), spread(i, 2))});
    table.add({"area", plain(result.model.area)});
    add_row(table, "principal moments / mass", result.principal.moments);
    table.print(out);
}

}  // namespace

void print_text(const MassPropsResult& result, std::ostream& out) {
    const Model& model = result.model;
    out << result.options.model << ": " << model.surface.vertices.size() << " vertices, "
        << model.surface.triangles.size() << " triangles, " << (model.bounds_volume() ? "closed" : "not closed");
    if (model.parts > 1) out << ", " << model.parts << " parts";
    out << "\n";
    for (const std::string& remark : model.remarks) out << "  - " << remark << "\n";
    for (const std::string& line : model.surface.info) out << "  info: " << line << "\n";
    out << "\n";
    if (result.estimate)
        print_estimates(result, out);
    else
        print_properties(result, out);
    out << "\n";
    print_bounds(result, out);
    if (!result.voxel) return;
    out << "\n";
    print_passes(result, out);
    print_odd_rays(result, out);
}

}  // namespace kolize::cli
