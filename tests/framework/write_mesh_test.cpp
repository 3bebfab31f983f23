#include "framework/mesh_files.h"
#include "framework/solids.h"

#include <kolize/mesh_io.h>

#include <catch2/catch.hpp>

#include <random>

using namespace kolize;
using namespace kolize::test;

namespace {

const std::vector<std::string> extensions = {".obj", ".off", ".ply", ".stl", ".wrl"};

bool same_bits(const Vec3& a, const Vec3& b) {
    for (int i = 0; i < 3; ++i)
        if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
    return true;
}

// Triangles of any finite numbers, with no vertex shared: then STL, which joins vertices, gives the same ones back.
TriangleSoup random_soup() {
    std::mt19937_64 random(99);
    TriangleSoup soup;
    while (soup.vertices.size() < 3000) {
        Vec3 p;
        for (double& x : p) do
                x = std::bit_cast<double>(random());
            while (!std::isfinite(x));
        soup.vertices.push_back(p);
    }
    soup.vertices[0] = Vec3(0.1, 5e-324, -1.7976931348623157e308);
    for (std::uint32_t v = 0; v < 3000; v += 3) soup.triangles.push_back({v, v + 1, v + 2});
    return soup;
}

std::string message_of(const TriangleSoup& soup, const std::filesystem::path& file) {
    try {
        write_mesh(soup, file);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

}  // namespace

TEST_CASE("What is written reads back to the same bits in every format", "[write_mesh]") {
    const ScratchFolder folder;
    const TriangleSoup soup = random_soup();
    for (const std::string& extension : extensions) {
        CAPTURE(extension);
        const std::filesystem::path file = folder.path() / ("a" + extension);
        write_mesh(soup, file);
        const TriangleSoup back = read_mesh(file);
        CHECK(back.triangles == soup.triangles);
        REQUIRE(back.vertices.size() == soup.vertices.size());
        for (std::size_t v = 0; v < soup.vertices.size(); ++v) REQUIRE(same_bits(back.vertices[v], soup.vertices[v]));
        const std::string first = file_bytes(file);
        write_mesh(back, file);
        CHECK(file_bytes(file) == first);
    }
}

TEST_CASE("Shared and unused vertices and minus zero come back, but for STL which joins by value", "[write_mesh]") {
    const ScratchFolder folder;
    TriangleSoup soup = corner_tetrahedron();
    soup.vertices[0].x() = -0.0;
    soup.vertices.emplace_back(7, 8, 9);
    for (const std::string& extension : extensions) {
        CAPTURE(extension);
        const std::filesystem::path file = folder.path() / ("a" + extension);
        write_mesh(soup, file);
        const TriangleSoup back = read_mesh(file);
        CHECK(back.triangles.size() == 4);
        CHECK(inspect(back).closed());
        if (extension == ".stl") {
            CHECK(back.vertices.size() == 4);
        } else {
            CHECK(back.triangles == soup.triangles);
            CHECK(back.vertices.size() == 5);
            CHECK(std::signbit(back.vertices[0].x()));
        }
    }
}

TEST_CASE("Facet normals of STL are unit and outward, or zero", "[write_mesh]") {
    const ScratchFolder folder;
    TriangleSoup soup = corner_tetrahedron();
    soup.triangles.push_back({0, 1, 1});
    write_mesh(soup, folder.path() / "a.stl");
    std::istringstream text(file_bytes(folder.path() / "a.stl"));
    std::vector<Vec3> normals;
    for (std::string word; text >> word;) {
        if (word != "normal") continue;
        Vec3& n = normals.emplace_back();
        text >> n.x() >> n.y() >> n.z();
    }
    REQUIRE(normals.size() == 5);
    CHECK(normals[0] == Vec3(0, 0, -1));
    CHECK((normals[3] - Vec3(1, 1, 1).normalized()).norm() < 1e-15);
    CHECK(normals[4] == Vec3(0, 0, 0));
}

TEST_CASE("The info of a soup goes through VRML as it is", "[write_mesh]") {
    const ScratchFolder folder;
    TriangleSoup soup = corner_tetrahedron();
    soup.info = {"mass 1 kg", "", "a \"quoted\" word", "back\\slash \\\" \\", "line\nbreak # } ]", "\xc3\xa4"};
    write_mesh(soup, folder.path() / "A.WRL");
    CHECK(read_mesh(folder.path() / "A.WRL").info == soup.info);
}

TEST_CASE("A mesh that cannot be written leaves nothing behind", "[write_mesh]") {
    const ScratchFolder folder;
    const TriangleSoup soup = corner_tetrahedron();
    for (const std::string name : {"a.dae", "a", ".obj"})
        CHECK(message_of(soup, folder.path() / name) ==
              (folder.path() / name).string() +
                  ": a mesh is written to a file that ends in .obj, .off, .ply, .stl or .wrl");
    const std::filesystem::path taken = folder.path() / "taken.obj";
    std::filesystem::create_directories(taken / "inside");
    CHECK(message_of(soup, taken) == taken.string() + ": the mesh cannot be written to this file");
    CHECK(message_of(soup, folder.path() / "no" / "such.obj") ==
          (folder.path() / "no" / "such.obj").string() + ": the mesh cannot be written to this file");
    CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("A mesh that is written replaces the file of its name and leaves no other", "[write_mesh]") {
    const ScratchFolder folder;
    const std::filesystem::path file = folder.write("a.obj", "old");
    write_mesh(corner_tetrahedron(), file);
    CHECK(read_mesh(file).triangles == corner_tetrahedron().triangles);
    CHECK(files_in(folder.path()) == 1);
}
