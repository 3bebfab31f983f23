// Reading and writing triangle meshes: OBJ, OFF, STL (text and binary), PLY (text and binary, both byte orders),
// VRML97.
//
// Own small readers: they hold to stated limits (files up to 4 GiB, faces of three corners or more, finite coordinates,
// indices in range), say file:line (or the byte offset in binary files) for anything that is wrong, and never allocate
// more than the file itself can fill; the few VRML nodes that generate triangles have a limit of their own. Polygons
// are cut into triangle fans, concave ones into ears (those of VRML where the file says so). STL vertices that are
// bitwise equal are joined. Units and axes are kept as they stand.
#pragma once

#include <kolize/mesh.h>

#include <filesystem>

namespace kolize {

// Chosen by the file's content where it tells (PLY, OFF, STL, VRML), else by its extension. A soup has one triangle at
// least. Throws Error.
KOLIZE_API TriangleSoup read_mesh(const std::filesystem::path& file);

// The format is that of the extension: .obj, .off, .stl, .ply (all as text) or .wrl, with the fewest digits that read
// back to the same bits. Only .wrl takes the soup's info with it. Writes beside the file and renames, so that nobody
// sees half a mesh. Throws Error for another extension, or if the file cannot be written.
KOLIZE_API void write_mesh(const TriangleSoup& soup, const std::filesystem::path& file);

}  // namespace kolize
