// Surfaces that are generated from rows of numbers: ElevationGrid and Extrusion.
#include "framework/vrml_files.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace kolize;
using namespace kolize::test;

namespace {

TriangleSoup extrusion(const std::string& fields) { return read_vrml_text(shape("Extrusion { " + fields + " }")); }

// A regular polygon in the plane z = 0, closed by its first point.
std::string ring_spine(int corners, double radius) {
    std::string text = "spine [ ";
    for (int k = 0; k <= corners; ++k) {
        const double angle = 2 * std::numbers::pi * (k % corners) / corners;
        text += words(radius * Vec3(std::cos(angle), std::sin(angle), 0)) + ", ";
    }
    return text + "] ";
}

const std::string square = "crossSection [ .5 .5, .5 -.5, -.5 -.5, -.5 .5, .5 .5 ] ";

bool same_points(const TriangleSoup& a, const TriangleSoup& b) {
    if (a.vertices.size() != b.vertices.size() || a.triangles != b.triangles) return false;
    for (std::size_t v = 0; v < a.vertices.size(); ++v)
        if ((a.vertices[v] - b.vertices[v]).norm() > 1e-12) return false;
    return true;
}

}  // namespace

TEST_CASE("ElevationGrid spans its heights and looks up", "[vrml]") {
    const TriangleSoup soup = read_vrml_text(
        shape("ElevationGrid { xDimension 3 zDimension 2 xSpacing 2 zSpacing 3 height [ 0 1 2, 5 5 -5 ] }"));
    CHECK(soup.triangles.size() == 4);
    CHECK(soup.vertices[2] == Vec3(4, 2, 0));
    CHECK(soup.vertices[4] == Vec3(2, 5, 3));
    for (const Triangle& t : soup.triangles) {
        const Vec3& p = soup.vertices[t[0]];
        CHECK((soup.vertices[t[1]] - p).cross(soup.vertices[t[2]] - p).y() == Approx(6));  // half a cell of 2 x 3
    }
    const TriangleSoup turned =
        read_vrml_text(shape("ElevationGrid { ccw FALSE xDimension 2 zDimension 2 height [ 0 0 0 0 ] }"));
    CHECK((turned.vertices[turned.triangles[0][1]] - turned.vertices[turned.triangles[0][0]])
              .cross(turned.vertices[turned.triangles[0][2]] - turned.vertices[turned.triangles[0][0]])
              .y() == -1);
    CHECK(read_vrml_text(shape("ElevationGrid { xDimension 1 zDimension 2 height [ 1 2 ] }") + shape("Box { }"))
              .triangles.size() == 12);
}

TEST_CASE("Extrusion is a closed box where no field says otherwise", "[vrml]") {
    const TriangleSoup soup = extrusion("");
    CHECK(inspect(soup).closed());
    CHECK(volume(soup) == Approx(4));
    CHECK(bounds(soup).min == Vec3(-1, 0, -1));
    CHECK(bounds(soup).max == Vec3(1, 1, 1));
    CHECK(volume(extrusion("ccw FALSE")) == Approx(-4));
}

TEST_CASE("A straight Extrusion has the volume of its prism in any direction", "[vrml]") {
    for (const std::string end : {"0 3 0", "0 -3 0", "3 0 0", "0 0 -3", "1 2 2", "1e-9 -3 0"}) {
        CAPTURE(end);
        const TriangleSoup soup = extrusion(square + "spine [ 0 0 0, " + end + " ]");
        CHECK(volume(soup) == Approx(3));
        CHECK(inspect(soup).closed());
        const TriangleSoup steps = extrusion(square + "spine [ 0 0 0, 0 0 0, " + end + ", " + end + " ]");
        CHECK(volume(steps) == Approx(3));
    }
}

