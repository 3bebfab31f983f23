// Situations in which contact models go wrong, each with what geometry says.
#include "framework/solids.h"
#include "narrowphase/solids.h"
#include "narrowphase/two_bodies.h"
#include "oracle/polycubes.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

// A mesh whose vertices are used as they stand: no frame of principal axes rounds them.
Shape exact_mesh(const TriangleSoup& soup) {
    Shape shape;
    shape.name = "exact";
    shape.kind = ShapeKind::mesh;
    shape.mesh = build_mesh(soup);
    shape.radius = shape.mesh->radius;
    shape.bounds = shape.mesh->bounds;
    shape.volume = 1;
    shape.moments = Vec3::Ones();
    return shape;
}

Shape exact_box(const Vec3& half_extents) { return exact_mesh(box_soup(half_extents)); }

// A frustum of five sides, its small end down, at y = 0.
TriangleSoup frustum() {
    TriangleSoup soup;
    for (const double y : {0.0, 2.0})
        for (int k = 0; k < 5; ++k) {
            const double angle = 2 * 3.141592653589793 * k / 5, r = y == 0 ? 0.5 : 1;
            soup.vertices.emplace_back(r * std::cos(angle), y, r * std::sin(angle));
        }
    for (std::uint32_t k = 0; k < 5; ++k) {
        const std::uint32_t next = (k + 1) % 5;
        soup.triangles.push_back({k, k + 5, next});
        soup.triangles.push_back({next, k + 5, next + 5});
        if (k < 2) continue;
        soup.triangles.push_back({0, k - 1, k});
        soup.triangles.push_back({5, k + 5, k + 4});
    }
    return soup;
}

std::vector<Contact> rows(const Placed& a, const Placed& b, Detail detail = Detail::manifold) {
    NarrowphaseUnderTest narrowphase("moller");
    return narrowphase.collide(a, b, detail).rows;
}

std::set<std::pair<double, double>> footprint(const std::vector<Contact>& contacts) {
    std::set<std::pair<double, double>> places;
    for (const Contact& c : contacts)
        places.insert({std::round(c.arm_a.x() * 1e9) / 1e9, std::round(c.arm_a.z() * 1e9) / 1e9});
    return places;
}

const std::set<std::pair<double, double>> four_corners = {{-1, -1}, {-1, 1}, {1, -1}, {1, 1}};

}  // namespace

TEST_CASE("N5 far pair: cubes 1e-3 apart at 10^k from the origin touch only if rounding has closed the gap",
          "[narrowphase][contour][N5]") {
    const Shape cube = exact_box(Vec3::Constant(0.5));
    for (int k = 0; k <= 15; ++k)
        for (const double gap : {1e-3, 0.0, -1e-3}) {
            const double far = std::pow(10.0, k), next = far + (1 + gap);
            const double rounded_gap = (next - far) - 1;
            const auto found = rows({cube, Vec3(far, far, -far)}, {cube, Vec3(next, far, -far)});
            CAPTURE(k, gap, rounded_gap);
            CHECK(found.empty() == (rounded_gap > 0));
            for (const Contact& c : found) {
                CHECK((c.normal - Vec3::UnitX()).norm() < 1e-15);
                CHECK(c.depth == Approx(-rounded_gap).margin(1e-15));
            }
        }
}

TEST_CASE("N6 parallel faces: none for any gap, four corners when coplanar or sunk", "[narrowphase][contour][N6]") {
    const Shape box = exact_box(Vec3(1, 1, 1));
    // On a wider slab, on a box of the same size, and turned so that both diagonals cross.
    for (const Shape& below : {exact_box(Vec3(5, 1, 5)), box}) {
        for (int k = 0; k <= 15; ++k) {
            CAPTURE(k);
            CHECK(rows({box, Vec3(0, 2 + std::pow(10.0, -k), 0)}, {below}).empty());
        }
        for (const double depth : {0.0, 1e-15, 1e-9, 1e-3, 0.25}) {
            CAPTURE(depth);
            const auto found = rows({box, Vec3(0, 2 - depth, 0)}, {below});
            REQUIRE(found.size() == 4);
            CHECK(footprint(found) == four_corners);
            for (const Contact& c : found) {
                CHECK((c.normal + Vec3::UnitY()).norm() < 1e-15);
                CHECK(c.depth == Approx(depth).margin(1e-15));
                CHECK(c.region == 0);
            }
        }
    }
}

