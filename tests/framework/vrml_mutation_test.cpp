// Every file that a fault can make of a good VRML file must end in a soup that keeps its promises, or in an Error.
#include "framework/mesh_mutations.h"
#include "framework/vrml_files.h"

using namespace kolize;
using namespace kolize::test;

namespace {

// Every node and statement that the reader knows, and some of those that it skips.
const std::string rich =
    "#VRML V2.0 utf8\n"
    "WorldInfo { title \"t\" info [ \"a \\\"b\\\" \\\\\" \"c\" ] }\n"
    "PROTO P [ field SFVec3f p 0 0 0 ] { Transform { translation IS p } }\nEXTERNPROTO Q [ ] [ \"q.wrl\" ]\n"
    "DEF T Transform { translation 1 2 3 rotation 0 0 1 .5 scale -1 1 2 scaleOrientation 1 0 0 1 center 1 1 1\n"
    " children [ Shape { appearance Appearance { material DEF M Material { } } geometry DEF F IndexedFaceSet {\n"
    "  convex FALSE ccw FALSE coord DEF C Coordinate { point [ 0 0 0, 2 0 0, 2 1 0, 1 1 0, 1 2 0, 0 2 0, 0 0 0 ] }\n"
    "  coordIndex [ 0 1 2 3 4 5 -1 0 2 1 ] color NULL } } P { p 1 2 3 } DEF S TouchSensor { } ] }\n"
    "ROUTE S.touchTime TO T.set_scale\n"
    "Switch { whichChoice 1 choice [ NULL Group { children [ USE T, USE T ] } ] }\n"
    "LOD { level [ Shape { geometry USE F } ] } Inline { url \"x.wrl\" }\n"
    "Collision { proxy USE T children Shape { geometry Cone { bottom FALSE height 3 } } }\n"
    "Shape { geometry Box { size 1 2 3 } }\nShape { geometry ElevationGrid { xDimension 2 zDimension 0x2 height [ 0 1 "
    "2 3 ] } }\n"
    "Shape { geometry Extrusion { convex FALSE crossSection [ 1 0, 0 -1, -1 0, 0 1, 1 0 ] scale [ 1 2 ]\n"
    "  spine [ 0 0 0, 0 1 0, 1 2 0, 0 0 0 ] orientation [ 0 1 0 .1 ] endCap FALSE } }\n"
    "Shape { geometry Sphere { radius .5 } }\nShape { geometry Cylinder { top FALSE } }\n"
    "Shape { geometry IndexedFaceSet { coord USE C coordIndex [ 5 4 3 -1 ] } }\n";

struct Outcome {
    std::size_t soups = 0, errors = 0;

    void read(const std::string& bytes) {
        try {
            check_promises(read_mesh_bytes("x.wrl", bytes));
            ++soups;
        } catch (const Error& error) {
            ++errors;
            REQUIRE(std::string(error.what()).starts_with("x.wrl:"));
        }
    }
};

}  // namespace

TEST_CASE("VRML files with random faults end in a sound soup or an error that names the file", "[vrml]") {
    std::mt19937 random(1147);
    Outcome outcome;
    for (int i = 0; i < 4000; ++i) {
        CAPTURE(i);
        outcome.read(mutated(rich, random));
    }
    CHECK(outcome.soups > 100);    // the faults leave some files readable
    CHECK(outcome.errors > 1000);  // and break others
}

TEST_CASE("A VRML file that is cut off anywhere ends in a sound soup or an error", "[vrml]") {
    Outcome outcome;
    for (std::size_t size = 1; size < rich.size(); ++size) {
        CAPTURE(size);
        outcome.read(rich.substr(0, size));
    }
    CHECK(outcome.soups > 0);
    CHECK(outcome.errors > rich.size() / 2);
}
