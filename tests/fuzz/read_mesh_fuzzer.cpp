// libFuzzer's entry to the mesh readers: any bytes end in a sound soup or an Error.
#include "mesh_io/formats.h"

#include <cstdint>
#include <cstdlib>

namespace {

bool is_sound(const kolize::TriangleSoup& soup) {
    for (const kolize::Vec3& v : soup.vertices)
        if (!v.allFinite()) return false;
    for (const kolize::Triangle& t : soup.triangles)
        for (const std::uint32_t v : t)
            if (v >= soup.vertices.size()) return false;
    return !soup.triangles.empty() && (soup.lines.empty() || soup.lines.size() == soup.triangles.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    try {
        // All formats but OBJ are told by their content.
        if (!is_sound(kolize::mesh_io::read_mesh_bytes({"input.obj", bytes}))) std::abort();
    } catch (const kolize::Error&) {
    }
    return 0;
}
