// Stereolithography: triangles without shared vertices, as text or binary. Normals and attribute words are left out.
#include "mesh_io/scanner.h"
#include "vertex_welder.h"

#include <bit>

namespace kolize::mesh_io {

namespace {

constexpr std::size_t header_size = 84;    // 80 bytes of text and the number of triangles
constexpr std::size_t triangle_size = 50;  // normal, three corners (floats), attribute word

std::uint32_t little_endian(const char* bytes) {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

TriangleSoup read_binary(const MeshFile& file) {
    TriangleSoup soup;
    VertexWelder welder(soup.vertices);
    for (std::size_t at = header_size; at < file.bytes.size(); at += triangle_size) {
        Triangle& triangle = soup.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t corner = at + 12 * (k + 1);  // behind the normal
            Vec3 p;
            for (std::size_t i = 0; i < 3; ++i)
                p[static_cast<int>(i)] = std::bit_cast<float>(little_endian(&file.bytes[corner + 4 * i]));
            if (!p.allFinite()) fail_at_byte(file, corner, "a coordinate is not finite");
            triangle[k] = welder.index_of(p);
        }
    }
    return soup;
}

void expect(Scanner& in, std::string_view keyword) {
    const std::string_view word = in.word();
    if (word == keyword) return;
    in.fail("the word '" + std::string(keyword) + "' should follow, but here is " +
            (word.empty() ? "the end of the file" : quoted(word)));
}

Triangle read_facet(Scanner& in, VertexWelder& welder) {
    expect(in, "normal");
    for (int i = 0; i < 3; ++i) in.word();  // some writers put NaN here
    expect(in, "outer");
    expect(in, "loop");
    Triangle triangle;
    for (std::uint32_t& corner : triangle) {
        expect(in, "vertex");
        corner = welder.index_of(in.point("a coordinate of a vertex"));
    }
    expect(in, "endloop");
    expect(in, "endfacet");
    return triangle;
}

// One or more of: solid NAME, facets, endsolid NAME.
TriangleSoup read_text(const MeshFile& file) {
    TriangleSoup soup;
    VertexWelder welder(soup.vertices);
    Scanner in(file, file.bytes, Layout::free_form);
    bool inside = false;
    for (std::string_view word = in.word(); !word.empty(); word = in.word()) {
        if (word == (inside ? "endsolid" : "solid")) {
            inside = !inside;
            in.skip_line();
        } else if (inside && word == "facet") {
            soup.lines.push_back(in.line());
            soup.triangles.push_back(read_facet(in, welder));
        } else {
            in.fail(std::string(inside ? "'facet' or 'endsolid'" : "'solid'") + " should follow, but here is " +
                    quoted(word));
        }
    }
    if (inside) in.fail("the file ends before 'endsolid'");
    return soup;
}

}  // namespace

bool is_binary_stl(std::string_view bytes) {
    return bytes.size() >= header_size &&
           bytes.size() - header_size == triangle_size * std::size_t{little_endian(&bytes[80])};
}

TriangleSoup read_stl(const MeshFile& file) {
    const bool binary = is_binary_stl(file.bytes);
    if (!binary && file.bytes.find('\0') != std::string_view::npos) {
        const std::size_t count = file.bytes.size() < header_size ? 0 : little_endian(&file.bytes[80]);
        throw Error(SourceLocation{file.name}, "a binary STL file of " + std::to_string(count) + " triangles takes " +
                                                   std::to_string(header_size + triangle_size * count) +
                                                   " bytes, this one has " + std::to_string(file.bytes.size()));
    }
    TriangleSoup soup = binary ? read_binary(file) : read_text(file);
    soup.file = file.name;
    return soup;
}

}  // namespace kolize::mesh_io
