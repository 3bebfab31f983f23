// Coin as the oracle of the VRML reader. A program of its own: Coin brings global state and X11 with it.
#include "framework/vrml_files.h"
#include "real_models/oracle_readers.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

// The volume between the surface and the origin, signed: that of open surfaces too, however they are cut.
double volume_from_origin(const TriangleSoup& soup) {
    double sum = 0;
    for (const auto& [a, b, c] : soup.triangles)
        sum += soup.vertices[a].dot(soup.vertices[b].cross(soup.vertices[c])) / 6;
    return sum;
}

// Both readers' soups of one text, which begins behind the header.
struct TwoSoups {
    explicit TwoSoups(const std::string& text) {
        const ScratchFolder folder;
        const std::filesystem::path file = folder.write("x.wrl", vrml_header + text);
        ours = read_mesh(file);
        theirs = real_models::read_with_coin(file.string()).soup;
    }

    void check_bounds(double tolerance) const {
        const Aabb a = bounds(ours), b = bounds(theirs);
        const double size = b.half_extents().norm();
        CHECK((a.min - b.min).norm() <= tolerance * size);
        CHECK((a.max - b.max).norm() <= tolerance * size);
    }

    // Where the standard says what the surface is; Coin keeps floats.
    void check_same() const {
        CHECK(ours.triangles.size() == theirs.triangles.size());
        CHECK(volume_from_origin(ours) == Approx(volume_from_origin(theirs)).epsilon(1e-4).margin(1e-4));
        CHECK(surface_area(ours) == Approx(surface_area(theirs)).epsilon(1e-4));
        check_bounds(1e-5);
    }

    TriangleSoup ours, theirs;
};

const std::string ell =
    "IndexedFaceSet { convex FALSE coord DEF C Coordinate { point [ 0 0 0, 3 0 0, 3 1 0, 1 1 0, 1 3 0, 0 3 0,\n"
    " 0 0 1, 3 0 1, 3 1 1, 1 1 1, 1 3 1, 0 3 1 ] }\n"
    " coordIndex [ 5 4 3 2 1 0 -1 6 7 8 9 10 11 -1 0 1 7 6 -1 1 2 8 7 -1 2 3 9 8 -1 3 4 10 9 -1\n"
    "  4 5 11 10 -1 5 0 6 11 ] }";
const std::string placed = "translation 1 2 3 rotation 1 2 3 1 scale 1 -2 .5 scaleOrientation 3 2 1 .7 center 1 0 -1 ";

}  // namespace

TEST_CASE("Coin sees the same face sets and boxes under nested transforms", "[vrml][coin]") {
    const std::string text = "DEF T Transform { " + placed + "children [ DEF S " + shape(ell) +
                             "Transform { translation 5 0 0 scale 2 2 2 children [ USE S " +
                             shape("Box { size 1 2 3 }") +
                             " ] } ] }\nTransform { rotation 0 1 0 -2 children [ USE T USE S ] }\n" +
                             shape("IndexedFaceSet { coord USE C ccw FALSE coordIndex [ 0 1 2, -1, 3 4 5 -1 ] }");
    const TwoSoups soups(text);
    CHECK(soups.ours.triangles.size() == 5 * 20 + 2 * 12 + 2);
    soups.check_same();
}

TEST_CASE("Coin takes the same words for numbers, comments and prototypes", "[vrml][coin]") {
    const TwoSoups soups(
        "# { comment [\nPROTO P [ field SFFloat x 1 ] { Group { } }\nWorldInfo { info \"} \\\" {\" }\n"
        "Viewpoint { position +1 -.5e1 2. }\nShape { appearance Appearance { material Material { } } geometry " +
        ell + "}\nSwitch { whichChoice 1 choice [ Group { } " + shape("Box { size +1 .5E1 1e-1 }") + " ] }\n" +
        "LOD { level [ " + shape("Box { }") + shape("Sphere { }") + " ] }\n");
    soups.check_same();
}

TEST_CASE("Coin makes the same elevation grids", "[vrml][coin]") {
    TwoSoups(
        shape("ElevationGrid { xDimension 4 zDimension 3 xSpacing 2 zSpacing .5 height [ 0 0 0 0 1 1 1 1 0 0 0 0 ] }"))
        .check_same();
}

TEST_CASE("Coin makes the same extrusions", "[vrml][coin]") {
    for (const std::string fields :
         {"", "ccw FALSE", "beginCap FALSE", "endCap FALSE beginCap FALSE", "spine [ 0 0 0, 2 0 0 ]",
          "spine [ 0 0 0, 0 -3 0 ]", "spine [ 0 0 0, 1 2 3 ] scale [ 1 1, 2 3 ]", "orientation [ 0 0 1 .3, 1 0 0 .2 ]",
          "spine [ 0 0 0, 0 3 0, 3 3 0 ]", "spine [ 0 0 0, 0 3 0, 3 3 0, 3 6 0, 3 9 0, 0 9 3 ] scale .5 .5",
          "convex FALSE crossSection [ 0 0, 0 3, 1 3, 1 1, 3 1, 3 0, 0 0 ] spine [ 0 0 0, 0 3 0, 1 5 0 ]",
          "crossSection [ .5 0, 0 -.5, -.5 0, 0 .5, .5 0 ] spine [ 3 0 0, 0 3 0, -3 0 0, 0 -3 0, 3 0 0 ] beginCap "
          "FALSE "
          "endCap FALSE"}) {
        CAPTURE(fields);
        TwoSoups(shape("Extrusion { " + fields + " }")).check_same();
    }
}

TEST_CASE("Round primitives have the bounds of those that Coin makes", "[vrml][coin]") {
    for (const std::string geometry : {"Sphere { radius 2 }", "Cone { bottomRadius 2 height 3 }",
                                       "Cylinder { radius 2 height 3 top FALSE }", "Cone { side FALSE }"}) {
        CAPTURE(geometry);
        TwoSoups(shape(geometry)).check_bounds(0.02);
    }
}
