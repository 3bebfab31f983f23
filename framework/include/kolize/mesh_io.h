// Reading triangle meshes: OBJ, OFF, STL (text and binary), PLY (text and binary, both byte orders).
//
// Own small readers: they hold to stated limits (files up to 4 GiB, faces of three corners or more, finite coordinates,
// indices in range), say file:line (or the byte offset in binary files) for anything that is wrong, and never allocate
// more than the file itself can fill. Polygons are cut into triangle fans. STL vertices that are bitwise equal
// are joined. Units and axes are kept as they stand.
#pragma once

#include <kolize/mesh.h>

#include <filesystem>

namespace kolize {

// Chosen by the file's content where it tells (PLY, OFF, STL), else by its extension. A soup has one triangle at least.
// Throws Error.
KOLIZE_API TriangleSoup read_mesh(const std::filesystem::path& file);

// Wavefront OBJ, with the fewest digits that read back to the same bits. Throws Error if the file cannot be written.
KOLIZE_API void write_obj(const TriangleSoup& soup, const std::filesystem::path& file);

}  // namespace kolize
