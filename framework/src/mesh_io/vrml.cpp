// VRML97, ISO/IEC 14772-1. Section numbers in comments are those of its node reference.
#include "mesh_io/vrml_drawing.h"
#include "mesh_io/vrml_parser.h"

namespace kolize::mesh_io {

namespace {

void require_header(const MeshFile& file) {
    std::string_view start = file.bytes;
    if (start.starts_with("\xef\xbb\xbf")) start.remove_prefix(3);
    if (start.starts_with("#VRML V2.0")) return;
    const SourceLocation where{file.name, 1};
    if (start.starts_with("#VRML V1.0")) throw Error(where, "this is VRML 1.0; VRML97 is read (#VRML V2.0 utf8)");
    throw Error(where, "a VRML97 file begins with '#VRML V2.0 utf8', this one with " +
                           quoted(start.substr(0, start.find_first_of("\r\n"))));
}

}  // namespace

TriangleSoup read_vrml(const MeshFile& file) {
    require_header(file);
    TriangleSoup soup;
    soup.file = file.name;
    vrml::Parser parser(file);
    vrml::Drawing drawing(soup);
    for (const vrml::Node* root : parser.read_file()) drawing.draw(*root, {});
    soup.info = std::move(parser.info);
    soup.notes = parser.values.notes.sentences(file.name);
    return soup;
}

}  // namespace kolize::mesh_io
