#include "framework/solids.h"
#include "narrowphase/solids.h"
#include "narrowphase/two_bodies.h"
#include "oracle/convex_overlap.h"

#include <catch2/catch.hpp>

#include <set>

using namespace kolize;
using namespace kolize::test;

namespace {

Placed slab() { return {make_mesh("slab", box_soup(Vec3(5, 1, 5))), Vec3(0.013, -1, 0.027), Quat::Identity(), true}; }

Vec3 random_vector(std::mt19937& random, double scale) {
    std::uniform_real_distribution<double> coordinate(-scale, scale);
    return {coordinate(random), coordinate(random), coordinate(random)};
}

std::set<std::uint32_t> regions_of(const Contacts& contacts) {
    std::set<std::uint32_t> regions;
    for (const Contact& c : contacts.rows) regions.insert(c.region);
    return regions;
}

}  // namespace

TEST_CASE("a spike pressed into a slab gets the slab's normal and its own depth", "[narrowphase][contour]") {
    for (const char* plugin : {"moller", "fcl"})
        for (const double depth : {1e-6, 1e-3, 0.1, 0.4}) {
            CAPTURE(plugin, depth);
            NarrowphaseUnderTest narrowphase(plugin);
            const Quat turned(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
            const World world = world_of({make_mesh("spike", spike()), Vec3(0, -depth, 0), turned}, slab());
            const Contacts found = narrowphase.collide(world);
            REQUIRE(found.rows.size() == 4);
            double deepest = 0;
            for (const Contact& c : found.rows) {
                CHECK((c.normal + Vec3::UnitY()).norm() < 1e-9);  // the spike is A, so down into the slab
                CHECK(point_of(world, c).y() < 1e-12);
                CHECK(point_of(world, c).y() > -depth);
                deepest = std::max(deepest, c.depth);
            }
            CHECK(deepest == Approx(depth).epsilon(1e-9));
        }
}

TEST_CASE("a bar that stands on two feet has two regions, one under each foot", "[narrowphase][contour]") {
    const Quat upside_down(Eigen::AngleAxisd(3.141592653589793, Vec3::UnitZ()));
    const World world = world_of({make_mesh("bar", u_bar()), Vec3(0, 1.99, 0), upside_down}, slab());
    SECTION("contour") {
        NarrowphaseUnderTest narrowphase("moller");
        const Contacts found = narrowphase.collide(world, Detail::normal);
        REQUIRE(found.rows.size() == 2);
        double sum = 0;
        for (const Contact& c : found.rows) {
            CHECK(std::abs(point_of(world, c).x()) == Approx(1).margin(1e-12));
            CHECK((c.normal + Vec3::UnitY()).norm() < 1e-12);
            CHECK(c.depth == Approx(0.01).epsilon(1e-9));
            sum += point_of(world, c).x();
        }
        CHECK(std::abs(sum) < 1e-12);
    }
    SECTION("averaged: the thesis' single point lies between the feet, where nothing touches") {
        NarrowphaseUnderTest narrowphase("moller", {{"contact", std::string("averaged")}});
        const Contacts found = narrowphase.collide(world);
        REQUIRE(found.rows.size() == 1);
        CHECK(std::abs(point_of(world, found.rows[0]).x()) < 0.5);
    }
    SECTION("half-space") {
        NarrowphaseUnderTest narrowphase("moller");
        const Placed floor{make_half_space("floor", Vec3::UnitY(), 0), Vec3::Zero(), Quat::Identity(), true};
        const Contacts found = narrowphase.collide({make_mesh("bar", u_bar()), Vec3(0, 1.99, 0), upside_down}, floor);
        CHECK(regions_of(found).size() == 2);
        REQUIRE(found.rows.size() == 8);
        for (const Contact& c : found.rows) CHECK(c.depth == Approx(0.01).epsilon(1e-9));
    }
}

TEST_CASE("the normal is the direction in which the overlap volume falls fastest", "[narrowphase][contour]") {
    std::mt19937 random(3);
    NarrowphaseUnderTest narrowphase("moller");
    const Vec3 ha(1, 0.5, 2), hb(0.7, 1.2, 0.4);
    const Shape a = make_mesh("a", box_soup(ha)), b = make_mesh("b", box_soup(hb));
    int compared = 0;
    for (int round = 0; round < 300; ++round) {
        CAPTURE(round);
        const Quat qa(random_rotation(random)), qb(random_rotation(random));
        const Vec3 p = random_vector(random, 1.8);
        const Contacts found = narrowphase.collide({a, Vec3::Zero(), qa}, {b, p, qb}, Detail::normal);
        if (found.rows.size() != 1) continue;
        const auto faces_a = oracle::box_faces(ha, qa.toRotationMatrix(), Vec3::Zero());
        const auto volume_at = [&](const Vec3& at) {
            return oracle::overlap_volume(faces_a, oracle::box_faces(hb, qb.toRotationMatrix(), at));
        };
        if (volume_at(p) < 0.02) continue;  // too small for differences
        const double h = 1e-4;
        Vec3 gradient;
        for (int k = 0; k < 3; ++k)
            gradient[k] = (volume_at(p + h * Vec3::Unit(k)) - volume_at(p - h * Vec3::Unit(k))) / (2 * h);
        // The overlap hardly depends on the position: one body goes right through the other, and the gradient is not
        // used.
        if (gradient.norm() < 0.4) continue;
        CHECK((found.rows[0].normal + gradient.normalized()).norm() < 1e-3);
        ++compared;
    }
    CHECK(compared > 50);
}

TEST_CASE("the depth is the longest chord of the overlap along the normal", "[narrowphase][contour]") {
    std::mt19937 random(5);
    NarrowphaseUnderTest narrowphase("moller");
    const Vec3 ha(1, 0.5, 2), hb(0.7, 1.2, 0.4);
    const Shape a = make_mesh("a", box_soup(ha)), b = make_mesh("b", box_soup(hb));
    int compared = 0;
    for (int round = 0; round < 1000; ++round) {
        CAPTURE(round);
        const Quat qa(random_rotation(random)), qb(random_rotation(random));
        const Vec3 p = random_vector(random, 2);
        const Contacts found = narrowphase.collide({a, Vec3::Zero(), qa}, {b, p, qb}, Detail::normal);
        if (found.rows.size() != 1) continue;
        if (found.rows[0].depth > 0.4) continue;
        auto planes = oracle::box_faces(ha, qa.toRotationMatrix(), Vec3::Zero());
        for (const auto& face : oracle::box_faces(hb, qb.toRotationMatrix(), p)) planes.push_back(face);
        const double chord = oracle::longest_chord(planes, found.rows[0].normal, found.rows[0].arm_a);
        if (chord > 0.2) continue;  // deeper, a chord may leave through the body that it came from
        CHECK(found.rows[0].depth == Approx(chord).epsilon(1e-6).margin(1e-9));
        ++compared;
    }
    CHECK(compared > 100);
}

TEST_CASE("contacts of meshes do not depend on the distance from the origin", "[narrowphase][contour]") {
    NarrowphaseUnderTest narrowphase("moller");
    const Shape shape = make_mesh("bar", u_bar());
    const Quat turned = Quat(0.8, 0.3, -0.2, 0.4).normalized();
    const Vec3 far(1048576, -2097152, 4194304);  // powers of two: both positions stay exact
    World world = world_of({shape, Vec3::Zero()}, {shape, Vec3(0.5, 0.75, 0.25), turned});
    // Dyadic centres, so that the shift itself rounds nothing.
    for (Vec3& p : world.position) p = (p * 1024).array().round() / 1024;
    const Contacts near_origin = narrowphase.collide(world);
    for (Vec3& p : world.position) p += far;
    const Contacts far_away = narrowphase.collide(world);
    REQUIRE(near_origin.rows.size() == far_away.rows.size());
    REQUIRE_FALSE(near_origin.rows.empty());
    for (std::size_t i = 0; i < near_origin.rows.size(); ++i) {
        CHECK(near_origin.rows[i].normal == far_away.rows[i].normal);
        CHECK(near_origin.rows[i].arm_a == far_away.rows[i].arm_a);
        CHECK(near_origin.rows[i].arm_b == far_away.rows[i].arm_b);
        CHECK(near_origin.rows[i].depth == far_away.rows[i].depth);
    }
}

TEST_CASE("a sphere in a concave corner touches both walls", "[narrowphase][contour]") {
    NarrowphaseUnderTest narrowphase("moller");
    const Placed bar{make_mesh("bar", u_bar())};
    // Between the feet: floor at y = 1, inner walls at x = +-0.5; the ball of radius 0.55 leans into all three.
    const World world = world_of(bar, {make_sphere("ball", 0.55), Vec3(0, 1.5, 0)});
    const Contacts found = narrowphase.collide(world);
    REQUIRE(found.rows.size() == 3);
    Vec3 sum = Vec3::Zero();
    for (const Contact& c : found.rows) {
        CHECK(c.depth == Approx(0.05).epsilon(1e-9));
        sum += c.normal;
    }
    CHECK((sum - Vec3::UnitY()).norm() < 1e-9);  // the two walls cancel, the floor pushes up
}

TEST_CASE("the averaged model's normal is always a unit vector, even where the mean vanishes",
          "[narrowphase][averaged]") {
    std::mt19937 random(9);
    NarrowphaseUnderTest narrowphase("angle_sum", {{"contact", std::string("averaged")}});
    const Shape a = make_mesh("a", cone(12, 0.2, 3)), b = make_mesh("b", u_bar());
    int touching = 0;
    for (int round = 0; round < 300; ++round) {
        CAPTURE(round);
        const Placed first{a, random_vector(random, 1), Quat(random_rotation(random))};
        for (const Contact& c : narrowphase.collide(first, {b, Vec3::Zero()}).rows) {
            CHECK(c.normal.norm() == Approx(1).epsilon(1e-12));
            CHECK(c.depth > 0);
            ++touching;
        }
    }
    CHECK(touching > 50);
}
