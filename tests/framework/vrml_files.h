// VRML97 texts as soups, for the tests of their reader.
#pragma once

#include "framework/mesh_files.h"

#include <kolize/mass_properties.h>
#include <kolize/mesh_io.h>

#include <charconv>

namespace kolize::test {

inline const std::string vrml_header = "#VRML V2.0 utf8\n";

// What read_mesh makes of a file of these bytes; its folder is left out of all names and messages.
inline TriangleSoup read_mesh_bytes(const std::string& name, const std::string& bytes) {
    static const ScratchFolder folder;
    const auto without_folder = [](std::string text) {
        const std::string prefix = folder.path().string() + '/';
        for (std::size_t at; (at = text.find(prefix)) != std::string::npos;) text.erase(at, prefix.size());
        return text;
    };
    try {
        TriangleSoup soup = read_mesh(folder.write(name, bytes));
        soup.file = without_folder(soup.file);
        for (std::string& note : soup.notes) note = without_folder(note);
        return soup;
    } catch (const Error& error) {
        throw Error(without_folder(error.what()));
    }
}

// The file x.wrl that holds the header and this text, which begins in line 2.
inline TriangleSoup read_vrml_text(const std::string& text) { return read_mesh_bytes("x.wrl", vrml_header + text); }

inline std::string shape(const std::string& geometry) { return "Shape { geometry " + geometry + " }\n"; }

inline std::string number_text(double number) {
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, number).ptr};
}

inline double volume(const TriangleSoup& soup) { return mass_properties(soup).volume; }

inline Aabb bounds(const TriangleSoup& soup) {
    Aabb box;
    for (const Triangle& t : soup.triangles)
        for (const std::uint32_t v : t) box.include(soup.vertices[v]);
    return box;
}

}  // namespace kolize::test
