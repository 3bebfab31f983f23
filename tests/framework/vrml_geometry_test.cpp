#include "framework/vrml_files.h"

#include <catch2/catch.hpp>

#include <map>
#include <numbers>
#include <random>

using namespace kolize;
using namespace kolize::test;

namespace {

constexpr double pi = std::numbers::pi;
constexpr int sides = 64;   // of round primitives
constexpr int layers = 32;  // of a sphere

// The area of a regular polygon in a circle of this radius.
double polygon_area(double radius) { return 0.5 * sides * std::sin(2 * pi / sides) * radius * radius; }

double frustum_volume(double bottom_radius, double top_radius, double height) {
    const double bottom = polygon_area(bottom_radius), top = polygon_area(top_radius);
    return height / 3 * (bottom + top + std::sqrt(bottom * top));
}

struct RandomTransform {
    std::string fields;
    Eigen::Matrix4d matrix;
};

Eigen::Matrix4d rotation_matrix(const Vec3& axis, double angle) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    return matrix;
}

Eigen::Matrix4d translation_matrix(const Vec3& v) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topRightCorner<3, 1>() = v;
    return matrix;
}

// P' = T C R SR S -SR -C P, matrix by matrix.
RandomTransform random_transform(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-2, 2);
    const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
    const Vec3 translation = vector(), center = vector(), axis = vector(), scale_axis = vector(), scale = vector();
    const double angle = any(random), scale_angle = any(random);
    const std::string fields = "translation " + words(translation) + " center " + words(center) + " rotation " +
                               words(axis) + ' ' + number_text(angle) + " scale " + words(scale) +
                               " scaleOrientation " + words(scale_axis) + ' ' + number_text(scale_angle);
    Eigen::Matrix4d scaling = Eigen::Matrix4d::Identity();
    scaling.diagonal().head<3>() = scale;
    return {fields, translation_matrix(translation) * translation_matrix(center) * rotation_matrix(axis, angle) *
                        rotation_matrix(scale_axis, scale_angle) * scaling * rotation_matrix(scale_axis, -scale_angle) *
                        translation_matrix(-center)};
}

std::string face_set(const std::vector<Vec3>& points, const std::string& faces, const std::string& fields = "") {
    std::string text = "IndexedFaceSet { " + fields + " coordIndex [ " + faces + " ] coord Coordinate { point [ ";
    for (const Vec3& p : points) text += words(p) + ", ";
    return text + "] } }";
}

// A prism over a polygon of the plane z = 0, with concave caps.
TriangleSoup prism(const std::vector<Vec3>& polygon, double height) {
    std::vector<Vec3> points = polygon;
    for (const Vec3& p : polygon) points.push_back(p + Vec3(0, 0, height));
    const std::size_t n = polygon.size();
    std::string top, bottom, walls;
    for (std::size_t k = 0; k < n; ++k) {
        top += std::to_string(n + k) + ' ';
        bottom += std::to_string(n - 1 - k) + ' ';
        for (const std::size_t v : {k, (k + 1) % n, (k + 1) % n + n, k + n}) walls += std::to_string(v) + ' ';
        walls += "-1 ";
    }
    return read_vrml_text(shape(face_set(points, top + "-1 " + bottom + "-1 " + walls, "convex FALSE")));
}

}  // namespace

TEST_CASE("Box is a closed cuboid of its size", "[vrml]") {
    const TriangleSoup soup = read_vrml_text(shape("Box { size 1 2 4 }"));
    CHECK(inspect(soup).closed());
    CHECK(volume(soup) == 8);
    CHECK(bounds(soup).max == Vec3(0.5, 1, 2));
    CHECK(volume(read_vrml_text(shape("Box { }"))) == 8);
}

