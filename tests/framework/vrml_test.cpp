#include "framework/vrml_files.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

const std::string corner = "coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0, 0 0 1 ] } ";
const std::string tetrahedron = "IndexedFaceSet { " + corner + "coordIndex [ 0 2 1 -1 0 1 3 -1 0 3 2 -1 1 2 3 ] }";
const std::vector<Triangle> tetrahedron_triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

// What numbers the words became.
std::vector<Vec3> points_of(const std::string& numbers) {
    return read_vrml_text(
               shape("IndexedFaceSet { coord Coordinate { point [ " + numbers + " ] } coordIndex [ 0 0 0 ] }"))
        .vertices;
}

}  // namespace

TEST_CASE("A face set gives its points as they stand and a line to each triangle", "[vrml]") {
    const TriangleSoup soup = read_vrml_text(
        "Shape {\n geometry IndexedFaceSet {\n  coordIndex [ 0 2 1 -1\n 0,1,3,-1,0\n 3 2 -1 1 2 3 ]\n  coord "
        "Coordinate {\n"
        "   point [ 0 0 0 1 0 0 0 1 0 0 0 1 ]\n  }\n }\n}");
    CHECK(soup.file == "x.wrl");
    CHECK(soup.triangles == tetrahedron_triangles);
    CHECK(soup.vertices == std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)});
    CHECK(soup.lines == std::vector<int>{4, 5, 5, 6});
    CHECK(soup.notes.empty());
    CHECK(inspect(soup).closed());
}