TEST_CASE("Scale and orientation shape the sections of an Extrusion", "[vrml]") {
    const double pyramid = volume(extrusion("scale [ 1 1, 0 0 ] spine [ 0 0 0, 0 3 0 ]"));
    CHECK(pyramid == Approx(4));
    CHECK(inspect(extrusion("scale [ 0 0, 1 1, 0 0 ] spine [ 0 0 0, 0 3 0, 0 4 0 ]")).closed());
    CHECK(volume(extrusion("scale 2 3")) == Approx(24));
    CHECK(volume(extrusion("orientation [ 0 1 0 1 ]")) == Approx(4));
    CHECK(bounds(extrusion("orientation 0 1 0 .7853981633974483")).max.x() == Approx(std::sqrt(2)));
    // A section that is turned about a spine of one place: a surface of revolution.
    std::string spine = "spine [ ", orientation = "orientation [ ";
    const int steps = 24;
    for (int k = 0; k <= steps; ++k) {
        spine += "0 0 0, ";
        orientation += "0 0 1 " + number_text(k % steps * 2 * std::numbers::pi / steps) + ", ";
    }
    const TriangleSoup ring =
        extrusion("crossSection [ 3 1, 3 -1, 2 -1, 2 1, 3 1 ] " + spine + "] " + orientation + "]");
    CHECK(inspect(ring).closed());
    CHECK(std::abs(volume(ring)) == Approx(0.5 * steps * std::sin(2 * std::numbers::pi / steps) * (9 - 4) * 2));
}

TEST_CASE("An Extrusion along a closed spine is a closed ring without caps", "[vrml]") {
    for (const int corners : {3, 4, 7, 48}) {
        CAPTURE(corners);
        const TriangleSoup soup = extrusion(square + ring_spine(corners, 5));
        CHECK(soup.vertices.size() == 4u * corners);
        CHECK(inspect(soup).closed());
        // The sections stand on the corners of the spine, upright to it: the inner and outer walls are regular
        // polygons.
        const double area = 0.5 * corners * std::sin(2 * std::numbers::pi / corners) * (5.5 * 5.5 - 4.5 * 4.5);
        CHECK(volume(soup) == Approx(area));
    }
    const TriangleSoup capped = extrusion(square + ring_spine(4, 5) + "scale [ 1 1, 1 1, 1 1, 1 1, 2 2 ]");
    CHECK(capped.vertices.size() == 20);  // it comes back with another scale
    CHECK(inspect(capped).closed());
}

TEST_CASE("Straight stretches of a bent spine take the frame of the bend before them", "[vrml]") {
    const TriangleSoup finer = extrusion(square + "spine [ 0 0 0, 0 1 0, 0 2 0, 1 2 0, 2 2 0 ]");
    CHECK(inspect(finer).closed());
    for (std::size_t k = 0; k < 4; ++k) {
        CHECK(finer.vertices[k].y() == Approx(0).margin(1e-15));
        CHECK(finer.vertices[4 + k].y() == Approx(1));
        CHECK(finer.vertices[12 + k].x() == Approx(1));
        CHECK(finer.vertices[16 + k].x() == Approx(2));
    }
    // The bend turns the other way, the frames do not.
    const TriangleSoup wave = extrusion(square + "spine [ 0 0 0, 0 2 0, 2 2 0, 2 4 0 ]");
    CHECK(inspect(wave).closed());
    CHECK(volume(wave) > 0);
    const TriangleSoup nearly = extrusion(square + "spine [ 0 0 0, 0 1 1e-9, 0 2 0, 1 2 0, 2 2 0 ]");
    CHECK((bounds(nearly).max - bounds(finer).max).norm() < 1e-8);
}

TEST_CASE("Caps can be left out, and close an open section where they are not", "[vrml]") {
    const auto triangles = [](const std::string& fields) { return extrusion(fields).triangles.size(); };
    CHECK(triangles("") == 8 + 4);
    CHECK(triangles("beginCap FALSE") == 8 + 2);
    CHECK(triangles("endCap FALSE beginCap FALSE") == 8);
    CHECK(triangles("crossSection [ 1 1, 1 -1, -1 -1, -1 1 ]") == 6 + 4);
    const TriangleSoup concave = extrusion("convex FALSE crossSection [ 0 0, 0 3, 1 3, 1 1, 3 1, 3 0, 0 0 ]");
    CHECK(inspect(concave).closed());
    CHECK(volume(concave) == Approx(5));
    CHECK(surface_area(concave) == Approx(2 * 5 + 12));
}

TEST_CASE("A closed section may be given with one scale and orientation or with one each", "[vrml]") {
    const std::string spine = square + "spine [ 0 0 0, 0 1 0, 1 2 0 ] ";
    CHECK(same_points(extrusion(spine + "scale 2 3 orientation 0 1 0 1"),
                      extrusion(spine + "scale [ 2 3, 2 3, 2 3 ] orientation [ 0 1 0 1, 0 1 0 1, 0 1 0 1 ]")));
}
