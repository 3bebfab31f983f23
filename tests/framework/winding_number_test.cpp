#include "framework/round_solids.h"

#include <catch2/catch.hpp>
#include <kolize/simulation.h>
#include <kolize/winding_number.h>

using namespace kolize;
using namespace kolize::test;

namespace {

Vec3 random_point(std::mt19937& random, double half) {
    std::uniform_real_distribution<double> uniform(-half, half);
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
}

// The solid angles of all triangles by another formula: spherical excess from the angles between their sides' planes
// (Girard), the sign from the side that the point is on.
double winding_by_girard(const TriangleSoup& soup, const Vec3& point) {
    double sum = 0;
    for (const Triangle& t : soup.triangles) {
        Vec3 corner[3];
        for (int k = 0; k < 3; ++k) corner[k] = (soup.vertices[t[k]] - point).normalized();
        double excess = -std::numbers::pi;
        for (int k = 0; k < 3; ++k) {
            const Vec3 a = corner[k].cross(corner[(k + 1) % 3]), b = corner[k].cross(corner[(k + 2) % 3]);
            excess += std::atan2(a.cross(b).norm(), a.dot(b));
        }
        sum += std::copysign(excess, corner[0].dot(corner[1].cross(corner[2])));
    }
    return sum / (4 * std::numbers::pi);
}

// Triangles anywhere in a cube, facing anywhere.
TriangleSoup litter(std::mt19937& random) {
    TriangleSoup soup;
    for (std::uint32_t v = 0; v < 600; ++v) soup.vertices.push_back(random_point(random, 1));
    for (std::uint32_t v = 0; v < 600; v += 3) soup.triangles.push_back({v, v + 1, v + 2});
    return soup;
}

TriangleSoup without_triangles(TriangleSoup soup, std::size_t count) {
    soup.triangles.resize(soup.triangles.size() - count);
    return soup;
}

// Without the triangles that lie above a plane z = height altogether.
TriangleSoup without_cap(TriangleSoup soup, double height) {
    std::erase_if(soup.triangles, [&](const Triangle& t) {
        return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return soup.vertices[v].z() >= height; });
    });
    return soup;
}

void flip(TriangleSoup& soup) {
    for (Triangle& t : soup.triangles) std::swap(t[0], t[1]);
}

std::vector<TriangleSoup> solids() {
    std::mt19937 random(11);
    return {box_soup(Vec3(1, 2, 3)), moved(box_soup(Vec3(0.2, 0.5, 1)), random_rotation(random), Vec3(4, 5, 6)),
            corner_tetrahedron(),    cone48(),
            unit_sphere(2),          torus(0.3, 20, 12)};
}

void check_contains(const MassEstimate& estimate, const MassProperties& truth) {
    CHECK(std::abs(estimate.mass.volume - truth.volume) <= estimate.volume);
    const Vec3 center_error = (estimate.mass.center_of_mass - truth.center_of_mass).cwiseAbs();
    CHECK((center_error.array() <= estimate.center_of_mass.array()).all());
    const Mat3 inertia_error = (estimate.mass.inertia_over_mass - truth.inertia_over_mass).cwiseAbs();
    CHECK((inertia_error.array() <= estimate.inertia_over_mass.array()).all());
}

void check_nothing(const MassEstimate& estimate) {
    CHECK(estimate.mass.volume == 0);
    CHECK(estimate.mass.center_of_mass.isZero(0));
    CHECK(estimate.mass.inertia_over_mass.isZero(0));
    CHECK(estimate.volume == 0);
    CHECK(estimate.center_of_mass.isZero(0));
    CHECK(estimate.inertia_over_mass.isZero(0));
}

}  // namespace

TEST_CASE("The winding number of a closed surface is one inside and zero outside", "[winding]") {
    constexpr unsigned seed = 1;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const WindingNumber box(box_soup(Vec3(1, 1, 1))), ring(torus(0.5, 100, 60)), ball(unit_sphere(4));
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = random_point(random, 2);
        CAPTURE(p.transpose());
        CHECK(box.at(p) == Approx(p.lpNorm<Eigen::Infinity>() < 1).margin(1e-12));
        // The triangles stand a little inward of the curved surfaces: points near those are left out.
        if (const double r = p.norm(); std::abs(r - 1) > 0.01) CHECK(ball.at(p) == Approx(r < 1).margin(0.01));
        if (const double r = std::hypot(std::hypot(p.x(), p.y()) - 1, p.z()); std::abs(r - 0.5) > 0.01)
            CHECK(ring.at(p) == Approx(r < 0.5).margin(0.01));
    }
}

TEST_CASE("The winding number is within a hundredth of the sum of all solid angles", "[winding]") {
    constexpr unsigned seed = 2;
    CAPTURE(seed);
    std::mt19937 random(seed);
    for (const TriangleSoup& soup : {litter(random), without_cap(unit_sphere(4), 0.3),
                                     without_cap(torus(0.4, 60, 40), 0.1), box_soup(Vec3(1, 0.1, 1))}) {
        const WindingNumber winding(soup);
        for (int i = 0; i < 200; ++i) {
            const Vec3 p = random_point(random, i < 50 ? 10 : 1.5);
            CAPTURE(p.transpose());
            CHECK(winding.at(p) == Approx(winding_by_girard(soup, p)).margin(0.01));
        }
    }
}