TEST_CASE("Numbers of VRML take every form of the standard", "[vrml]") {
    CHECK(points_of("+1 .5 1., 1e-3 -.5E+2 -0.25e1\n+.5 1.e2 007") ==
          std::vector<Vec3>{Vec3(1, 0.5, 1), Vec3(1e-3, -50, -2.5), Vec3(0.5, 100, 7)});
    const TriangleSoup soup =
        read_vrml_text(shape("IndexedFaceSet { " + corner + " coordIndex [ 0x0 0X1 0x02 -0x1 +0 +2 3 ] }"));
    CHECK(soup.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("Lines of VRML end with LF, CR or CRLF", "[vrml]") {
    const std::string text = "# a { comment [ \" '\nShape { # another\n\n geometry IndexedFaceSet {\n" + corner +
                             "\ncoordIndex [ 0 1 2 -1\n1 2 3 ] } }\nWorldInfo { info \"two\nlines\" }\nInline { }";
    for (const std::string line_end : {"\n", "\r", "\r\n"}) {
        std::string bytes;
        for (const char c : vrml_header + text) bytes += c == '\n' ? line_end : std::string(1, c);
        const TriangleSoup soup = read_mesh_bytes("x.wrl", bytes);
        CHECK(soup.lines == std::vector<int>{7, 8});
        CHECK(soup.info == std::vector<std::string>{"two" + line_end + "lines"});
        CHECK(soup.notes == std::vector<std::string>{"x.wrl:11: Inline is not used"});
    }
}

TEST_CASE("A VRML file is told by its content, byte order mark or not, and else by its extension", "[vrml]") {
    const std::string bytes = vrml_header + shape("Box { }");
    CHECK(read_mesh_bytes("x.data", bytes).triangles.size() == 12);
    CHECK(read_mesh_bytes("x.obj", "\xef\xbb\xbf" + bytes).triangles.size() == 12);
}

TEST_CASE("DEF names any node and USE repeats it under the transform that it stands in", "[vrml]") {
    const TriangleSoup soup = read_vrml_text(
        "DEF Group.1'\\x Transform { translation 1 0 0 children DEF 2nd Shape { geometry DEF G IndexedFaceSet {\n"
        " coord DEF P Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 ] } } }\n"
        "Transform { translation 0 2 0 children [ USE 2nd Shape { geometry USE G } USE Group.1'\\x ] }\n" +
        shape("IndexedFaceSet { coord USE P coordIndex [ 2 1 0 ] }"));
    const std::vector<Vec3> origins = {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 2, 0), Vec3(1, 2, 0), Vec3(0, 0, 0)};
    REQUIRE(soup.triangles.size() == 5);
    for (std::uint32_t i = 0; i < 5; ++i) CHECK(soup.vertices[3 * i] == origins[i]);
    CHECK(soup.triangles[4] == Triangle{14, 13, 12});
    CHECK(soup.lines == std::vector<int>{3, 3, 3, 3, 5});
}

TEST_CASE("The last DEF of a name counts", "[vrml]") {
    const TriangleSoup soup = read_vrml_text("Switch { whichChoice 9 choice [ DEF A " + shape("Box { }") + " DEF A " +
                                             shape("Box { size 1 1 1 }") + " ] }\nUSE A");
    CHECK(volume(soup) == 1);
}

TEST_CASE("Switch draws its choice, LOD its first level, and other groups all children", "[vrml]") {
    const auto boxes = [](const std::string& node) {
        return read_vrml_text(node + shape("Box { }")).triangles.size() / 12 - 1;
    };
    const std::string two = "[ Group { children [ USE B, USE B ] } USE B ] }";
    const auto with = [&](const std::string& begin) {
        return boxes("Switch { whichChoice 1 choice [ NULL NULL DEF B " + shape("Box { }") + " ] }" + begin + two);
    };
    CHECK(with("Switch { whichChoice 0 choice ") == 2);
    CHECK(with("Switch { choice ") == 2);
    CHECK(with("Switch { whichChoice 1 choice ") == 1);
    CHECK(with("Switch { whichChoice 2 choice ") == 0);
    CHECK(with("LOD { range [ 10 ] level ") == 2);
    for (const std::string group : {"Group", "Anchor", "Billboard", "Collision", "Transform"})
        CHECK(with(group + " { children ") == 3);
    CHECK(boxes("Collision { proxy " + shape("Box { }") + " }") == 0);
}

TEST_CASE("A Switch without a choice is noted", "[vrml]") {
    CHECK(read_vrml_text("Switch { choice " + shape("Box { }") + " }").notes ==
          std::vector<std::string>{"x.wrl:2: Switch without a choice stands for its first one"});
}

TEST_CASE("What has no surface is passed over, with one note for each kind", "[vrml]") {
    const TriangleSoup soup = read_vrml_text(
        "EXTERNPROTO Far [ field SFFloat x eventIn MFNode n ] [ \"far.wrl\" \"b.wrl#Far\" ]\n"
        "PROTO Near [ field MFNode kids [ Box { } ] exposedField SFVec3f p 0 0 0 ] { Transform { translation IS p\n"
        " children [ DEF A Group { children IS kids } USE A ] } ROUTE A.x TO A.y }\n"
        "Near { p 1 2 3 kids [ Far { x 1 } ] } Near { } Far { }\n"
        "DEF Touch TouchSensor { } DEF Time TimeSensor { cycleInterval 1 } Viewpoint { position 0 0 1 }\n"
        "PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 1 1 1 ] }\n"
        "DEF Do Script { url \"javascript: function f() { x = ']'; }\" field SFNode at DEF Inner Group { }\n"
        "  eventIn SFTime now directOutput TRUE }\n"
        "ROUTE Touch.touchTime TO Do.now ROUTE Time . time TO Do . now\n"
        "Inline { url \"x.wrl\" } Inline { } Inline { }\nUSE Inner\n"
        "Shape { appearance Appearance { material DEF M Material { } texture PixelTexture { image 1 2 1 0xFF 0x00 } }\n"
        " geometry Text { string [ \"a\" \"b\" ] fontStyle NULL } }\n" +
        shape("Box { }"));
    CHECK(soup.triangles.size() == 12);
    CHECK(soup.notes ==
          std::vector<std::string>{"x.wrl:2: EXTERNPROTO is not used", "x.wrl:3: PROTO is not used",
                                   "x.wrl:5: instances of PROTO Far are not used",
                                   "x.wrl:5: instances of PROTO Near are not used", "x.wrl:6: 2 sensors are not used",
                                   "x.wrl:7: PositionInterpolator is not used", "x.wrl:8: Script is not used",
                                   "x.wrl:10: 2 ROUTE statements are not used", "x.wrl:11: 3 Inline nodes are not used",
                                   "x.wrl:12: USE Inner names a node that is not used", "x.wrl:14: Text is not used"});
}

TEST_CASE("A PROTO hides the node of its name", "[vrml]") {
    CHECK(
        read_vrml_text("PROTO Sphere [ ] { Group { } }\n" + shape("Sphere { }") + shape("Box { }")).triangles.size() ==
        12);
}

TEST_CASE("Unknown fields are skipped whatever their values are", "[vrml]") {
    const std::string fields =
        "n 1 s \"} \\\" {\" t TRUE f FALSE v -1 .5 1e3 image 2 1 3 0xFF00FF 0x1 l [ 1 [ { } ] \"]\" ] e [ ] z NULL\n"
        "u USE nothing w word k Node { k Node { } } d DEF D Node { a [ B { } C { c [ ] } ] } is IS other ";
    const TriangleSoup soup =
        read_vrml_text("Transform { " + fields + "children [ Shape { " + fields + "geometry Box { " + fields +
                       "size 1 2 3 " + fields + "} } ] " + fields + "translation 1 0 0 }");
    CHECK(soup.triangles.size() == 12);
    CHECK(bounds(soup).max == Vec3(1.5, 1, 1.5));
}

TEST_CASE("The info of WorldInfo comes with the soup, its title does not", "[vrml]") {
    const TriangleSoup soup = read_vrml_text(
        "WorldInfo { title \"no\" info [ \"a \\\"b\\\"\", \"\\\\ \\n # {\" \"\" ] }\nGroup { children WorldInfo { info "
        "\"last\" } }\n" +
        shape("Box { }"));
    CHECK(soup.info == std::vector<std::string>{"a \"b\"", "\\ \\n # {", "", "last"});
}

TEST_CASE("A face set without points has no faces", "[vrml]") {
    for (const std::string coord : {"", "coord NULL", "coord Other { }"}) {
        const std::string set = "IndexedFaceSet { coordIndex [ 0 1 2 -1 ] " + coord + " }";
        CHECK(read_vrml_text(shape(set) + shape("Box { }")).triangles.size() == 12);
    }
}

TEST_CASE("Faces of fewer than three corners are passed over with a note", "[vrml]") {
    const TriangleSoup soup =
        read_vrml_text(shape("IndexedFaceSet { " + corner + " coordIndex [ -1 -1 0 1 -1 2 -1\n 0 1 2 -1 -1 ] }"));
    CHECK(soup.triangles == std::vector<Triangle>{{0, 1, 2}});
    CHECK(soup.notes == std::vector<std::string>{"x.wrl:2: a face of fewer than 3 corners is not used"});
}

TEST_CASE("Faces turn over with ccw FALSE, and once more with a mirror", "[vrml]") {
    const std::string inward = "IndexedFaceSet { ccw FALSE" + tetrahedron.substr(16);
    CHECK(volume(read_vrml_text(shape(tetrahedron))) == Approx(1.0 / 6));
    CHECK(volume(read_vrml_text(shape(inward))) == Approx(-1.0 / 6));
    const auto scaled = [&](const std::string& scale, const std::string& geometry) {
        return volume(read_vrml_text("Transform { scale " + scale + " children " + shape(geometry) + " }"));
    };
    CHECK(scaled("-1 1 1", tetrahedron) == Approx(1.0 / 6));
    CHECK(scaled("-1 -2 1", tetrahedron) == Approx(2.0 / 6));
    CHECK(scaled("-1 -2 -3", tetrahedron) == Approx(1));
    CHECK(scaled("1 1 -3", inward) == Approx(-0.5));
}