TEST_CASE("Round primitives are closed inscribed polyhedra", "[vrml]") {
    const TriangleSoup cylinder = read_vrml_text(shape("Cylinder { radius 2 height 3 }"));
    const TriangleSoup cone = read_vrml_text(shape("Cone { bottomRadius 2 height 3 }"));
    const TriangleSoup sphere = read_vrml_text(shape("Sphere { radius 2 }"));
    CHECK(volume(cylinder) == Approx(polygon_area(2) * 3).epsilon(1e-12));
    CHECK(volume(cone) == Approx(polygon_area(2)).epsilon(1e-12));
    double layered = 0;
    for (int k = 0; k < layers; ++k)
        layered += frustum_volume(2 * std::sin(pi * k / layers), 2 * std::sin(pi * (k + 1) / layers),
                                  2 * std::cos(pi * k / layers) - 2 * std::cos(pi * (k + 1) / layers));
    CHECK(volume(sphere) == Approx(layered).epsilon(1e-12));
    CHECK(volume(sphere) == Approx(32 * pi / 3).epsilon(5e-3));
    for (const TriangleSoup& soup : {cylinder, cone, sphere}) {
        CHECK(inspect(soup).closed());
        CHECK(bounds(soup).max.x() == Approx(2));
        CHECK(bounds(soup).min.z() == Approx(-2));
    }
    for (const Vec3& v : sphere.vertices) CHECK(v.norm() == Approx(2).epsilon(1e-14));
    CHECK(bounds(cone).max.y() == 1.5);
    CHECK(cone.notes == std::vector<std::string>{"x.wrl:2: Cone stands for an inscribed polyhedron, 64 sides around"});
}

TEST_CASE("Parts of cones and cylinders can be left out", "[vrml]") {
    const auto area = [](const std::string& geometry) { return surface_area(read_vrml_text(shape(geometry))); };
    const double disk = polygon_area(1), chord = 2 * std::sin(pi / sides), apothem = std::cos(pi / sides);
    const double wall = sides * chord * 2, slope = sides * chord / 2 * std::hypot(2, apothem);
    CHECK(area("Cylinder { top FALSE }") == Approx(wall + disk));
    CHECK(area("Cylinder { bottom FALSE }") == Approx(wall + disk));
    CHECK(area("Cylinder { side FALSE }") == Approx(2 * disk));
    CHECK(area("Cone { bottom FALSE }") == Approx(slope));
    CHECK(area("Cone { side FALSE }") == Approx(disk));
}

TEST_CASE("Nested transforms move points as the product of their matrices does", "[vrml]") {
    std::mt19937 random(20);
    for (int i = 0; i < 50; ++i) {
        CAPTURE(i);
        const RandomTransform outer = random_transform(random), inner = random_transform(random);
        const TriangleSoup soup =
            read_vrml_text("Transform { " + outer.fields + " children Group { children Transform { " + inner.fields +
                           " children " + shape("Box { }") + " } } }");
        const TriangleSoup box = box_soup(Vec3::Ones());
        const Eigen::Matrix4d matrix = outer.matrix * inner.matrix;
        for (std::size_t v = 0; v < box.vertices.size(); ++v)
            CHECK((soup.vertices[v] - (matrix * box.vertices[v].homogeneous()).head<3>()).norm() <
                  1e-12 * (1 + matrix.norm()));
        CHECK(volume(soup) == Approx(8 * std::abs(matrix.determinant())).margin(1e-9));  // outward, mirrored or not
    }
}

TEST_CASE("A mirror is seen even where the scale is tiny", "[vrml]") {
    const TriangleSoup soup =
        read_vrml_text("Transform { scale -1e-120 1e-120 1e-120 children " + shape("Box { }") + " }");
    for (const Triangle& t : soup.triangles) {
        const Vec3 a = 1e120 * soup.vertices[t[0]], b = 1e120 * soup.vertices[t[1]], c = 1e120 * soup.vertices[t[2]];
        CHECK(a.dot(b.cross(c)) > 0);
    }
}

TEST_CASE("A rotation about no axis is none, and axes need not be unit", "[vrml]") {
    const auto corner = [](const std::string& rotation) {
        return bounds(read_vrml_text("Transform { rotation " + rotation + " children " + shape("Box { size 2 4 6 }") +
                                     " }"))
            .max;
    };
    CHECK(corner("0 0 0 1") == Vec3(1, 2, 3));
    CHECK((corner("0 0 1e-200 1.5707963267948966") - Vec3(2, 1, 3)).norm() < 1e-12);
}