TEST_CASE("The error of the winding number falls with the fifth power of the distance", "[winding]") {
    constexpr unsigned seed = 8;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const TriangleSoup soup = litter(random);
    const WindingNumber winding(soup);
    double error[2] = {0, 0};
    for (int i = 0; i < 200; ++i) {
        const Vec3 direction = random_rotation(random).col(0);
        for (const int k : {0, 1}) {
            const Vec3 p = (k == 0 ? 15 : 30) * direction;
            error[k] += std::abs(winding.at(p) - winding_by_girard(soup, p));
        }
    }
    CHECK(error[0] / error[1] > 28);  // dipoles alone would have 8, with second order 16
    CHECK(error[0] / error[1] < 40);
}

TEST_CASE("The winding number does not depend on place or size", "[winding]") {
    constexpr unsigned seed = 3;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const TriangleSoup open = without_cap(torus(0.4, 60, 40), 0.1);
    for (const double size : {1e-120, 1e-6, 1e6, 1e120}) {
        const WindingNumber scaled(moved(open, size * Mat3::Identity(), Vec3::Constant(1e3 * size)));
        for (int i = 0; i < 50; ++i) {
            const Vec3 p = random_point(random, 1.5);
            CHECK(scaled.at(size * (p + Vec3::Constant(1e3))) == Approx(winding_by_girard(open, p)).margin(0.01));
        }
    }
}

TEST_CASE("Near a hole in a plane face the winding number goes through one half", "[winding]") {
    const WindingNumber open(without_triangles(box_soup(Vec3(1, 1, 1)), 2));  // the face z = 1 is missing
    for (const double x : {-0.9, 0.0, 0.3})
        for (const double y : {-0.5, 0.1}) {
            CHECK(open.at(Vec3(x, y, 1)) == Approx(0.5).margin(1e-12));
            CHECK(open.at(Vec3(x, y, 0.9)) > 0.5);
            CHECK(open.at(Vec3(x, y, 1.1)) < 0.5);
        }
    CHECK(open.at(Vec3(0, 0, 0)) == Approx(5.0 / 6).margin(1e-12));
}

TEST_CASE("The winding number is finite everywhere on a surface, also where it has no area", "[winding]") {
    TriangleSoup soup = box_soup(Vec3(1, 1, 1));
    soup.triangles.push_back({0, 0, 1});
    soup.triangles.push_back({0, 0, 0});
    const WindingNumber winding(soup);
    for (const Vec3& a : soup.vertices)
        for (const Vec3& b : soup.vertices)
            for (const double part : {0.0, 0.25, 0.5}) CHECK(std::abs(winding.at(a + part * (b - a))) <= 1.5);
    CHECK(WindingNumber({{Vec3(1, 2, 3)}, {{0, 0, 0}}, {}, ""}).at(Vec3(0, 0, 0)) == 0);
    CHECK(WindingNumber({{Vec3(1, 2, 3)}, {}, {}, ""}).at(Vec3(1, 2, 3)) == 0);
}

TEST_CASE("The range of an estimate contains the exact mass properties of closed solids", "[winding]") {
    const auto host = make_host(2);
    for (const std::size_t samples : {30, 500, 5000})
        for (const TriangleSoup& soup : solids()) {
            CAPTURE(samples, soup.triangles.size());
            const MassEstimate estimate = estimate_mass_properties(soup, samples, *host);
            check_contains(estimate, mass_properties(soup));
            CHECK(estimate.samples <= 2 * samples);
            CHECK(2 * estimate.samples >= samples);
        }
}

TEST_CASE("The range of an estimate shrinks with the number of samples", "[winding]") {
    const auto host = make_host(2);
    for (const TriangleSoup& soup : solids()) {
        CAPTURE(soup.triangles.size());
        const MassEstimate rough = estimate_mass_properties(soup, 250, *host);
        const MassEstimate fine = estimate_mass_properties(soup, 6750, *host);  // cells of a third the size
        CHECK(fine.volume < rough.volume / 5);                                  // n^(-2/3): nine times less
        CHECK(fine.volume < 0.1 * mass_properties(soup).volume);
    }
}

TEST_CASE("The range of an estimate contains the solid whose surface has a hole", "[winding]") {
    const auto host = make_host(2);
    constexpr std::size_t samples = 4000;
    const TriangleSoup box = box_soup(Vec3(1, 1.5, 0.8)), ball = unit_sphere(3);
    for (const std::size_t missing : {1, 2})
        check_contains(estimate_mass_properties(without_triangles(box, missing), samples, *host), mass_properties(box));
    double width = 0;
    for (const double height : {0.95, 0.85, 0.7}) {  // larger and larger holes
        CAPTURE(height);
        const TriangleSoup open = without_cap(ball, height);
        REQUIRE(open.triangles.size() < ball.triangles.size());
        const MassEstimate estimate = estimate_mass_properties(open, samples, *host);
        check_contains(estimate, mass_properties(ball));
        CHECK(estimate.volume > 1.2 * width);
        width = estimate.volume;
    }
}

