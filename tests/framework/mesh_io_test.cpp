#include "framework/mesh_files.h"
#include "framework/solids.h"

#include <kolize/mass_properties.h>
#include <kolize/mesh_io.h>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

struct NamedFile {
    std::string name;
    std::string bytes;
};

std::string as_obj(const TriangleSoup& soup, const ScratchFolder& folder) {
    write_mesh(soup, folder.path() / "out.obj");
    return file_bytes(folder.path() / "out.obj");
}

std::vector<NamedFile> in_all_formats(const TriangleSoup& soup, const ScratchFolder& folder) {
    return {{"a.obj", as_obj(soup, folder)},       {"a.off", as_off(soup)},
            {"text.stl", as_text_stl(soup)},       {"binary.stl", as_binary_stl(soup)},
            {"text.ply", as_text_ply(soup)},       {"little.ply", as_binary_ply(soup, false)},
            {"big.ply", as_binary_ply(soup, true)}};
}

// Corner by corner: formats that share no vertices number them in another order.
std::vector<double> corners(const TriangleSoup& soup) {
    std::vector<double> result;
    for (const Triangle& t : soup.triangles)
        for (const std::uint32_t v : t) result.insert(result.end(), soup.vertices[v].begin(), soup.vertices[v].end());
    return result;
}

// A cone whose coordinates a float holds, so that every format can carry it.
TriangleSoup float_cone() {
    TriangleSoup soup = cone48();
    for (Vec3& v : soup.vertices)
        for (double& x : v) x = static_cast<float>(x);
    return soup;
}

std::string message_of(const NamedFile& file, const ScratchFolder& folder) {
    const std::filesystem::path path = folder.write(file.name, file.bytes);
    try {
        read_mesh(path);
    } catch (const Error& error) {
        const std::string text = error.what(), prefix = path.string();
        return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
    }
    return "no error";
}

struct BrokenFile {
    NamedFile file;
    std::string message;  // behind the file's name
};

void check_messages(const std::vector<BrokenFile>& cases) {
    const ScratchFolder folder;
    for (const BrokenFile& broken : cases) CHECK(message_of(broken.file, folder) == broken.message);
}

const std::string ply_start = "ply\nformat ascii 1.0\n";
const std::string ply_vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string ply_faces = "element face 1\nproperty list uchar int vertex_index\nend_header\n";
const std::string three_points = "0 0 0\n1 0 0\n0 1 0\n";

}  // namespace

TEST_CASE("The same solid in every format is the same soup", "[mesh_io]") {
    const ScratchFolder folder;
    const TriangleSoup solid = float_cone();
    for (const NamedFile& file : in_all_formats(solid, folder)) {
        CAPTURE(file.name);
        const TriangleSoup soup = read_mesh(folder.write(file.name, file.bytes));
        CHECK(soup.vertices.size() == solid.vertices.size());  // STL vertices are joined
        CHECK((corners(soup) == corners(solid)));              // not to print a thousand numbers
        CHECK(inspect(soup).closed());
        CHECK(soup.file == (folder.path() / file.name).string());
    }
}

TEST_CASE("Content tells PLY, OFF and STL apart whatever the file is called", "[mesh_io]") {
    const ScratchFolder folder;
    const TriangleSoup solid = float_cone();
    for (const NamedFile& file : in_all_formats(solid, folder)) {
        CAPTURE(file.name);
        const bool told = !file.name.ends_with(".obj");
        const std::filesystem::path path = folder.write("misnamed.data", file.bytes);
        if (told) CHECK((corners(read_mesh(path)) == corners(solid)));
        if (!told) CHECK_THROWS_AS(read_mesh(path), Error);
    }
}

