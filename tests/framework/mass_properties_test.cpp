#include "framework/solids.h"

#include <kolize/mass_properties.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>

#include <array>

using namespace kolize;
using namespace kolize::test;

namespace {

double relative_error(const Mat3& value, const Mat3& exact) { return (value - exact).norm() / exact.norm(); }

// The oracle: the same integrals in rational arithmetic over the same rounded vertices, about the frame's origin.
using Rational = boost::multiprecision::cpp_rational;
using RationalPoint = std::array<Rational, 3>;

struct ExactMass {
    Rational volume = 0;
    RationalPoint center{};
    std::array<RationalPoint, 3> covariance{};  // over the volume, about the centre

    explicit ExactMass(const TriangleSoup& soup) {
        for (const Triangle& t : soup.triangles) add(point(soup, t[0]), point(soup, t[1]), point(soup, t[2]));
        for (int i = 0; i < 3; ++i) center[i] /= 4 * volume;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) covariance[i][j] = covariance[i][j] / (20 * volume) - center[i] * center[j];
        volume /= 6;
    }

    Mat3 inertia() const {
        Mat3 result;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                Rational entry = -covariance[i][j];
                if (i == j) entry += covariance[0][0] + covariance[1][1] + covariance[2][2];
                result(i, j) = entry.convert_to<double>();
            }
        return result;
    }

private:
    static RationalPoint point(const TriangleSoup& soup, std::uint32_t v) {
        const Vec3& p = soup.vertices[v];
        return {Rational(p.x()), Rational(p.y()), Rational(p.z())};
    }

    void add(const RationalPoint& p, const RationalPoint& q, const RationalPoint& r) {
        const Rational d = p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                           p[2] * (q[0] * r[1] - q[1] * r[0]);
        volume += d;
        for (int i = 0; i < 3; ++i) {
            const Rational s = p[i] + q[i] + r[i];
            center[i] += d * s;
            for (int j = 0; j < 3; ++j)
                covariance[i][j] += d * (s * (p[j] + q[j] + r[j]) + p[i] * p[j] + q[i] * q[j] + r[i] * r[j]);
        }
    }
};

// Triangles that span so many tetrahedra of positive volume with the origin, and one at the origin, from where the sums
// are taken: integrals over the tetrahedra, though no surface is closed.
TriangleSoup tetrahedra_on_origin(int count, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-1, 1);
    TriangleSoup soup{{Vec3::Zero()}, {{0, 0, 0}}, {}, ""};
    for (int i = 0; i < count; ++i) {
        Vec3 corner[3];
        for (Vec3& v : corner) v = Vec3(coordinate(random), coordinate(random), coordinate(random));
        if (corner[0].dot(corner[1].cross(corner[2])) < 0) std::swap(corner[0], corner[1]);
        const auto v = static_cast<std::uint32_t>(soup.vertices.size());
        soup.vertices.insert(soup.vertices.end(), corner, corner + 3);
        soup.triangles.push_back({v, v + 1, v + 2});
    }
    return soup;
}

}  // namespace

TEST_CASE("M1 cube500: a cube of side 500 has its closed-form mass properties", "[mass]") {
    const MassProperties mass = mass_properties(box_soup(Vec3::Constant(250)));
    CHECK(mass.volume == Approx(1.25e8).epsilon(1e-14));
    CHECK(mass.center_of_mass.norm() <= 1e-12);
    CHECK(relative_error(mass.inertia_over_mass, Mat3::Identity() * (125000.0 / 3)) <= 1e-14);
}

TEST_CASE("M2 cone48: a cone of 48 sides has its closed-form mass properties", "[mass]") {
    const double t = 2 * std::numbers::pi / 48, axial = 1000 * (2 + std::cos(t));  // r^2 (2 + cos t) / 10
    const double transverse = axial / 2 + 3 * 300.0 * 300.0 / 80;
    const MassProperties mass = mass_properties(cone48());
    CHECK(mass.volume == Approx(8 * 100.0 * 100.0 * std::sin(t) * 300).epsilon(1e-14));
    CHECK((mass.center_of_mass - Vec3(0, 75, 0)).norm() <= 1e-12);
    CHECK(relative_error(mass.inertia_over_mass, Vec3(transverse, axial, transverse).asDiagonal()) <= 1e-14);
}