TEST_CASE("a box that leans has its corners' own depths", "[narrowphase][contour]") {
    const Shape box = exact_box(Vec3(1, 1, 1)), slab = exact_box(Vec3(5, 1, 5));
    for (const double lean : {1e-12, 1e-6, 1e-3, -0.01}) {
        const Quat turned(Eigen::AngleAxisd(lean, Vec3::UnitZ()));
        const Vec3 position(0.125, 2 - 0.05, 0.25);
        const auto found = rows({box, position, turned}, {slab});
        CAPTURE(lean);
        REQUIRE(found.size() == 4);
        for (const Contact& c : found) {
            const Vec3 nearest_corner(c.arm_a.x() < 0 ? -1 : 1, -1, c.arm_a.z() < 0 ? -1 : 1);
            const double sunk = 1 - (position + turned * nearest_corner).y();
            CHECK(c.depth == Approx(sunk).epsilon(1e-9));
        }
        CHECK(footprint(found).size() == 4);
    }
}

TEST_CASE("N7 two sites: a bar's feet are two regions at x = +-1", "[narrowphase][contour][N7]") {
    const Shape bar = exact_mesh(u_bar());
    const Quat upside_down(0, 0, 0, 1);
    const double depths[] = {0.0, 1e-12, 1e-3, 0.5};
    for (const double depth : depths) {
        CAPTURE(depth);
        const auto found = rows({bar, Vec3(0, 3 - depth, 0), upside_down}, {exact_box(Vec3(5, 1, 5))}, Detail::normal);
        REQUIRE(found.size() == 2);
        for (const Contact& c : found) {
            CHECK((Vec3(std::abs(c.arm_a.x()), 0, c.arm_a.z()) - Vec3(1, 0, 0)).norm() < 1e-12);
            CHECK((c.normal + Vec3::UnitY()).norm() < 1e-12);
        }
        CHECK(found[0].arm_a.x() * found[1].arm_a.x() < 0);
    }
}

TEST_CASE("N8 frustum-plane: the normal is the plane's, however deep the end is sunk", "[narrowphase][contour][N8]") {
    const Shape cone = exact_mesh(frustum()), slab = exact_box(Vec3(5, 2, 5));
    for (const double depth : {0.0, 1e-15, 1e-12, 1e-6, 1e-3, 0.1, 1.0})
        for (const double lean : {0.0, 0.01, 0.3}) {
            const Quat turned(Eigen::AngleAxisd(lean, Vec3(1, 0, 0.5).normalized()));
            double lowest = 0;
            for (const Vec3& v : cone.mesh->vertices) lowest = std::min(lowest, (turned * v).y());
            const auto found = rows({cone, Vec3(0.1, 2 - lowest - depth, 0.2), turned}, {slab});
            CAPTURE(depth, lean);
            const bool may_miss = depth < 1e-14 && lean > 0;  // the turn has rounded
            if (may_miss && found.empty()) continue;
            REQUIRE_FALSE(found.empty());
            double deepest = 0;
            for (const Contact& c : found) {
                CHECK((c.normal + Vec3::UnitY()).norm() < 1e-12);
                deepest = std::max(deepest, c.depth);
            }
            CHECK(deepest == Approx(depth).epsilon(1e-12).margin(1e-13));
        }
}