TEST_CASE("An estimate has the same bits for any number of threads", "[winding]") {
    const TriangleSoup open = without_cap(torus(0.4, 30, 20), 0.1);
    const MassEstimate one = estimate_mass_properties(open, 3000, *make_host(1));
    for (const int threads : {2, 3}) {
        const MassEstimate other = estimate_mass_properties(open, 3000, *make_host(threads));
        CHECK(other.mass.volume == one.mass.volume);
        CHECK(other.mass.center_of_mass == one.mass.center_of_mass);
        CHECK(other.mass.inertia_over_mass == one.mass.inertia_over_mass);
        CHECK(other.volume == one.volume);
        CHECK(other.center_of_mass == one.center_of_mass);
        CHECK(other.inertia_over_mass == one.inertia_over_mass);
    }
}

TEST_CASE("A surface that faces inward is estimated like the same one turned over", "[winding]") {
    const auto host = make_host(1);
    TriangleSoup soup = without_triangles(box_soup(Vec3(1, 1, 1)), 1);
    const MassEstimate outward = estimate_mass_properties(soup, 1000, *host);
    flip(soup);
    const MassEstimate inward = estimate_mass_properties(soup, 1000, *host);
    CHECK(inward.mass.volume == outward.mass.volume);
    CHECK(inward.mass.volume > 0);
    CHECK(inward.volume == outward.volume);
}

TEST_CASE("Overlapping solids are estimated as their union", "[winding]") {
    TriangleSoup soup = box_soup(Vec3(1, 1, 1));
    const TriangleSoup second = moved(soup, Mat3::Identity(), Vec3(1, 0, 0));  // [0, 2] against [-1, 1]
    soup.vertices.insert(soup.vertices.end(), second.vertices.begin(), second.vertices.end());
    for (const auto& [a, b, c] : second.triangles) soup.triangles.push_back({a + 8, b + 8, c + 8});
    const MassProperties whole = mass_properties(moved(box_soup(Vec3(1.5, 1, 1)), Mat3::Identity(), Vec3(0.5, 0, 0)));
    check_contains(estimate_mass_properties(soup, 10000, *make_host(2)), whole);
}

TEST_CASE("An estimate is as good far from the origin", "[winding]") {
    const auto host = make_host(2);
    const TriangleSoup ball = unit_sphere(3), far = moved(ball, Mat3::Identity(), Vec3::Constant(1e6));
    const MassEstimate there = estimate_mass_properties(far, 3000, *host);
    const MassEstimate here = estimate_mass_properties(ball, 3000, *host);
    check_contains(there, mass_properties(far));
    CHECK(there.volume == Approx(here.volume).epsilon(0.01));
    CHECK(there.inertia_over_mass.isApprox(here.inertia_over_mass, 0.01));
}

TEST_CASE("What encloses nothing is estimated as nothing", "[winding]") {
    const auto host = make_host(1);
    check_nothing(estimate_mass_properties({}, 1000, *host));
    check_nothing(estimate_mass_properties({{Vec3(1, 2, 3)}, {}, {}, ""}, 1000, *host));
    const std::vector<Vec3> square = {Vec3(0, 0, 5), Vec3(1, 0, 5), Vec3(1, 1, 5), Vec3(0, 1, 5)};
    check_nothing(estimate_mass_properties({square, {{0, 1, 2}, {0, 2, 3}}, {}, ""}, 1000, *host));
}

TEST_CASE("A sheet that bounds nothing has no volume but a range that is finite", "[winding]") {
    std::mt19937 random(5);
    const std::vector<Vec3> square = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
    const TriangleSoup tilted = moved({square, {{0, 1, 2}, {0, 2, 3}}, {}, ""}, random_rotation(random), Vec3::Zero());
    const MassEstimate estimate = estimate_mass_properties(tilted, 1000, *make_host(1));
    CHECK(estimate.mass.volume == 0);
    CHECK(std::isfinite(estimate.volume));
    CHECK(estimate.center_of_mass.isZero(0));
}

TEST_CASE("Thin boxes are cut into cells of their own thickness, with about as many samples", "[winding]") {
    const auto host = make_host(1);
    for (const Vec3& half : {Vec3(1, 1, 1e-3), Vec3(1e-9, 1, 1), Vec3(1e-5, 1, 1e-5), Vec3(1e-9, 1, 1e-6)}) {
        const MassEstimate estimate = estimate_mass_properties(box_soup(half), 1000, *host);
        CHECK(estimate.samples >= 500);
        CHECK(estimate.samples <= 2000);
        CHECK(estimate.mass.volume == Approx(8 * half.prod()));
    }
}