TEST_CASE("M3 tetra-products: a right tetrahedron has the products of inertia of its closed form", "[mass]") {
    const MassProperties mass = mass_properties(corner_tetrahedron());
    const Mat3 exact = Mat3::Constant(1.0 / 80) + Mat3::Identity() * (3.0 / 40 - 1.0 / 80);
    CHECK(mass.volume == Approx(1.0 / 6).epsilon(1e-15));
    CHECK((mass.center_of_mass - Vec3::Constant(0.25)).norm() <= 1e-15);
    CHECK(relative_error(mass.inertia_over_mass, exact) <= 1e-15);

    Vec3 moments = principal_frame(mass.inertia_over_mass).moments;
    std::sort(moments.begin(), moments.end());
    CHECK((moments - Vec3(1.0 / 16, 1.0 / 16, 1.0 / 10)).norm() <= 1e-16);
}

TEST_CASE("M4 far-cube: mass properties of a far cube are those of its rounded vertices", "[mass]") {
    std::mt19937 random(2024);
    double distance = 1;
    for (int k = 0; k <= 9; ++k, distance *= 10)
        for (int repeat = 0; repeat < 5; ++repeat) {
            CAPTURE(k, repeat);
            const Mat3 rotation = random_rotation(random);
            const TriangleSoup soup = moved(box_soup(Vec3::Constant(0.5)), rotation, distance * rotation.col(1));
            const MassProperties mass = mass_properties(soup);
            const ExactMass exact(soup);
            CHECK(mass.volume == Approx(exact.volume.convert_to<double>()).epsilon(1e-14));
            CHECK(relative_error(mass.inertia_over_mass, exact.inertia()) <= 1e-14);
            for (int i = 0; i < 3; ++i) {
                const double exact_center = exact.center[i].convert_to<double>();
                CHECK(std::abs(mass.center_of_mass[i] - exact_center) <= 4e-16 * (1 + distance));
            }
        }
}

TEST_CASE("M5 plate: a plate of any thinness has its closed-form mass properties", "[mass]") {
    double t = 1;
    for (int k = 0; k <= 100; ++k, t /= 10) {
        CAPTURE(k);
        TriangleSoup plate = box_soup(Vec3(0.5, 0.5, t / 2));
        const MassProperties mass = mass_properties(plate);
        CHECK(mass.volume == Approx(t).epsilon(1e-14));
        CHECK(mass.inertia_over_mass(2, 2) == Approx(1.0 / 6).epsilon(1e-14));
        CHECK(mass.inertia_over_mass(0, 0) == Approx((1 + t * t) / 12).epsilon(1e-14));
    }
}

TEST_CASE("A needle keeps the small moment about its axis", "[mass]") {
    for (const double t : {1e-2, 1e-5, 1e-8}) {
        CAPTURE(t);
        const MassProperties mass = mass_properties(box_soup(Vec3(0.5, t / 2, t / 2)));
        CHECK(mass.inertia_over_mass(0, 0) == Approx(t * t / 6).epsilon(1e-14));
    }
}

TEST_CASE("M7 dense: a finer mesh of the same cube has the same mass properties", "[mass]") {
    TriangleSoup cube = box_soup(Vec3::Constant(250));
    for (int k = 0; k <= 7; ++k, cube = subdivided(cube)) {
        CAPTURE(k);
        REQUIRE(cube.triangles.size() == std::size_t{12} << (2 * k));
        const MassProperties mass = mass_properties(cube);
        CHECK(mass.volume == Approx(1.25e8).epsilon(1e-14));
        CHECK(relative_error(mass.inertia_over_mass, Mat3::Identity() * (125000.0 / 3)) <= 1e-14);
    }
}

// Triangles are taken four at a time; what is left over at the end must count as much as the rest.
TEST_CASE("Every triangle counts, however many there are", "[mass]") {
    std::mt19937 random(44);
    for (int tetrahedra = 1; tetrahedra <= 9; ++tetrahedra)
        for (int repeat = 0; repeat < 20; ++repeat) {
            CAPTURE(tetrahedra, repeat);
            const TriangleSoup soup = tetrahedra_on_origin(tetrahedra, random);
            const MassProperties mass = mass_properties(soup);
            const ExactMass exact(soup);
            CHECK(mass.volume == Approx(exact.volume.convert_to<double>()).epsilon(1e-14));
            CHECK(relative_error(mass.inertia_over_mass, exact.inertia()) <= 1e-14);
        }
}

