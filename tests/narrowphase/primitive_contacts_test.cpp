#include "framework/solids.h"
#include "narrowphase/two_bodies.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

constexpr double tight = 1e-14;

Contact only(const Contacts& contacts) {
    REQUIRE(contacts.rows.size() == 1);
    return contacts.rows[0];
}

Quat random_quat(std::mt19937& random) { return Quat(random_rotation(random)); }

Vec3 random_vector(std::mt19937& random, double scale) {
    std::uniform_real_distribution<double> coordinate(-scale, scale);
    return {coordinate(random), coordinate(random), coordinate(random)};
}

}  // namespace

TEST_CASE("two spheres touch on the line of their centres", "[narrowphase][primitives]") {
    NarrowphaseUnderTest narrowphase("moller");
    const Placed a{make_sphere("a", 1)}, b{make_sphere("b", 2), Vec3(0, 2.5, 0)};
    const Contact c = only(narrowphase.collide(a, b));
    CHECK((c.normal - Vec3::UnitY()).norm() < tight);
    CHECK(c.depth == Approx(0.5).margin(tight));
    CHECK((c.arm_a - Vec3(0, 0.75, 0)).norm() < tight);
    CHECK((c.arm_b - Vec3(0, -1.75, 0)).norm() < tight);
    CHECK(narrowphase.collide(a, {b.shape, Vec3(0, 3.0001, 0)}).rows.empty());
}

TEST_CASE("a sphere leaves a box by the nearest way", "[narrowphase][primitives]") {
    NarrowphaseUnderTest narrowphase("moller");
    const Placed box{make_box("box", Vec3(1, 2, 3))};
    SECTION("against a face") {
        const Contact c = only(narrowphase.collide(box, {make_sphere("s", 0.5), Vec3(1.3, 0.4, 1)}));
        CHECK((c.normal - Vec3::UnitX()).norm() < tight);
        CHECK(c.depth == Approx(0.2).margin(tight));
    }
    SECTION("against a corner") {
        const Vec3 gap(0.1, 0.2, 0.2);
        const Contact c = only(narrowphase.collide(box, {make_sphere("s", 0.5), Vec3(1, 2, 3) + gap}));
        CHECK((c.normal - gap / 0.3).norm() < 1e-13);
        CHECK(c.depth == Approx(0.2).margin(tight));
    }
    SECTION("from the inside") {
        const Contact c = only(narrowphase.collide(box, {make_sphere("s", 0.5), Vec3(0.2, -1.5, 0)}));
        CHECK((c.normal + Vec3::UnitY()).norm() < tight);
        CHECK(c.depth == Approx(1.0).margin(tight));
    }
}

TEST_CASE("a box rests on a half-space with its four corners", "[narrowphase][primitives]") {
    NarrowphaseUnderTest narrowphase("moller");
    const Placed floor{make_half_space("floor", Vec3::UnitY(), 0), Vec3::Zero(), Quat::Identity(), true};
    const Contacts found = narrowphase.collide({make_box("box", Vec3(1, 1, 1)), Vec3(0, 0.75, 0)}, floor);
    REQUIRE(found.rows.size() == 4);
    for (const Contact& c : found.rows) {
        CHECK((c.normal + Vec3::UnitY()).norm() < tight);
        CHECK(c.depth == Approx(0.25).margin(tight));
        CHECK(std::abs(c.arm_a[0]) == Approx(1));
        CHECK(std::abs(c.arm_a[2]) == Approx(1));
    }
}

TEST_CASE("moving a box out along its normal by its depth just separates it", "[narrowphase][primitives]") {
    std::mt19937 random(7);
    NarrowphaseUnderTest narrowphase("moller");
    int overlapping = 0;
    for (int round = 0; round < 2000; ++round) {
        CAPTURE(round);
        const Placed a{make_box("a", Vec3(1, 0.5, 2)), Vec3::Zero(), random_quat(random)};
        Placed b{make_box("b", Vec3(0.7, 1.2, 0.4)), random_vector(random, 2), random_quat(random)};
        const Contacts found = narrowphase.collide(a, b, Detail::normal);
        if (found.rows.empty()) continue;
        ++overlapping;
        const Contact& c = found.rows[0];
        const double deepest = c.depth;
        const Vec3 start = b.position;
        // An edge axis may be up to 1 % better than the face that was reported.
        b.position = start + (1 + 1e-9) * deepest * c.normal;
        CHECK(narrowphase.collide(a, b).rows.empty());
        b.position = start + 0.98 * deepest * c.normal;
        CHECK_FALSE(narrowphase.collide(a, b).rows.empty());
    }
    CHECK(overlapping > 500);
}

TEST_CASE("boxes and the same boxes as meshes agree on whether they overlap", "[narrowphase][primitives]") {
    std::mt19937 random(11);
    NarrowphaseUnderTest narrowphase("moller");
    const Vec3 ha(1, 0.5, 2), hb(0.7, 1.2, 0.4);
    const Shape box_a = make_box("a", ha), box_b = make_box("b", hb);
    const Shape mesh_a = make_mesh("a", box_soup(ha)), mesh_b = make_mesh("b", box_soup(hb));
    int overlapping = 0;
    for (int round = 0; round < 2000; ++round) {
        CAPTURE(round);
        const Quat qa = random_quat(random), qb = random_quat(random);
        const Vec3 p = random_vector(random, 2.5);
        const bool boxes = !narrowphase.collide({box_a, Vec3::Zero(), qa}, {box_b, p, qb}).rows.empty();
        const bool meshes = !narrowphase.collide({mesh_a, Vec3::Zero(), qa}, {mesh_b, p, qb}).rows.empty();
        const bool mixed = !narrowphase.collide({box_a, Vec3::Zero(), qa}, {mesh_b, p, qb}).rows.empty();
        // The boxes are too big to lie one inside the other, so overlapping solids have intersecting surfaces.
        CHECK(boxes == meshes);
        CHECK(mixed == meshes);
        overlapping += boxes;
    }
    CHECK(overlapping > 500);
}

TEST_CASE("a sphere meets a convex mesh as it meets the same box", "[narrowphase][primitives]") {
    std::mt19937 random(13);
    NarrowphaseUnderTest narrowphase("moller");
    const Vec3 half(1, 0.5, 2);
    const Shape box = make_box("box", half), mesh = make_mesh("mesh", box_soup(half)), ball = make_sphere("ball", 0.6);
    int touching = 0;
    for (int round = 0; round < 2000; ++round) {
        CAPTURE(round);
        const Quat q = random_quat(random);
        const Vec3 p = random_vector(random, 2);
        const Contacts expected = narrowphase.collide({box, Vec3::Zero(), q}, {ball, p});
        const Contacts found = narrowphase.collide({mesh, Vec3::Zero(), q}, {ball, p});
        if (expected.rows.empty()) {
            CHECK(found.rows.empty());
            continue;
        }
        ++touching;
        // Centre deeper inside than the radius: no surface is near, and containment is not surface contact.
        if (found.rows.empty()) {
            CHECK(expected.rows[0].depth > 2 * 0.6);
            continue;
        }
        REQUIRE(found.rows.size() == 1);
        CHECK((found.rows[0].normal - expected.rows[0].normal).norm() < 1e-9);
        CHECK(found.rows[0].depth == Approx(expected.rows[0].depth).epsilon(1e-9));
    }
    CHECK(touching > 500);
}
