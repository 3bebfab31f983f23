// The readers behind read_mesh, and the limits they share.
#pragma once

#include <kolize/mesh.h>

#include <filesystem>
#include <string_view>

namespace kolize::mesh_io {

// A file held in memory; at most 4 GiB, so that 32 bits number anything that it can hold.
struct MeshFile {
    std::string name;  // as the user gave it
    std::string_view bytes;
};

// Each throws Error for the first thing that is wrong.
TriangleSoup read_obj(const MeshFile& file);
TriangleSoup read_off(const MeshFile& file);
TriangleSoup read_ply(const MeshFile& file);
TriangleSoup read_stl(const MeshFile& file);
TriangleSoup read_vrml(const MeshFile& file);

// Chooses the reader as read_mesh does.
TriangleSoup read_mesh_bytes(const MeshFile& file);

// Whether the size is the one that the count in the header asks for. Text files never pass, whatever they begin with,
// and binary ones do even if they begin with "solid", as some do.
bool is_binary_stl(std::string_view bytes);

// "file: byte N: message"; bytes count from 0.
[[noreturn]] void fail_at_byte(const MeshFile& file, std::size_t byte, const std::string& message);

// A word as it can stand in a message: printable and short; the second in quotes.
std::string printable(std::string_view word);
std::string quoted(std::string_view word);

// Of a file name, dot and all, in lower case.
std::string lower_extension(const std::filesystem::path& path);

// The fewest digits that read back to the same bits.
std::string shortest_text(double number);

}  // namespace kolize::mesh_io