TEST_CASE("OBJ faces take all forms of corners, negative numbers and polygons", "[mesh_io]") {
    const ScratchFolder folder;
    const std::string text =
        "# a square and more\r\n"
        "mtllib any thing.mtl\nvt 0 0\nvn 0 0 1\n"
        "v 0 0 0\nv +1 0 0 1.0\nv 1 1.0e0 0 0.5 0.5 0.5\nv 0 1 0 # last corner\n"
        "usemtl red\nf 1/1 2/1/1 \\\n  3//1 4\n"
        "g a\\\nf\n"  // the line goes on: not a face
        "f -4 -3 -2\n"
        "f 1 2 5\nv 5 5 5";  // names a vertex that follows
    const TriangleSoup soup = read_mesh(folder.write("forms.obj", text));
    const std::vector<Triangle> expected = {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 1, 4}};
    CHECK(soup.triangles == expected);
    CHECK(soup.lines == std::vector<int>{10, 10, 14, 15});
    CHECK(soup.vertices[2] == Vec3(1, 1, 0));
    CHECK(soup.vertices[4] == Vec3(5, 5, 5));
}

TEST_CASE("A concave face is cut into triangles that do not overlap, in every format with polygons", "[mesh_io]") {
    // An arrow head whose fan from the first corner folds over itself: the area tells.
    const ScratchFolder folder;
    const double area = 0.5 * 2 * 2 - 0.5 * 2 * 0.5;
    const std::string obj = "v 0 0 0\nv 1 0.5 0\nv 2 0 0\nv 1 2 0\nf 1 2 3 4\nf 3 4 1 2\n";
    const std::string off = "OFF\n4 2 0\n0 0 0\n1 0.5 0\n2 0 0\n1 2 0\n4 0 1 2 3\n4 2 3 0 1\n";
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0.5 0\n2 0 0\n1 2 0\n4 0 1 2 3\n4 2 3 0 1\n";
    for (const auto& [name, bytes] : {std::pair("a.obj", obj), std::pair("a.off", off), std::pair("a.ply", ply)}) {
        CAPTURE(name);
        const TriangleSoup soup = read_mesh(folder.write(name, bytes));
        CHECK(soup.triangles.size() == 4);
        CHECK(surface_area(soup) == Approx(2 * area));
    }
}

