// Every format as text, with the fewest digits that read back to the same bits.
#include "mesh_io/formats.h"
#include "triangle_sides.h"

#include <kolize/mesh_io.h>

#include <fstream>

#include <unistd.h>

namespace kolize {

namespace mesh_io {

namespace {

using Writer = std::string (*)(const TriangleSoup&);

std::string words(const Vec3& p) {
    return shortest_text(p.x()) + ' ' + shortest_text(p.y()) + ' ' + shortest_text(p.z());
}

std::string words(const Triangle& t, std::uint32_t first = 0) {
    std::string text;
    for (const std::uint32_t v : t) text.append(text.empty() ? "" : " ").append(std::to_string(std::size_t{v} + first));
    return text;
}

std::string as_obj(const TriangleSoup& soup) {
    std::string text;
    for (const Vec3& v : soup.vertices) text += "v " + words(v) + '\n';
    for (const Triangle& t : soup.triangles) text += "f " + words(t, 1) + '\n';
    return text;
}

// What OFF and PLY have in common.
std::string rows(const TriangleSoup& soup) {
    std::string text;
    for (const Vec3& v : soup.vertices) text += words(v) + '\n';
    for (const Triangle& t : soup.triangles) text += "3 " + words(t) + '\n';
    return text;
}

std::string as_off(const TriangleSoup& soup) {
    return "OFF\n" + std::to_string(soup.vertices.size()) + ' ' + std::to_string(soup.triangles.size()) + " 0\n" +
           rows(soup);
}

std::string as_ply(const TriangleSoup& soup) {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(soup.vertices.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
           std::to_string(soup.triangles.size()) + "\nproperty list uchar uint vertex_indices\nend_header\n" +
           rows(soup);
}

// Unit, or zero for a triangle without area, or with one too large for a double.
Vec3 normal(const TriangleSoup& soup, const Triangle& t) {
    const Vec3 normal = unit_normal(soup, t);
    return normal.allFinite() ? normal : Vec3::Zero();
}

std::string as_stl(const TriangleSoup& soup) {
    std::string text = "solid kolize\n";
    for (const Triangle& t : soup.triangles) {
        text += "facet normal " + words(normal(soup, t)) + "\nouter loop\n";
        for (const std::uint32_t v : t) text += "vertex " + words(soup.vertices[v]) + '\n';
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid kolize\n";
}

std::string in_quotes(const std::string& words) {
    std::string text = "\"";
    for (const char c : words) {
        if (c == '"' || c == '\\') text += '\\';
        text += c;
    }
    return text + '"';
}

std::string as_vrml(const TriangleSoup& soup) {
    std::string text = "#VRML V2.0 utf8\n";
    if (!soup.info.empty()) {
        text += "WorldInfo {\n  info [\n";
        for (const std::string& line : soup.info) text += "    " + in_quotes(line) + '\n';
        text += "  ]\n}\n";
    }
    text += "Shape {\n  geometry IndexedFaceSet {\n    solid FALSE\n    coord Coordinate {\n      point [\n";
    for (const Vec3& v : soup.vertices) text += words(v) + '\n';
    text += "      ]\n    }\n    coordIndex [\n";
    for (const Triangle& t : soup.triangles) text += words(t) + " -1\n";
    return text + "    ]\n  }\n}\n";
}

Writer writer_for(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".obj") return as_obj;
    if (extension == ".off") return as_off;
    if (extension == ".ply") return as_ply;
    if (extension == ".stl") return as_stl;
    if (extension == ".wrl") return as_vrml;
    throw Error(SourceLocation{file.string()},
                "a mesh is written to a file that ends in .obj, .off, .ply, .stl or .wrl");
}

// Beside the file, so that it can be renamed; the process number keeps two programs apart.
std::filesystem::path temporary_name(const std::filesystem::path& file) {
    return file.string() + ".part" + std::to_string(getpid());
}

void write_whole(const std::filesystem::path& file, const std::string& text) {
    const std::filesystem::path part = temporary_name(file);
    std::ofstream out(part, std::ios::binary);
    const bool written = out.write(text.data(), static_cast<std::streamsize>(text.size())).flush().good();
    out.close();
    std::error_code error;
    if (written && out) std::filesystem::rename(part, file, error);
    if (written && out && !error) return;
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw Error(SourceLocation{file.string()}, "the mesh cannot be written to this file");
}

}  // namespace

}  // namespace mesh_io

void write_mesh(const TriangleSoup& soup, const std::filesystem::path& file) {
    const auto as_text = mesh_io::writer_for(file);
    mesh_io::write_whole(file, as_text(soup));
}

}  // namespace kolize
