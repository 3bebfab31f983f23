// Object File Format of Geomview: OFF, and COFF, NOFF, STOFF and their combinations, whose further columns (colours,
// normals, texture coordinates) are left out.
#include "mesh_io/polygon.h"
#include "mesh_io/scanner.h"

namespace kolize::mesh_io {

namespace {

// True if vertices carry more than three coordinates each (then one a line).
bool read_header(Scanner& in) {
    const std::string_view magic = in.word();
    std::string_view prefix = magic;
    if (!prefix.ends_with("OFF")) in.fail("an OFF file begins with the word OFF, this one with " + quoted(magic));
    prefix.remove_suffix(3);
    for (const std::string_view column : {"ST", "C", "N"})
        if (prefix.starts_with(column)) prefix.remove_prefix(column.size());
    if (!prefix.empty())
        in.fail("OFF files of the kind " + quoted(magic) + " are not read; OFF, COFF, NOFF and STOFF are");
    return magic != "OFF";
}

// Each row takes at least so many bytes, line break included; the last one may lack it.
std::size_t read_count(Scanner& in, const char* what, std::size_t bytes_per_row) {
    const std::int64_t count = in.integer(what);
    if (count < 0) in.fail(std::string(what) + " must not be negative, is " + std::to_string(count));
    if (static_cast<std::uint64_t>(count) > (in.remaining() + 1) / bytes_per_row)
        in.fail(std::string(what) + " is " + std::to_string(count) + ", but only " + std::to_string(in.remaining()) +
                " bytes follow");
    return static_cast<std::size_t>(count);
}

void read_face(Scanner& in, std::vector<std::uint32_t>& corners, TriangleSoup& soup) {
    const std::int64_t count = in.integer("the number of corners of a face");
    const int line = in.line();
    if (count < 3) in.fail("a face needs at least 3 corners, has " + std::to_string(count));
    corners.clear();
    for (std::int64_t k = 0; k < count; ++k) {
        const std::int64_t v = in.integer("the vertex of a face");
        if (v < 0 || v >= static_cast<std::int64_t>(soup.vertices.size()))
            in.fail("a face names vertex " + std::to_string(v) + ", but the file has " +
                    std::to_string(soup.vertices.size()) + ", counted from 0");
        corners.push_back(static_cast<std::uint32_t>(v));
    }
    in.skip_line();  // the colour of the face
    add_polygon(soup.triangles, soup.vertices, corners);
    soup.lines.resize(soup.triangles.size(), line);
}

}  // namespace

TriangleSoup read_off(const MeshFile& file) {
    TriangleSoup soup;
    soup.file = file.name;
    Scanner in(file, file.bytes, Layout::free_form);
    const bool more_columns = read_header(in);
    const std::size_t vertices = read_count(in, "the number of vertices", 6);
    const std::size_t faces = read_count(in, "the number of faces", 8);
    in.integer("the number of edges");
    soup.vertices.reserve(vertices);
    while (soup.vertices.size() < vertices) {
        soup.vertices.push_back(in.point("a coordinate of a vertex"));
        if (more_columns) in.skip_line();
    }
    std::vector<std::uint32_t> corners;
    for (std::size_t f = 0; f < faces; ++f) read_face(in, corners, soup);
    return soup;
}

}  // namespace kolize::mesh_io