TEST_CASE("Concave faces are cut without overlap", "[vrml]") {
    const std::vector<Vec3> ell = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    const std::vector<Vec3> ell_from_inside = {ell[4], ell[5], ell[0], ell[1], ell[2], ell[3]};
    for (const auto& polygon : {ell, ell_from_inside}) {
        const TriangleSoup soup = prism(polygon, 2);
        CHECK(soup.triangles.size() == 2 * 4 + 2 * 6);
        CHECK(inspect(soup).closed());
        CHECK(volume(soup) == Approx(10));
        CHECK(surface_area(soup) == Approx(2 * 5 + 12 * 2));  // more if triangles overlap
    }
}

TEST_CASE("Star-shaped polygons of any plane are cut without overlap", "[vrml]") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> radius(0.2, 1), turn(-1, 1);
    for (int n = 4; n < 120; n += 3) {
        CAPTURE(n);
        const Mat3 plane =
            Eigen::AngleAxisd(3 * turn(random), Vec3(turn(random), turn(random), 1).normalized()).matrix();
        std::vector<Vec3> points;
        double area = 0;
        std::string face;
        for (int k = 0; k < n; ++k) {
            const double r = radius(random), angle = 2 * pi * k / n;
            points.push_back(r * Vec3(std::cos(angle), std::sin(angle), 0));
            face += std::to_string(k) + ' ';
        }
        for (int k = 0; k < n; ++k) area += 0.5 * points[k].cross(points[(k + 1) % n]).z();
        for (Vec3& p : points) p = plane * p + Vec3(5, 6, 7);
        const TriangleSoup soup = read_vrml_text(shape(face_set(points, face, "convex FALSE")));
        CHECK(soup.triangles.size() == n - 2u);
        CHECK(surface_area(soup) == Approx(area));
    }
}

TEST_CASE("A polygon with a hole that hangs on a bridge is cut without overlap", "[vrml]") {
    const std::vector<Vec3> points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0},
                                      {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}};
    for (const std::string face : {"0 1 2 3 0 4 5 6 7 4", "4 0 1 2 3 0 4 5 6 7", "7 4 0 1 2 3 0 4 5 6"}) {
        const TriangleSoup soup = read_vrml_text(shape(face_set(points, face, "convex FALSE")));
        CHECK(soup.triangles.size() == 8);
        CHECK(surface_area(soup) == Approx(12));
    }
}

TEST_CASE("A polygon with straight corners and repeated points is cut without overlap", "[vrml]") {
    const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                      {2, 2, 0}, {1, 1, 0}, {0, 2, 0}, {0, 1, 0}};
    const auto area = [&](const std::string& face) {
        return surface_area(read_vrml_text(shape(face_set(points, face, "convex FALSE"))));
    };
    CHECK(area("0 1 2 3 4 5 6 7") == Approx(3));
    CHECK(area("0 0 1 2 2 3 4 5 5 5 6 7 7") == Approx(3));
    CHECK(area("1 0 1 2 3 4 5 6 7 0") == Approx(3));  // a spike without area
    CHECK(area("0 1 2 1") == 0);
}

TEST_CASE("Whatever its corners are, a polygon keeps its sides", "[vrml]") {
    std::mt19937 random(8);
    std::uniform_int_distribution<int> grid(0, 3), corner(0, 11);
    for (int i = 0; i < 300; ++i) {
        CAPTURE(i);
        std::vector<Vec3> points;
        for (int k = 0; k < 12; ++k) points.emplace_back(grid(random), grid(random), grid(random) / 2);
        std::vector<std::uint32_t> polygon;
        std::string face;
        for (int k = 0; k < 4 + i % 20; ++k) polygon.push_back(static_cast<std::uint32_t>(corner(random)));
        for (const std::uint32_t v : polygon) face += std::to_string(v) + ' ';
        const TriangleSoup soup = read_vrml_text(shape(face_set(points, face, "convex FALSE")));
        CHECK(soup.triangles.size() == polygon.size() - 2);
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;  // forward less backward
        const auto add_side = [&](std::uint32_t a, std::uint32_t b, int count) {
            balance[std::minmax(a, b)] += a < b ? count : a > b ? -count : 0;
        };
        for (std::size_t k = 0; k < polygon.size(); ++k) add_side(polygon[k], polygon[(k + 1) % polygon.size()], 1);
        for (const Triangle& t : soup.triangles)
            for (int k = 0; k < 3; ++k) add_side(t[k], t[(k + 1) % 3], -1);
        for (const auto& [side, count] : balance) CHECK(count == 0);
    }
}