TEST_CASE("edge on edge: the normal is square to both edges down to a mere touch", "[narrowphase][contour]") {
    const Shape box = exact_box(Vec3(1, 1, 1));
    const Quat on_edge(Eigen::AngleAxisd(0.7853981633974483, Vec3::UnitX()));
    const Quat across = Quat(Eigen::AngleAxisd(0.9, Vec3::UnitY())) * on_edge;
    for (const double depth : {1e-13, 1e-9, 1e-6, 1e-3, 0.1}) {
        const auto found = rows({box, Vec3(0, 2 * std::sqrt(2.0) - depth, 0), across}, {box, Vec3::Zero(), on_edge});
        CAPTURE(depth);
        REQUIRE_FALSE(found.empty());
        double deepest = 0;
        for (const Contact& c : found) {
            CHECK((c.normal + Vec3::UnitY()).norm() < 1e-12);
            deepest = std::max(deepest, c.depth);
        }
        CHECK(deepest == Approx(depth).epsilon(1e-12).margin(1e-13));
    }
}

TEST_CASE("N9 nested: a solid inside another overlaps at every detail, and is led out the nearest way",
          "[narrowphase][contour][N9]") {
    const Shape large = exact_box(Vec3::Constant(0.5)), small = exact_box(Vec3::Constant(0.0625));
    for (const char* plugin : {"moller", "angle_sum", "fcl"})
        for (const Vec3& at : {Vec3(0.3, 0.1, -0.05), Vec3(-0.1, 0.2, -0.43),
                               Vec3(0.4375, 0.25, 0.25)}) {  // the last one touches from within
            CAPTURE(plugin, at);
            NarrowphaseUnderTest narrowphase(plugin);
            for (const Detail detail : {Detail::overlap, Detail::normal, Detail::manifold}) {
                CHECK(narrowphase.collide({large}, {small, at}, detail).rows.size() == 1);
                CHECK(narrowphase.collide({small, at}, {large}, detail).rows.size() == 1);
            }
            int axis = 0;
            at.cwiseAbs().maxCoeff(&axis);
            const Vec3 out = at[axis] < 0 ? Vec3(-Vec3::Unit(axis)) : Vec3(Vec3::Unit(axis));
            const Contact c = narrowphase.collide({large}, {small, at}).rows.at(0);
            CHECK((c.normal - out).norm() < 1e-15);
            CHECK(c.depth == Approx(0.5625 - std::abs(at[axis])).epsilon(1e-12));
            const Contact d = narrowphase.collide({small, at}, {large}).rows.at(0);
            CHECK((d.normal + out).norm() < 1e-15);
            CHECK(d.depth == Approx(c.depth).epsilon(1e-12));
        }
    SECTION("what is only beside or in a hollow is not inside") {
        CHECK(rows({exact_mesh(u_bar())}, {small, Vec3(0, 1.5, 0)}).empty());
        CHECK(rows({large}, {small, Vec3(0.7, 0, 0)}).empty());
    }
}

TEST_CASE("a rod through a plate is one region that leads out on the rod's own side", "[narrowphase][contour]") {
    const Shape plate = exact_box(Vec3(3, 0.125, 3));
    for (const double above : {0.5, -0.5})
        for (const double lean : {0.0, 0.2}) {
            const Placed rod{exact_box(Vec3(0.25, 2, 0.25)), Vec3(0.0625, above, 0.125),
                             Quat(Eigen::AngleAxisd(lean, Vec3::UnitZ()))};
            const auto found = rows(rod, {plate});
            CAPTURE(above, lean);
            REQUIRE_FALSE(found.empty());
            for (const Contact& c : found) {
                CHECK(c.region == 0);
                CHECK((c.normal + Vec3(0, above > 0 ? 1 : -1, 0)).norm() < 1e-12);  // the plate goes the other way
            }
            const auto deepest = std::max_element(found.begin(), found.end(),
                                                  [](const Contact& c, const Contact& d) { return c.depth < d.depth; });
            CHECK(deepest->depth == Approx(0.25).epsilon(1e-12));  // the plate's thickness
        }
}

