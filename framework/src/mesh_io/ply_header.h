// The header of a PLY file: which elements with which properties its body holds.
#pragma once

#include "mesh_io/formats.h"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace kolize::mesh_io {

enum class PlyScalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
    std::string_view name;
    PlyScalar type = PlyScalar::float32;
    std::optional<PlyScalar> count;  // type of the length of a list; none: not a list
};

struct PlyElement {
    std::string_view name;
    std::uint64_t count = 0;  // rows
    std::vector<PlyProperty> properties;
    int line = 0;  // of the header

    // Throws Error, naming the line, if the element has no such list (or number).
    std::size_t require_property(const MeshFile& file, std::string_view name, bool list) const;
};

enum class PlyEncoding { text, little_endian, big_endian };

struct PlyHeader {
    std::optional<PlyEncoding> encoding;  // set once the header is read
    std::vector<PlyElement> elements;
    std::string_view body;
    int body_line = 1;
};

PlyHeader read_ply_header(const MeshFile& file);

}  // namespace kolize::mesh_io
