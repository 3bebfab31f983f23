// Wavefront OBJ: statements "v" and "f"; all others (texture coordinates, groups, materials, curves ...) say nothing
// about the surface and are passed over.
#include "mesh_io/polygon.h"
#include "mesh_io/scanner.h"

namespace kolize::mesh_io {

namespace {

// One corner of a face: "7", "7/1", "7//3" or "7/1/3". Vertices count from 1, or with negative numbers back from the
// last one so far; positive numbers may name a vertex that follows later.
std::uint32_t read_corner(Scanner& in, std::string_view word, std::size_t vertices_so_far) {
    const std::string_view whole = word;
    const std::int64_t number = in.take_integer(word, "the vertex of a face");
    if (!word.empty() && word[0] != '/')
        in.fail("a corner of a face must look like 7, 7/1, 7//3 or 7/1/3, is " + quoted(whole));
    if (number == 0) in.fail("a face names vertex 0, but vertices count from 1");
    const std::int64_t index = number > 0 ? number - 1 : number + static_cast<std::int64_t>(vertices_so_far);
    if (index < 0 || index >= 0xffffffff)
        in.fail("a face names vertex " + std::to_string(number) + ", but there are " + std::to_string(vertices_so_far) +
                " so far");
    return static_cast<std::uint32_t>(index);
}

void read_face(Scanner& in, std::vector<std::uint32_t>& corners, TriangleSoup& soup) {
    corners.clear();
    const int line = in.line();
    for (std::string_view word = in.word(); !word.empty(); word = in.word())
        corners.push_back(read_corner(in, word, soup.vertices.size()));
    if (corners.size() < 3) in.fail("a face needs at least 3 corners, has " + std::to_string(corners.size()));
    add_polygon(soup.triangles, soup.vertices, corners);
    soup.lines.resize(soup.triangles.size(), line);
}

void require_vertices(const TriangleSoup& soup) {
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        for (const std::uint32_t v : soup.triangles[t])
            if (v >= soup.vertices.size())
                throw Error({soup.file, soup.lines[t]}, "a face names vertex " + std::to_string(v + 1ull) +
                                                            ", but the file has " +
                                                            std::to_string(soup.vertices.size()));
}

}  // namespace

TriangleSoup read_obj(const MeshFile& file) {
    TriangleSoup soup;
    soup.file = file.name;
    std::vector<std::uint32_t> corners;
    Scanner in(file, file.bytes, Layout::continued_lines);
    for (; !in.at_end(); in.skip_line()) {
        const std::string_view statement = in.word();
        if (statement == "v") soup.vertices.push_back(in.point("a coordinate of a vertex"));
        if (statement == "f") read_face(in, corners, soup);
    }
    require_vertices(soup);
    return soup;
}

}  // namespace kolize::mesh_io