TEST_CASE("a washer on a slab is one region: the rim of its hole does not push the other way",
          "[narrowphase][contour]") {
    std::set<oracle::Cell> ring;
    for (int x = 0; x < 3; ++x)
        for (int z = 0; z < 3; ++z)
            if (x != 1 || z != 1) ring.insert({x, 0, z});
    std::mt19937_64 random(31);
    const Shape washer = exact_mesh(oracle::surface(ring, random));
    for (const double depth : {0.0, 1e-9, 0.1}) {
        const auto found = rows({washer, Vec3(-1.5, 1 - depth, -1.5)}, {exact_box(Vec3(5, 1, 5))});
        CAPTURE(depth);
        REQUIRE(found.size() == 4);
        for (const Contact& c : found) {
            CHECK(c.region == 0);
            CHECK((c.normal + Vec3::UnitY()).norm() < 1e-12);
            CHECK(c.depth == Approx(depth).margin(1e-15));
        }
    }
}

TEST_CASE("one body twice at the same place overlaps, and has a way out", "[narrowphase][contour]") {
    for (const TriangleSoup& soup : {box_soup(Vec3(1, 2, 3)), u_bar(), frustum(), cone48()})
        for (const char* plugin : {"moller", "angle_sum", "fcl"}) {
            CAPTURE(plugin, soup.triangles.size());
            NarrowphaseUnderTest narrowphase(plugin);
            const Shape shape = exact_mesh(soup);
            const Quat turned = Quat(0.8, 0.3, -0.2, 0.4).normalized();
            const Contacts found = narrowphase.collide({shape, Vec3(1, 2, 3), turned}, {shape, Vec3(1, 2, 3), turned});
            REQUIRE_FALSE(found.rows.empty());
            for (const Contact& c : found.rows) {
                CHECK(c.normal.norm() == Approx(1).epsilon(1e-12));
                CHECK(c.depth > 0);
            }
        }
}

TEST_CASE("bodies on a grid: unit normals, and the same contacts with the bodies exchanged", "[narrowphase][contour]") {
    std::mt19937_64 random(32);
    NarrowphaseUnderTest narrowphase("moller");
    std::size_t touching = 0;
    for (int round = 0; round < 300; ++round) {
        const auto body = [&] {
            for (;;) {
                const auto soup = oracle::surface(oracle::random_cells(random, 1 + random() % 8), random);
                if (inspect(soup).closed()) return exact_mesh(soup);
            }
        };
        const Placed a{body()};
        const Placed b{body(), Vec3(double(random() % 5) - 2, double(random() % 5) - 2, double(random() % 5) - 2)};
        if (b.position.isZero()) continue;  // no line of centres, no side to be on
        auto there = narrowphase.collide(a, b, Detail::normal).rows,
             back = narrowphase.collide(b, a, Detail::normal).rows;
        CAPTURE(round, b.position);
        CHECK(narrowphase.collide(a, b, Detail::overlap).rows.empty() == there.empty());
        REQUIRE(there.size() == back.size());
        for (const Contact& c : there) {
            CHECK(std::abs(c.normal.norm() - 1) < 1e-14);
            CHECK(c.depth > 0);
            CHECK(c.arm_a.allFinite());
            const bool has_like = std::any_of(back.begin(), back.end(), [&](const Contact& d) {
                return (c.normal + d.normal).norm() < 1e-12 && (c.arm_a - d.arm_b).norm() < 1e-12;
            });
            CHECK(has_like);
            ++touching;
        }
    }
    CHECK(touching > 150);
}

TEST_CASE("a mesh with a hole, or with a triangle twice, is refused with what is wrong and where",
          "[narrowphase][contour]") {
    TriangleSoup open = u_bar(), twice = u_bar();
    open.triangles.pop_back();
    twice.triangles.push_back(twice.triangles.front());
    CHECK_THROWS_WITH(make_mesh("open", open),
                      Catch::Contains("closed surface") && Catch::Contains("has one triangle"));
    CHECK_THROWS_WITH(make_mesh("twice", twice), Catch::Contains("closed surface") && Catch::Contains("triangle"));
}
