#include "framework/vrml_files.h"

#include <catch2/catch.hpp>

#include <random>

using namespace kolize;
using namespace kolize::test;

namespace {

// Of the file x.wrl, behind its name.
std::string message_of_file(const std::string& bytes) {
    try {
        read_mesh_bytes("x.wrl", bytes);
    } catch (const Error& error) {
        return std::string(error.what()).substr(5);
    }
    return "no error";
}

// The text begins in line 2.
std::string message_of(const std::string& text) { return message_of_file(vrml_header + text); }

std::string repeated(const std::string& text, int times) {
    std::string result;
    for (int i = 0; i < times; ++i) result += text;
    return result;
}

const std::string point = "coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } ";

std::string face_set(const std::string& fields) { return shape("\nIndexedFaceSet {\n" + point + fields + " }"); }

// Twice the one before, and again, from this node on.
std::string doubled(const std::string& node, int times) {
    std::string text = "DEF A0 " + node + "\n";
    for (int i = 1; i <= times; ++i) {
        const std::string use = "USE A" + std::to_string(i - 1) + " ";
        text += "DEF A" + std::to_string(i) + " Group { children [ " + use + use + "] }\n";
    }
    return text;
}

}  // namespace

TEST_CASE("What is no VRML97 is said in one sentence", "[vrml]") {
    CHECK(message_of_file("#VRML V1.0 ascii\nCube { }\n") == ":1: this is VRML 1.0; VRML97 is read (#VRML V2.0 utf8)");
    CHECK(message_of_file("#X3D V3.0 utf8\nGroup { }\n") ==
          ":1: a VRML97 file begins with '#VRML V2.0 utf8', this one with '#X3D V3.0 utf8'");
    CHECK(message_of_file("\x1f\x8b\x08 rest") == ": the file is packed by gzip; unpack it first");
    CHECK(message_of_file("\xff\xfejunk") ==
          ":1: a VRML97 file begins with '#VRML V2.0 utf8', this one with '\?\?junk'");
    CHECK(message_of(std::string("Group {\0}", 9)) == ": there is a zero byte in what should be text");
    CHECK(message_of("Group { }") == ": there are no triangles in the file");
    CHECK(message_of("Inline { }") == ": there are no triangles in the file (x.wrl:2: Inline is not used)");
}

TEST_CASE("A VRML file that ends too early is refused with the node that it ends in", "[vrml]") {
    CHECK(message_of("Group {\n children [\n") == ":4: the file ends inside Group, which begins in line 2");
    CHECK(message_of("Group {\n children [\n Shape {") == ":4: the file ends inside Shape, which begins in line 4");
    CHECK(message_of("Group { } Inline {\n a {") == ":3: the file ends inside Inline, which begins in line 2");
    CHECK(message_of("Shape { geometry Box { size 1 2") == ":2: the file ends inside Box, which begins in line 2");
    CHECK(message_of("Shape { geometry Box { foo") == ":2: the file ends inside Box, which begins in line 2");
    CHECK(message_of("DEF") == ":2: the file ends in the middle of a statement");
    CHECK(message_of("PROTO x [ ]") == ":2: the file ends in the middle of a statement");
    CHECK(message_of("Group { }\nWorldInfo { info \"a\n\\\"") == ":3: the string that begins here has no end");
}

TEST_CASE("Broken VRML structure is refused with file and line", "[vrml]") {
    CHECK(message_of("}") == ":2: a node should follow, but here is '}'");
    CHECK(message_of("Group {\n ] }") == ":3: a field of Group or its '}' should follow, but here is ']'");
    CHECK(message_of("Group [ ]") == ":2: '{' of Group should follow, but here is '['");
    CHECK(message_of("Group { children \"x\" }") == ":2: a node should follow, but here is the string 'x'");
    CHECK(message_of("Unknown { a [ }") == ":2: ']' should follow, but here is '}'");
    CHECK(message_of("Group { other } }") == ":2: the value of other in Group should follow, but here is '}'");
    CHECK(message_of("ROUTE a.b FROM c.d") == ":2: the word TO of a ROUTE should follow, but here is 'FROM'");
    CHECK(message_of("PROTO { }") == ":2: the name of a PROTO should follow, but here is '{'");
    CHECK(message_of("EXTERNPROTO a [ ] b") == ":2: the address of an EXTERNPROTO should follow, but here is 'b'");
    CHECK(message_of("Group { children Box { } }") == ":2: Box stands where a node such as Shape or Transform should");
    CHECK(message_of("Shape { geometry Shape { } }") == ":2: Shape stands where a geometry such as Box should");
    CHECK(message_of(shape("IndexedFaceSet { coord Box { } }")) == ":2: Box stands where a Coordinate should");
}

TEST_CASE("Broken DEF and USE are refused with file and line", "[vrml]") {
    CHECK(message_of("Group { }\nUSE A DEF A Group { }") == ":3: USE A names a node that no DEF before it does");
    CHECK(message_of("PROTO P [ ] { DEF A Group { } } USE A") == ":2: USE A names a node that no DEF before it does");
    CHECK(message_of("DEF A Group { children\n USE A }") == ":3: USE A stands inside the node of this name");
    CHECK(message_of("DEF A Group { } Shape { geometry USE A }") ==
          ":2: Group stands where a geometry such as Box should");
}

