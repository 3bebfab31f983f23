#include "demos/exact_intersection.h"
#include "framework/mesh_files.h"

#include <kolize/mass_properties.h>
#include <kolize/mesh_io.h>

#include <catch2/catch.hpp>

#include <numbers>

using namespace kolize;
using namespace kolize::test;

namespace {

using std::numbers::pi;

const std::filesystem::path demos = std::filesystem::path(KOLIZE_SOURCE_DIR) / "demos";

struct Solid {
    std::string name;
    double volume;  // closed form
};

double regular_area(int n, double radius) { return 0.5 * n * radius * radius * std::sin(2 * pi / n); }

std::vector<Solid> object_solids() {
    const double tetrahedron_side = 0.6 * std::sqrt(8.0 / 3);
    return {{"tetrahedron", std::pow(tetrahedron_side, 3) / (6 * std::sqrt(2.0))},
            {"frustum", regular_area(4, 0.65) * 0.7 * (1 + 0.5 + 0.25) / 3},
            {"cone", regular_area(16, 0.5) * 0.9 / 3},
            {"cylinder", regular_area(16, 0.4) * 0.9},
            {"u_bar", 7 * 0.027},
            {"l_bar", 4 * 0.027},
            {"torus", 16 * std::sin(2 * pi / 16) * 0.5 * regular_area(8, 0.18)},  // Pappus, for 16 straight pieces
            {"star", 10 * 0.5 * 0.65 * 0.28 * std::sin(pi / 5) * 0.3}};
}

std::filesystem::path object_file(const std::string& name) {
    return demos / "box_objects" / "models" / (name + ".obj");
}

TriangleSoup fighter() { return read_mesh(demos / "box_fighter" / "fighter.obj"); }

int genus(const TriangleSoup& soup) {  // of one closed piece
    const auto mesh = build_mesh(soup);
    const auto euler =
        static_cast<int>(mesh->vertices.size() + mesh->triangles.size()) - static_cast<int>(mesh->edges.size());
    return (2 - euler) / 2;
}

bool in_one_piece(const TriangleSoup& soup) {
    const auto mesh = build_mesh(soup);
    std::vector<bool> seen(mesh->triangles.size());
    std::vector<std::uint32_t> open = {0};
    std::size_t count = 0;
    while (!open.empty()) {
        const std::uint32_t t = open.back();
        open.pop_back();
        if (seen[t]) continue;
        seen[t] = true;
        ++count;
        for (const std::uint32_t e : mesh->triangle_edges[t])
            open.insert(open.end(), {mesh->edges[e].t0, mesh->edges[e].t1});
    }
    return count == mesh->triangles.size();
}

}  // namespace

TEST_CASE("The committed models and states are those that make_models writes", "[demos]") {
    const ScratchFolder folder;
    const std::string command = std::string(KOLIZE_BINARY_DIR) + "/bin/make_models " + folder.path().string();
    REQUIRE(std::system(command.c_str()) == 0);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
        if (!entry.is_regular_file()) continue;
        const std::filesystem::path name = std::filesystem::relative(entry.path(), folder.path());
        CAPTURE(name);
        CHECK(file_bytes(entry.path()) == file_bytes(demos / name));
        ++files;
    }
    CHECK(files == 2 * object_solids().size() + 2);
}

TEST_CASE("The solids of box_objects are closed and have the volume of their closed form", "[demos]") {
    for (const Solid& solid : object_solids()) {
        CAPTURE(solid.name);
        const TriangleSoup soup = read_mesh(object_file(solid.name));
        CHECK(inspect(soup).closed());
        CHECK(in_one_piece(soup));
        CHECK(genus(soup) == (solid.name == "torus" ? 1 : 0));
        CHECK(mass_properties(soup).volume == Approx(solid.volume).epsilon(2e-5));  // the files have six decimals
        CHECK(self_intersections(soup, 1e-6) == 0);
    }
}

TEST_CASE("The solids of box_objects reach 0.5 to 0.8 m from their centre of mass", "[demos]") {
    for (const Solid& solid : object_solids()) {
        CAPTURE(solid.name);
        const TriangleSoup soup = read_mesh(object_file(solid.name));
        const Vec3 center = mass_properties(soup).center_of_mass;
        double radius = 0;
        for (const Vec3& v : soup.vertices) radius = std::max(radius, (v - center).norm());
        CHECK(radius >= 0.5);
        CHECK(radius <= 0.8);
        CHECK(center.norm() > 0.05);  // real files are off-centre, too
    }
}

TEST_CASE("The fighter is one closed surface of genus 0 that does not cross itself", "[demos]") {
    const TriangleSoup soup = fighter();
    CHECK(inspect(soup).closed());
    CHECK(in_one_piece(soup));
    CHECK(genus(soup) == 0);
    CHECK(soup.vertices.size() == 142);
    CHECK(soup.triangles.size() == 280);
    CHECK(self_intersections(soup, 1e-6) == 0);
    const auto mesh = build_mesh(soup);
    CHECK(2 * mesh->bounds.half_extents().maxCoeff() == Approx(197));
    CHECK(mass_properties(soup).volume > 0);
}

TEST_CASE("The fighter is not convex and has three different principal moments", "[demos]") {
    const TriangleSoup soup = fighter();
    const auto mesh = build_mesh(soup);
    int reentrant = 0;
    for (const Edge& edge : mesh->edges) {
        const Triangle& other = mesh->triangles[edge.t1];
        for (const std::uint32_t v : other)
            if (v != edge.v0 && v != edge.v1)
                reentrant += mesh->normals[edge.t0].dot(mesh->vertices[v] - mesh->vertices[edge.v0]) > 1;
    }
    CHECK(reentrant > 10);
    Vec3 moments = principal_frame(mass_properties(soup).inertia_over_mass).moments;
    std::sort(moments.begin(), moments.end());
    CHECK(moments[1] > 1.1 * moments[0]);
    CHECK(moments[2] > 1.1 * moments[1]);
}

TEST_CASE("The test for self-intersection finds what crosses and passes what only touches", "[demos]") {
    TriangleSoup box = box_soup(Vec3(1, 1, 1));
    CHECK(self_intersections(box, 1) == 0);
    TriangleSoup pierced = box;  // a vertex pushed through the opposite side
    pierced.vertices[7] = Vec3(-3, -2, -1);
    CHECK(self_intersections(pierced, 1) > 0);
    const TriangleSoup folded{
        {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0), Vec3(1, 2, 0)}, {{0, 1, 2}, {0, 3, 1}}, {}, ""};
    CHECK(self_intersections(folded, 1) == 1);
    const TriangleSoup touching{
        {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0), Vec3(1, 1, 0), Vec3(1, 1, 2), Vec3(2, 1, 2)},
        {{0, 1, 2}, {3, 4, 5}},
        {},
        ""};
    CHECK(self_intersections(touching, 1) == 1);  // a vertex on a face that does not name it
    const TriangleSoup neighbours{
        {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0), Vec3(-4, 0, 0), Vec3(0, -4, 0)}, {{0, 1, 2}, {0, 3, 4}}, {}, ""};
    CHECK(self_intersections(neighbours, 1) == 0);
}