TEST_CASE("OFF files take comments, colours and further columns", "[mesh_io]") {
    const ScratchFolder folder;
    const std::string square =
        "  # comment\nCOFF # of a square\n4 1 4\n\n0 0 0 255 0 0 255\n1 0 0 0 0 0 0\n"
        "1 1 0 0 0 0 0 # corner\n0 1 0 1 1 1 1\n4 0 1 2 3 0.5 0.5 0.5\n";
    const TriangleSoup coloured = read_mesh(folder.write("c.off", square));
    CHECK(coloured.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
    CHECK(coloured.vertices[3] == Vec3(0, 1, 0));
    CHECK(coloured.lines == std::vector<int>{9, 9});
    const TriangleSoup dense = read_mesh(folder.write("d.off", "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2"));
    CHECK(dense.triangles == std::vector<Triangle>{{0, 1, 2}});
    CHECK(read_mesh(folder.write("n.off", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 2 1 0\n")).triangles ==
          std::vector<Triangle>{{2, 1, 0}});
}

TEST_CASE("STL vertices are joined when they are equal, minus zero included", "[mesh_io]") {
    const ScratchFolder folder;
    const std::string text =
        "solid\nfacet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid\nsolid two parts\nfacet normal 0 0 1\nouter loop\n"
        "vertex -0 0 -0.0\nvertex 1e0 -0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid two parts\n";
    const TriangleSoup soup = read_mesh(folder.write("two.stl", text));
    CHECK(soup.vertices.size() == 4);
    CHECK(soup.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}});
    CHECK(soup.lines == std::vector<int>{2, 11});
    for (const Vec3& v : soup.vertices)
        for (const double x : v) CHECK_FALSE(std::signbit(x));
}

TEST_CASE("PLY files take any scalar types, extra lists and elements in any order", "[mesh_io]") {
    const ScratchFolder folder;
    for (const bool big : {false, true}) {
        CAPTURE(big);
        std::string bytes = std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
                            "_endian 1.0\r\nobj_info # any\r\nelement material 2\r\nproperty list uint8 uint8 name\r\n"
                            "property double shine\r\nelement face 1\r\nproperty short group\r\n"
                            "property list ushort uint16 vertex_index\r\nelement vertex 4\r\nproperty int8 z\r\n"
                            "property list int float32 weights\r\nproperty uint x\r\nproperty int16 y\r\n"
                            "end_header\r\n";
        for (int m = 0; m < 2; ++m) {
            bytes += std::string("\x02") + "ab";
            put(bytes, 0.25, big);
        }
        put(bytes, std::int16_t{-3}, big);
        for (const std::uint16_t number : {4, 0, 1, 2, 3}) put(bytes, number, big);
        for (int v = 0; v < 4; ++v) {
            put(bytes, static_cast<std::int8_t>(-v));
            put(bytes, std::int32_t{1}, big);
            put(bytes, 0.5f, big);
            put(bytes, static_cast<std::uint32_t>(4000000000u + v), big);
            put(bytes, static_cast<std::int16_t>(-1000 * v), big);
        }
        const TriangleSoup soup = read_mesh(folder.write("any.ply", bytes));
        CHECK(soup.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
        for (int v = 0; v < 4; ++v) CHECK(soup.vertices[v] == Vec3(4e9 + v, -1000 * v, -v));
    }
}

TEST_CASE("Assimp finds as many triangles in the same bounds", "[mesh_io]") {
    const ScratchFolder folder;
    for (const NamedFile& file : in_all_formats(subdivided(float_cone()), folder)) {
        CAPTURE(file.name);
        const std::filesystem::path path = folder.write(file.name, file.bytes);
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
        REQUIRE(scene);
        std::size_t triangles = 0;
        Aabb theirs, ours;
        for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
            triangles += scene->mMeshes[m]->mNumFaces;
            for (unsigned v = 0; v < scene->mMeshes[m]->mNumVertices; ++v) {
                const aiVector3D& p = scene->mMeshes[m]->mVertices[v];
                theirs.include(Vec3(p.x, p.y, p.z));
            }
        }
        const TriangleSoup soup = read_mesh(path);
        for (const Vec3& v : soup.vertices) ours.include(v);
        CHECK(soup.triangles.size() == triangles);
        CHECK((ours.min - theirs.min).norm() <= 1e-5 * ours.half_extents().norm());  // Assimp keeps floats
        CHECK((ours.max - theirs.max).norm() <= 1e-5 * ours.half_extents().norm());
    }
}

TEST_CASE("What is no mesh file is said in one sentence", "[mesh_io]") {
    const ScratchFolder folder;
    CHECK_THROWS_WITH(read_mesh(folder.path() / "gone.obj"),
                      (folder.path() / "gone.obj").string() + ": there is no such file");
    std::filesystem::create_directories(folder.path() / "dir.obj");
    CHECK_THROWS_WITH(read_mesh(folder.path() / "dir.obj"),
                      (folder.path() / "dir.obj").string() + ": this is a folder, not a mesh file");
    CHECK_THROWS_WITH(read_mesh("/dev/null"), "/dev/null: this is not a regular file");
    check_messages({
        {{"a.obj", ""}, ": the file is empty"},
        {{"a.txt", "hello"}, ": this is no mesh file that can be read: OBJ, OFF, STL, PLY and VRML97 are"},
        {{"a.obj", "# nothing\n"}, ": there are no triangles in the file"},
        {{"a.obj", std::string("v 1\n\0junk", 9)}, ":2: there is a zero byte in what should be text"},
    });
}

TEST_CASE("Broken OBJ files are refused with file and line", "[mesh_io]") {
    const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    check_messages({
        {{"a.obj", "v 0 0\n"}, ":1: a coordinate of a vertex is missing"},
        {{"a.obj", "\nv 0 0 zero\n"}, ":2: a coordinate of a vertex must be a number, is 'zero'"},
        {{"a.obj", "v 0 0 nan\n"},
         ":1: a coordinate of a vertex must be finite and within the range of a double, is 'nan'"},
        {{"a.obj", "v 0 0 1e999\n"},
         ":1: a coordinate of a vertex must be finite and within the range of a double, is '1e999'"},
        {{"a.obj", points + "f 1 2\n"}, ":4: a face needs at least 3 corners, has 2"},
        {{"a.obj", points + "f 1 2 4\n"}, ":4: a face names vertex 4, but the file has 3"},
        {{"a.obj", points + "f 1 2 0\n"}, ":4: a face names vertex 0, but vertices count from 1"},
        {{"a.obj", points + "f 1 2 -4\n"}, ":4: a face names vertex -4, but there are 3 so far"},
        {{"a.obj", points + "f 1 2 4294967297\n"}, ":4: a face names vertex 4294967297, but there are 3 so far"},
        {{"a.obj", points + "f 1 2 99999999999999999999\n"},
         ":4: the vertex of a face must be an integer, is '99999999999999999999'"},
        {{"a.obj", points + "f 1 2 3.5\n"}, ":4: a corner of a face must look like 7, 7/1, 7//3 or 7/1/3, is '3.5'"},
        {{"a.obj", points + "f 1 2 /3\n"}, ":4: the vertex of a face must be an integer, is '/3'"},
    });
}

TEST_CASE("Broken OFF files are refused with file and line", "[mesh_io]") {
    const std::string points = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
    check_messages({
        {{"a.off", "8 12 0\n"}, ":1: an OFF file begins with the word OFF, this one with '8'"},
        {{"a.off", "4OFF\n"}, ":1: OFF files of the kind '4OFF' are not read; OFF, COFF, NOFF and STOFF are"},
        {{"a.off", "OFF\n"}, ":2: the number of vertices is missing"},
        {{"a.off", "OFF\n-3 1 0\n"}, ":2: the number of vertices must not be negative, is -3"},
        {{"a.off", "OFF\n300000000 1 0\n0 0 0\n"}, ":2: the number of vertices is 300000000, but only 11 bytes follow"},
        {{"a.off", "OFF\n1 9000000000000000000 0\n0 0 0\n"},
         ":2: the number of faces is 9000000000000000000, but only 9 bytes follow"},
        {{"a.off", points + "3 0 1 3\n"}, ":6: a face names vertex 3, but the file has 3, counted from 0"},
        {{"a.off", points + "3 0 1 -1\n"}, ":6: a face names vertex -1, but the file has 3, counted from 0"},
        {{"a.off", points + "2 0 1    \n"}, ":6: a face needs at least 3 corners, has 2"},
        {{"a.off", points + "2000000000 0 1 2\n"}, ":7: the vertex of a face is missing"},
        {{"a.off", points + "3 0 1 two\n"}, ":6: the vertex of a face must be an integer, is 'two'"},
    });
}

TEST_CASE("Broken STL files are refused with line or byte", "[mesh_io]") {
    std::string infinite = as_binary_stl(corner_tetrahedron());
    std::string huge;
    put(huge, std::numeric_limits<float>::infinity());
    infinite.replace(84 + 50 + 24, 4, huge);
    check_messages({
        {{"a.stl", "facet normal 0 0 1\n"}, ":1: 'solid' should follow, but here is 'facet'"},
        {{"a.stl", "solid a\nendsolid a\n"}, ": there are no triangles in the file"},
        {{"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nvertex 1 0 0\n"},
         ":5: a coordinate of a vertex must be a number, is 'vertex'"},
        {{"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n"},
         ":5: the word 'vertex' should follow, but here is 'endloop'"},
        {{"a.stl", "solid a\nfacet normal 0 0 1\nouter"},
         ":3: the word 'loop' should follow, but here is the end of the file"},
        {{"a.stl", "solid a\n"}, ":2: the file ends before 'endsolid'"},
        {{"a.stl", as_binary_stl(corner_tetrahedron()).substr(0, 200)},
         ": a binary STL file of 4 triangles takes 284 bytes, this one has 200"},
        {{"a.stl", infinite}, ": byte 158: a coordinate is not finite"},
    });
}

TEST_CASE("Broken PLY headers are refused with file and line", "[mesh_io]") {
    check_messages({
        {{"a.ply", "play\n"}, ":1: a PLY file begins with the word ply"},
        {{"a.ply", ply_start}, ": the header has no line 'end_header'"},
        {{"a.ply", "ply\nend_header\n"}, ":2: the header has no line 'format'"},
        {{"a.ply", "ply\nformat middle_endian 1.0\nend_header\n"},
         ":2: the format must be ascii, binary_little_endian or binary_big_endian, is 'middle_endian'"},
        {{"a.ply", ply_start + "property float x\nend_header\n"}, ":3: a property must follow its element"},
        {{"a.ply", ply_start + "element vertex 3\nproperty real x\nend_header\n"},
         ":4: the type of a property must be one of char, uchar, short, ushort, int, uint, float, double, is 'real'"},
        {{"a.ply", ply_start + "element vertex 3\nproperty list uchar int\nend_header\n"},
         ":4: the name of a property is missing"},
        {{"a.ply", ply_start + "elephant\nend_header\n"},
         ":3: a header line must begin with format, element, property, comment or end_header, not 'elephant'"},
        {{"a.ply", ply_start + "element vertex -3\nend_header\n"},
         ":3: the number of rows of an element must not be negative, is -3"},
        {{"a.ply", ply_start + "element vertex 9000000000000000000\nend_header\n"},
         ":3: element 'vertex' has no number 'x'"},
        {{"a.ply", ply_start + ply_vertices + "element face 1\nproperty int n\nend_header\n" + three_points + "1\n"},
         ":7: element 'face' has no list 'vertex_indices'"},
        {{"a.ply", ply_start + "element vertex 300000000\nproperty float x\nend_header\n0 0\n"},
         ":3: element 'vertex' has no number 'y'"},
        {{"a.ply", ply_start + "element face 2\nproperty int n\nelement vertex 300000000\nproperty float x\n"
                               "property float y\nproperty float z\nend_header\n0 0\n"},
         ":5: element 'vertex' is to have 300000000 rows, but only 5 bytes follow"},
    });
}

TEST_CASE("Broken PLY bodies are refused with line or byte", "[mesh_io]") {
    const std::string start = ply_start + ply_vertices + ply_faces + three_points;  // 12 lines
    const std::string binary = as_binary_ply(corner_tetrahedron(), false);
    std::string bad_index = binary;
    bad_index[binary.size() - 1] = '\x7f';
    std::string bad_number = binary;
    const std::size_t body = binary.size() - 4 * 13 - 4 * 25;
    for (int i = 0; i < 8; ++i) bad_number[body + i] = '\xff';
    const auto byte = [](std::size_t n) { return ": byte " + std::to_string(n); };
    check_messages({
        {{"a.ply", start + "3 0 1 3\n"}, ":13: a face names vertex 3, but the file has 3, counted from 0"},
        {{"a.ply", start + "3 0 1 1.5\n"}, ":13: a face names vertex 1.5, but the file has 3, counted from 0"},
        {{"a.ply", start + "2 0 1\n"}, ":13: a face needs at least 3 corners, has 2"},
        {{"a.ply", start + "-1 0 1\n"}, ":13: the length of a list must be a count"},
        {{"a.ply", start + "1e15 0 1\n"}, ":13: a list goes on past the end of the file"},
        {{"a.ply", start + "3 0 1 x\n"}, ":13: a value must be a number, is 'x'"},
        {{"a.ply", binary.substr(0, binary.size() - 1)},
         byte(binary.size() - 12) + ": a list goes on past the end of the file"},
        {{"a.ply", bad_index},
         byte(binary.size()) + ": a face names vertex 2130706435, but the file has 4, counted from 0"},
        {{"a.ply", bad_number}, byte(body + 25) + ": a coordinate is not finite"},
    });
}