TEST_CASE("Broken VRML values are refused with file and line", "[vrml]") {
    CHECK(message_of(shape("Box {\nsize 1 2 x }")) == ":3: size in Box must be a number, is 'x'");
    CHECK(message_of(shape("Box { size 1 2 }")) == ":2: size in Box must be a number, is '}'");
    CHECK(message_of(shape("Sphere { radius 0x10 }")) == ":2: radius in Sphere must be a number, is '0x10'");
    CHECK(message_of(shape("Sphere { radius 0 }")) == ":2: radius in Sphere must be positive, is 0");
    CHECK(message_of(shape("Sphere { radius nan }")) ==
          ":2: radius in Sphere must be finite and within the range of a double, is 'nan'");
    CHECK(message_of(shape("Cone { height 1e999 }")) ==
          ":2: height in Cone must be finite and within the range of a double, is '1e999'");
    CHECK(message_of(shape("Cone { side true }")) == ":2: side in Cone must be TRUE or FALSE, is 'true'");
    CHECK(message_of("WorldInfo { info [ \"a\"\n b ] }") == ":3: info in WorldInfo must be a string in quotes, is 'b'");
    CHECK(message_of("Switch { whichChoice 1.5 }") ==
          ":2: whichChoice in Switch must be an integer of 32 bits, is '1.5'");
    CHECK(message_of("Switch { whichChoice 2147483648 }") ==
          ":2: whichChoice in Switch must be an integer of 32 bits, is '2147483648'");
    CHECK(message_of("Transform { scale 1e200 1 1 children Transform { scale 1e200 1 1 children\n" + shape("Box { }") +
                     "} }") == ":3: a coordinate is too large for a double where this node is placed");
}

TEST_CASE("Broken face sets are refused with the line of the face", "[vrml]") {
    CHECK(message_of(face_set("coordIndex [ 0 1 2 -1\n 0 1 3 ]")) ==
          ":5: a face names point 3, but its Coordinate has 3, counted from 0");
    CHECK(message_of(face_set("coordIndex [ 0 1 2\n -2 ]")) ==
          ":5: coordIndex must be a point, counted from 0, or -1 behind a face, is -2");
    CHECK(message_of(face_set("coordIndex [ 0 1 2 3.5 ]")) ==
          ":4: coordIndex in IndexedFaceSet must be an integer of 32 bits, is '3.5'");
    CHECK(message_of(face_set("convex FALSE coordIndex [ " + repeated("0 1 2 ", 6667) + "]")) ==
          ":4: a face that may be concave has 20001 corners; 20000 are the most");
}

TEST_CASE("Broken generated surfaces are refused with the line of the node", "[vrml]") {
    const auto grid = [](const std::string& fields) { return message_of(shape("ElevationGrid { " + fields + " }")); };
    CHECK(grid("xDimension 2 zDimension 3 height [ 1 2 3 4 5 ]") == ":2: ElevationGrid of 2 x 3 points has 5 heights");
    CHECK(grid("xDimension 2147483647 zDimension 2147483647") ==
          ":2: ElevationGrid of 2147483647 x 2147483647 points has 0 heights");
    CHECK(grid("xDimension -2") == ":2: a dimension must not be negative, is -2");
    const auto extrusion = [](const std::string& fields) { return message_of(shape("Extrusion { " + fields + " }")); };
    CHECK(extrusion("spine [ 0 0 0 ]") == ":2: Extrusion needs a spine of 2 points or more, has 1");
    CHECK(extrusion("crossSection [ ]") == ":2: Extrusion needs a crossSection of 2 points or more, has 0");
    CHECK(extrusion("spine [ 0 0 0, 0 1 0, 0 2 0 ] scale [ 1 1, 2 2 ]") ==
          ":2: Extrusion with 3 points of the spine has 2 values of scale, but needs 1 or as many");
    CHECK(extrusion("orientation [ ]") ==
          ":2: Extrusion with 2 points of the spine has 0 values of orientation, but needs 1 or as many");
    CHECK(extrusion("scale 1 -1") == ":2: Extrusion has a negative scale");
    CHECK(extrusion("crossSection [ " + repeated("0 1 2 0 ", 2001) + "] spine [ " + repeated("0 1 2 ", 2500) + "]") ==
          ":2: Extrusion has more than 20000000 triangles");
}

TEST_CASE("Nodes that stand in one another too deep are refused, by USE as well", "[vrml]") {
    const auto nested = [](int depth, const std::string& inner) {
        return repeated("Group { children\n", depth) + inner + repeated(" }", depth);
    };
    const std::string too_deep = "nodes stand in one another more than 200 deep";
    CHECK(read_vrml_text(nested(198, shape("Box { }"))).triangles.size() == 12);
    CHECK(message_of(nested(199, shape("Box { }"))) == ":201: " + too_deep);
    CHECK(message_of("DEF A " + nested(100, "NULL") + nested(101, "USE A")) == ":203: " + too_deep);
    CHECK(message_of(repeated("Other { a [ ", 100000)) == ":2: the file ends inside Other, which begins in line 2");
}

TEST_CASE("Short files that stand for huge scenes are refused", "[vrml]") {
    const std::string faces = repeated("0 1 2 -1 ", 20000);
    CHECK(message_of(doubled(shape("IndexedFaceSet { " + point + "coordIndex [ " + faces + " ] }"), 10)) ==
          ":2: with all its USEs the file has more than 20000000 triangles or vertices");
    CHECK(message_of(doubled("Group { }", 40)).ends_with("the file has more than 10000000 nodes"));
}

TEST_CASE("A file of many odd names is told in few notes", "[vrml]") {
    std::string text = shape("Box { }");
    for (int i = 0; i < 1000; ++i) text += "Odd" + std::to_string(i) + " { }\n";
    const TriangleSoup soup = read_vrml_text(text);
    CHECK(soup.notes.size() == 101);
    CHECK(soup.notes.back() == "x.wrl:103: 900 other things are not used");
}
