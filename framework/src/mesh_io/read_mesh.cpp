#include <kolize/mesh_io.h>

#include "mesh_io/formats.h"
#include "mesh_io/scanner.h"

#include <charconv>
#include <fstream>

namespace kolize {

namespace mesh_io {

void fail_at_byte(const MeshFile& file, std::size_t byte, const std::string& message) {
    throw Error(file.name + ": byte " + std::to_string(byte) + ": " + message);
}

std::string printable(std::string_view word) {
    constexpr std::size_t longest = 24;
    std::string text(word.substr(0, longest));
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    return word.size() > longest ? text + "..." : text;
}

std::string quoted(std::string_view word) { return std::string("'").append(printable(word)).append("'"); }

std::string shortest_text(double number) {
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, number).ptr};
}

std::string lower_extension(const std::filesystem::path& path) {
    std::string text = path.extension().string();
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

namespace {

using Reader = TriangleSoup (*)(const MeshFile&);

std::string load(const std::filesystem::path& path) {
    const SourceLocation where{path.string()};
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw Error(where, "there is no such file");
    if (std::filesystem::is_directory(status)) throw Error(where, "this is a folder, not a mesh file");
    if (!std::filesystem::is_regular_file(status)) throw Error(where, "this is not a regular file");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (size > 0xffffffff)
        throw Error(where, "the file has " + std::to_string(size) + " bytes; mesh files are read up to 4 GiB");
    if (size == 0) throw Error(where, "the file is empty");
    std::string bytes(size, '\0');
    std::ifstream in(path, std::ios::binary);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) throw Error(where, "the file cannot be read");
    return bytes;
}

// The first word, past comments; empty in a binary file.
std::string_view first_word(const MeshFile& file) {
    const std::string_view start = file.bytes.substr(0, 4096);
    if (start.find('\0') != std::string_view::npos) return {};
    return Scanner(file, start, Layout::free_form).word();
}

Reader reader_by_content(const MeshFile& file) {
    if (file.bytes.starts_with("ply\n") || file.bytes.starts_with("ply\r")) return read_ply;
    if (is_binary_stl(file.bytes)) return read_stl;
    if (file.bytes.starts_with("#VRML") || file.bytes.starts_with("\xef\xbb\xbf#VRML")) return read_vrml;
    if (file.bytes.starts_with("\x1f\x8b"))
        throw Error(SourceLocation{file.name}, "the file is packed by gzip; unpack it first");
    const std::string_view word = first_word(file);
    if (word == "solid") return read_stl;
    if (word.ends_with("OFF")) return read_off;
    return nullptr;
}

Reader reader_by_extension(const std::string& extension) {
    if (extension == ".obj") return read_obj;
    if (extension == ".off") return read_off;
    if (extension == ".ply") return read_ply;
    if (extension == ".stl") return read_stl;
    if (extension == ".wrl") return read_vrml;
    return nullptr;
}

}  // namespace

TriangleSoup read_mesh_bytes(const MeshFile& file) {
    Reader reader = reader_by_content(file);
    if (!reader) reader = reader_by_extension(lower_extension(file.name));
    if (!reader)
        throw Error(SourceLocation{file.name},
                    "this is no mesh file that can be read: OBJ, OFF, STL, PLY and VRML97 are");
    TriangleSoup soup = reader(file);
    if (soup.triangles.empty())
        throw Error(SourceLocation{file.name},
                    "there are no triangles in the file" + (soup.notes.empty() ? "" : " (" + soup.notes[0] + ")"));
    return soup;
}

}  // namespace mesh_io

TriangleSoup read_mesh(const std::filesystem::path& path) {
    const std::string bytes = mesh_io::load(path);
    return mesh_io::read_mesh_bytes({path.string(), bytes});
}

}  // namespace kolize
