// kolize massprops on models whose mass properties are known: JSON, text, written models and simulators' formats.
#include "cli/massprops_runs.h"

#include <kolize/mass_properties.h>
#include <kolize/mesh_io.h>

using namespace kolize;
using namespace kolize::test;
using nlohmann::json;

namespace {

// The numbers of an XML attribute NAME="..." or element <NAME>...</NAME>.
std::vector<double> numbers_of(const std::string& xml, const std::string& name) {
    std::size_t begin = xml.find(" " + name + "=\"");
    if (begin == std::string::npos) begin = xml.find("<" + name + ">");
    if (begin == std::string::npos) return {};
    begin += name.size() + 2 + (xml[begin] == ' ');
    std::istringstream words(xml.substr(begin, xml.find_first_of("\"<", begin) - begin));
    return {std::istream_iterator<double>(words), {}};
}

struct Inertial {
    std::vector<double> place, mass;
    std::vector<double> tensor;  // xx, yy, zz, xy, xz, yz
};

Inertial inertial_of(const std::string& format, const std::string& text) {
    Inertial found;
    if (format == "mjcf") return {numbers_of(text, "pos"), numbers_of(text, "mass"), numbers_of(text, "fullinertia")};
    for (const char* name : {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"})
        for (const double number : numbers_of(text, name)) found.tensor.push_back(number);
    if (format == "sdf") {
        found.place = numbers_of(text, "pose");
        found.mass = numbers_of(text, "mass");
    } else {
        found.place = numbers_of(text, "xyz");
        for (const double angle : numbers_of(text, "rpy")) found.place.push_back(angle);
        found.mass = numbers_of(text, "value");
    }
    return found;
}

// What follows the name in the one info line that starts with it.
std::vector<double> info_numbers(const TriangleSoup& soup, const std::string& name) {
    std::vector<double> numbers;
    for (const std::string& line : soup.info) {
        if (!line.starts_with(name + " ")) continue;
        std::istringstream words(line.substr(name.size()));
        numbers.insert(numbers.end(), std::istream_iterator<double>(words), {});
    }
    return numbers;
}

std::vector<double> flat(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

TEST_CASE("massprops gives the exact mass properties and all bounding volumes as JSON", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("corner.obj", as_obj(corner_solid()));
    const json result = measured(shell, "corner.obj");
    CHECK(result["model"] == "corner.obj");
    CHECK(result["method"] == "exact");
    CHECK(result["vertices"] == 4);
    CHECK(result["triangles"] == 4);
    CHECK(result["closed"] == true);
    CHECK(result["remarks"].empty());
    CHECK(result["volume"].get<double>() == Approx(1).epsilon(1e-15));
    CHECK(result["area"].get<double>() == Approx(1 + 1.5 + 3 + 3.5).epsilon(1e-15));
    CHECK((vector_of(result["center_of_mass"]) - corner_sides / 4).norm() <= 1e-15);
    CHECK((tensor_of(result["inertia_over_mass"]) - corner_tensor()).norm() <= 1e-15);

    const Mat3 axes = tensor_of(result["principal_axes"]);
    const Mat3 rebuilt = axes.transpose() * vector_of(result["principal_moments"]).asDiagonal() * axes;
    CHECK((rebuilt - corner_tensor()).norm() <= 1e-15);
    const std::vector<double> q = flat(result["principal_orientation"]);
    CHECK((Quat(q[0], q[1], q[2], q[3]).toRotationMatrix() - axes.transpose()).norm() <= 1e-15);

    const json& sphere = result["bounding_sphere"];
    CHECK(sphere["center"] == result["center_of_mass"]);
    CHECK(sphere["radius"].get<double>() == Approx((Vec3(0, 0, 3) - corner_sides / 4).norm()));
    CHECK(result["enclosing_sphere"]["radius"].get<double>() ==
          Approx(std::sqrt(650.0) / 14));  // about the slanted face
    CHECK(vector_of(result["aabb"]["min"]) == Vec3(0, 0, 0));
    CHECK(vector_of(result["aabb"]["max"]) == corner_sides);
    CHECK(result["aabb"]["fill"].get<double>() == Approx(1.0 / 6));
    const Vec3 half = vector_of(result["obb"]["half_extents"]);
    CHECK(result["obb"]["volume"].get<double>() == Approx(8 * half.prod()));
    CHECK(result["obb"]["volume"].get<double>() <= 6 * (1 + 1e-12));
    for (const Vec3& vertex : corner_solid().vertices) {
        const Vec3 local = tensor_of(result["obb"]["axes"]) * (vertex - vector_of(result["obb"]["center"]));
        CHECK(((local.cwiseAbs() - half).array() <= 1e-12).all());
    }
    CHECK(result["kdop26"]["volume"].get<double>() <= result["kdop18"]["volume"].get<double>());
}

TEST_CASE("massprops prints the same values as text", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("corner.obj", as_obj(corner_solid()));
    const Outcome outcome = shell.kolize("massprops corner.obj");
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    CHECK(outcome.out.starts_with("corner.obj: 4 vertices, 4 triangles, closed\n"));
    for (const char* value : {"by exact", "0.4875", "0.375", "0.1875", "oriented box"})
        CHECK(outcome.out.find(value) != std::string::npos);
}

TEST_CASE("massprops takes the voxel step and the axes as arguments, a negative step too", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("corner.obj", as_obj(corner_solid()));
    const json one = measured(shell, "corner.obj -300 1");
    CHECK(one["method"] == "voxel");
    CHECK(one["divisions"] == 300);
    CHECK(one["axes"] == 1);
    CHECK(one["rays"] == 200 * 300);
    CHECK(one["odd_rays"] == 0);
    CHECK(one["step"].get<double>() == Approx(0.01));
    CHECK(one["time_s"].get<double>() > 0);
    CHECK(one["volume"].get<double>() == Approx(1).epsilon(1e-4));
    CHECK((tensor_of(one["inertia_over_mass"]) - corner_tensor()).norm() <= 1e-3);
    CHECK(one["exact"]["volume"].get<double>() == Approx(1).epsilon(1e-15));

    const json three = measured(shell, "corner.obj 0.01");
    CHECK(three["axes"] == 3);
    CHECK(three["rays"] == 200 * 300 + 100 * 300 + 100 * 200);
    CHECK(three["voxel"]["passes"].size() == 3);
    const double uncertainty = three["voxel"]["volume_uncertainty"];
    CHECK(std::abs(three["volume"].get<double>() - 1) <= 1e-4);
    CHECK(uncertainty <= 1e-3);
    const json embree = measured(shell, "corner.obj 0.01 --rays embree");
    CHECK(embree["voxel"]["ray_caster"] == "embree");
    CHECK(embree["volume"].get<double>() == Approx(1).epsilon(1e-3));
}

TEST_CASE("massprops --scale changes the unit of length first", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("corner.obj", as_obj(corner_solid()));
    const json result = measured(shell, "corner.obj --scale 0.001");
    CHECK(result["volume"].get<double>() == Approx(1e-9).epsilon(1e-14));
    CHECK(result["area"].get<double>() == Approx(9e-6).epsilon(1e-14));
    CHECK((vector_of(result["center_of_mass"]) - corner_sides / 4000).norm() <= 1e-18);
    CHECK((tensor_of(result["inertia_over_mass"]) - 1e-6 * corner_tensor()).norm() <= 1e-21);
}

TEST_CASE("massprops --output writes the model about its centre of mass, with what was found", "[cli][massprops]") {
    const Shell shell;
    const TriangleSoup solid = corner_solid();
    shell.folder.write("corner.obj", as_obj(solid));
    const json result = measured(shell, "corner.obj --output centred.wrl");
    const TriangleSoup centred = read_mesh(shell.folder.path() / "centred.wrl");
    const Vec3 center = vector_of(result["center_of_mass"]);
    CHECK(centred.triangles == solid.triangles);
    REQUIRE(centred.vertices.size() == solid.vertices.size());
    for (std::size_t v = 0; v < solid.vertices.size(); ++v) CHECK(centred.vertices[v] == solid.vertices[v] - center);
    CHECK(mass_properties(centred).center_of_mass.norm() <= 1e-15);

    for (const char* name : {"volume", "area", "inertia_over_mass", "principal_moments", "principal_axes"})
        CHECK(info_numbers(centred, name) == flat(result[name]));
    CHECK(info_numbers(centred, "center_of_mass_in_original") == flat(center));
    CHECK(info_numbers(centred, "aabb_min") == flat(Vec3(vector_of(result["aabb"]["min"]) - center)));
    CHECK(info_numbers(centred, "aabb_max") == flat(Vec3(vector_of(result["aabb"]["max"]) - center)));
    CHECK(info_numbers(centred, "obb_center") == flat(Vec3(vector_of(result["obb"]["center"]) - center)));
    CHECK(info_numbers(centred, "obb_axes") == flat(result["obb"]["axes"]));
    CHECK(info_numbers(centred, "obb_half_extents") == flat(result["obb"]["half_extents"]));
    CHECK(info_numbers(centred, "bounding_sphere") ==
          std::vector<double>{0, 0, 0, result["bounding_sphere"]["radius"].get<double>()});

    CHECK(measured(shell, "centred.wrl")["info"].size() == centred.info.size());
    for (const char* name : {"c.obj", "c.off", "c.ply", "c.stl"}) {
        CAPTURE(name);
        CHECK(shell.kolize(std::string("massprops corner.obj --output ") + name).code == 0);
        CHECK(mass_properties(read_mesh(shell.folder.path() / name)).center_of_mass.norm() <= 1e-7);
    }
}

TEST_CASE("massprops writes inertial elements for simulators", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("corner.obj", as_obj(corner_solid()));
    const std::string format = GENERATE("urdf", "mjcf", "sdf");
    CAPTURE(format);
    const Mat3 tensor = corner_tensor();
    const std::vector<double> exact{tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(0, 2), tensor(1, 2)};
    // 2.5 kg; a density; millimetres: 1e-9 m^3 of it, and 1e-6 for every square of a length.
    for (const auto& [arguments, mass, scale] :
         {std::tuple("--mass 2.5", 2.5, 1.0), {"--density 7", 7.0, 1.0}, {"--density 2e9 --scale 1e-3", 2.0, 1e-3}}) {
        CAPTURE(arguments);
        const Outcome outcome = shell.kolize("massprops corner.obj --format " + format + " " + arguments);
        REQUIRE(outcome.code == 0);
        CHECK(outcome.out.starts_with("<inertial"));
        const Inertial found = inertial_of(format, outcome.out);
        REQUIRE(found.mass.size() == 1);
        REQUIRE(found.tensor.size() == 6);
        REQUIRE(found.place.size() == (format == "mjcf" ? 3 : 6));
        CHECK(found.mass[0] == Approx(mass).epsilon(1e-14));
        for (std::size_t i = 0; i < 6; ++i)
            CHECK(found.tensor[i] == Approx(mass * scale * scale * exact[i]).epsilon(1e-13));
        for (int i = 0; i < 3; ++i)
            CHECK(found.place[static_cast<std::size_t>(i)] == Approx(scale * corner_sides[i] / 4).epsilon(1e-14));
        for (std::size_t i = 3; i < found.place.size(); ++i) CHECK(found.place[i] == 0);
    }
    const Outcome without = shell.kolize("massprops corner.obj --format " + format);
    CHECK(without.code == 2);
    CHECK(without.out.empty());
    CHECK(without.err ==
          "kolize: --format " + format + " needs the mass of the body: give --mass (kg) or --density (kg/m^3)\n");
}