TEST_CASE("Solids of few triangles have their closed-form mass properties", "[mass]") {
    const auto volume = [](const TriangleSoup& soup) { return mass_properties(soup).volume; };
    CHECK(volume(cone(3, 1, 2)) == Approx(2.0 / 3 * 3 * std::sqrt(3) / 4).epsilon(1e-14));          // 6 triangles
    CHECK(volume(cone(4, 1, 3)) == Approx(2).epsilon(1e-14));                                       // 8
    CHECK(volume(cone(5, 1, 3)) == Approx(2.5 * std::sin(0.4 * std::numbers::pi)).epsilon(1e-14));  // 10
}

TEST_CASE("The order of the triangles does not matter", "[mass]") {
    std::mt19937 random(12);
    TriangleSoup soup = moved(subdivided(cone48()), random_rotation(random), Vec3(300, -200, 100));
    const MassProperties first = mass_properties(soup);
    for (int repeat = 0; repeat < 50; ++repeat) {
        CAPTURE(repeat);
        std::shuffle(soup.triangles.begin(), soup.triangles.end(), random);
        const MassProperties mass = mass_properties(soup);
        CHECK(mass.volume == Approx(first.volume).epsilon(1e-14));
        CHECK((mass.center_of_mass - first.center_of_mass).norm() <= 1e-14 * 300);
        CHECK(relative_error(mass.inertia_over_mass, first.inertia_over_mass) <= 1e-14);
    }
}

TEST_CASE("M8 rotate: the inertia tensor turns with the mesh", "[mass]") {
    const Mat3 tensor = mass_properties(corner_tetrahedron()).inertia_over_mass;
    std::mt19937 random(8);
    for (int i = 0; i < 1000; ++i) {
        CAPTURE(i);
        const Mat3 rotation = random_rotation(random);
        const MassProperties turned = mass_properties(moved(corner_tetrahedron(), rotation, Vec3::Zero()));
        CHECK(relative_error(turned.inertia_over_mass, rotation * tensor * rotation.transpose()) <= 1e-14);
    }
}

TEST_CASE("An inside-out surface has a negative volume and the same centre and tensor", "[mass]") {
    TriangleSoup soup = moved(corner_tetrahedron(), Mat3::Identity(), Vec3(5, -3, 2));
    const MassProperties outward = mass_properties(soup);
    for (Triangle& t : soup.triangles) std::swap(t[1], t[2]);
    const MassProperties inward = mass_properties(soup);
    CHECK(inward.volume == -outward.volume);
    CHECK(inward.center_of_mass == outward.center_of_mass);
    CHECK(inward.inertia_over_mass == outward.inertia_over_mass);
}

TEST_CASE("A surface without volume has zeros for mass properties, not NaN", "[mass]") {
    const MassProperties mass = mass_properties({{Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 0)}, {{0, 1, 2}}, {}, ""});
    CHECK(mass.volume == 0);
    CHECK(mass.inertia_over_mass.isZero(0));
    CHECK(mass_properties({}).volume == 0);
}

TEST_CASE("A diagonal tensor is its own principal frame, in the order of the axes", "[mass]") {
    const PrincipalFrame frame = principal_frame(Vec3(3, 1, 2).asDiagonal());
    CHECK(frame.moments == Vec3(3, 1, 2));
    CHECK(frame.axes.coeffs() == Quat::Identity().coeffs());
}

TEST_CASE("Rounding noise off the diagonal does not turn the frame of a cube", "[mass]") {
    Mat3 tensor = Mat3::Identity();
    tensor(0, 1) = tensor(1, 0) = 1e-16;
    CHECK(principal_frame(tensor).axes.coeffs() == Quat::Identity().coeffs());
}

TEST_CASE("Principal frames diagonalise random tensors to a few ulp", "[mass]") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> exponent(-6, 0);
    for (int i = 0; i < 2000; ++i) {
        CAPTURE(i);
        Vec3 moments;
        for (double& m : moments) m = std::pow(10, exponent(random));
        if (i % 4 == 0) moments[1] = moments[2];  // a symmetric top has no second axis of its own
        const Mat3 rotation = random_rotation(random);
        Mat3 tensor = rotation * moments.asDiagonal() * rotation.transpose();
        tensor = (0.5 * (tensor + tensor.transpose())).eval();
        const PrincipalFrame frame = principal_frame(tensor);
        const Mat3 axes = frame.axes.toRotationMatrix();
        CHECK((tensor * axes - axes * frame.moments.asDiagonal()).norm() <= 1e-15 * 8 * tensor.norm());
        CHECK(axes.determinant() == Approx(1).epsilon(1e-14));
    }
}
