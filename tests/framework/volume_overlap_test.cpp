// Bounding volumes of bodies: they hold the body, nothing that touches is called apart, and what is apart is told where
// the pair of volumes has an exact test.
#include "framework/volumes_of_shapes.h"
#include "oracle/convex_overlap.h"

#include <kolize/bounding_volumes.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

const std::vector<VolumeKind> kinds{VolumeKind::sphere, VolumeKind::aabb, VolumeKind::obb, VolumeKind::kdop18,
                                    VolumeKind::kdop26};

Vec3 random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return {uniform(random), uniform(random), uniform(random)};
}

PlacedVolume point_volume(const Vec3& position) {
    PlacedVolume point;
    point.position = position;
    return point;
}

using Volumes = std::vector<ShapeVolume>;

Volumes all_volumes(const Shape& shape) {
    Volumes volumes;
    for (const VolumeKind kind : kinds) volumes.push_back(fit_volume(shape, kind));
    return volumes;
}

struct Fitted {
    Shape shape;
    Volumes volumes;
};

// Fitted once: the search for a small box takes its time.
const std::vector<Fitted>& bounded() {
    static const std::vector<Fitted> fitted = [] {
        std::vector<Fitted> result;
        for (const Shape& shape : bounded_shapes()) result.push_back({shape, all_volumes(shape)});
        return result;
    }();
    return fitted;
}

std::vector<Fitted> bounded_and_half_space() {
    std::vector<Fitted> all = bounded();
    const Shape plane = make_half_space("half_space", Vec3(1, 2, 2).normalized(), 3);
    all.push_back({plane, all_volumes(plane)});
    return all;
}

// Face planes of the volume, seen from the world's origin.
std::vector<oracle::HalfSpace> faces(const PlacedVolume& v) {
    if (v.kind == VolumeKind::aabb || v.kind == VolumeKind::obb)
        return oracle::box_faces(v.half_extents, v.axes, v.position + v.center);
    std::vector<oracle::HalfSpace> planes;
    const std::vector<Vec3> directions =
        slab_polytope(std::vector<Vec3>{Vec3::Zero()}, v.kind == VolumeKind::kdop18 ? 18 : 26).directions;
    for (std::size_t i = 0; i < directions.size(); ++i)
        for (const int back : {0, 1}) {
            const Vec3 n = (back ? -directions[i] : directions[i]).normalized();
            planes.push_back({n, v.reach[2 * i + back] / directions[i].norm() + n.dot(v.position)});
        }
    return planes;
}

}  // namespace

TEST_CASE("A body's bounding volume holds every point of the body", "[bounding_volumes]") {
    const unsigned seed = 20261101;
    CAPTURE(seed);
    std::mt19937 random(seed);
    for (const auto& [shape, volumes] : bounded_and_half_space())
        for (const ShapeVolume& volume : volumes) {
            CAPTURE(shape.name, int(volume.kind));
            for (int i = 0; i < 200; ++i) {
                const Vec3 position = random_vector(random, 5);
                const Mat3 rotation = any_rotation(random);
                const PlacedVolume placed = place_volume(volume, position, rotation);
                const Vec3 offset = rotation * point_in(shape, random);
                CHECK_FALSE(certainly_apart(placed, point_volume(position + offset)));
            }
        }
}

TEST_CASE("Volumes of bodies that share a point are never apart", "[bounding_volumes]") {
    const unsigned seed = 20261102;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const std::vector<Fitted> all = bounded_and_half_space();
    std::size_t wrong = 0;
    for (int round = 0; round < 3000; ++round) {
        const Fitted &first = all[random() % all.size()], &second = all[random() % (all.size() - 1)];
        const Mat3 turn_a = any_rotation(random), turn_b = any_rotation(random);
        const Vec3 place = random_vector(random, 1);
        const Vec3 shared = place + turn_a * point_in(first.shape, random);
        const Vec3 place_b = shared - turn_b * point_in(second.shape, random);
        for (const ShapeVolume& a : first.volumes)
            for (const ShapeVolume& b : second.volumes) {
                const PlacedVolume pa = place_volume(a, place, turn_a), pb = place_volume(b, place_b, turn_b);
                wrong += certainly_apart(pa, pb) + certainly_apart(pb, pa);
            }
    }
    CHECK(wrong == 0);
}

// Positions on a grid that is representable at 1e12 m, so that the bodies stand exactly the same way to each other.
TEST_CASE("A million million metres from the origin the same volumes are apart", "[bounding_volumes]") {
    const unsigned seed = 20261103;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const auto on_grid = [](const Vec3& v) { return Vec3((v * 0x1p12).array().round() * 0x1p-12); };
    std::size_t apart = 0, other = 0;
    for (int round = 0; round < 500; ++round) {
        const Volumes& first = bounded()[random() % bounded().size()].volumes;
        const Volumes& second = bounded()[random() % bounded().size()].volumes;
        const Mat3 turn_a = any_rotation(random), turn_b = any_rotation(random);
        const Vec3 between = on_grid(random_vector(random, 1.5)), far = on_grid(random_vector(random, 1e12));
        for (const ShapeVolume& a : first)
            for (const ShapeVolume& b : second) {
                const bool near =
                    certainly_apart(place_volume(a, Vec3::Zero(), turn_a), place_volume(b, between, turn_b));
                other += near != certainly_apart(place_volume(a, far, turn_a), place_volume(b, far + between, turn_b));
                apart += near;
            }
    }
    CHECK(other == 0);
    CHECK(apart > 1000);
}

TEST_CASE("Spheres, boxes and half-spaces that are apart are told apart", "[bounding_volumes]") {
    const unsigned seed = 20261104;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const auto sphere = fit_volume(make_sphere("s", 0.8), VolumeKind::sphere);
    const auto plane = fit_volume(make_half_space("h", Vec3::UnitY(), 0), VolumeKind::obb);
    const Vec3 half(0.9, 0.6, 0.3);
    constexpr double band = 1e-6;  // m: what the oracles cannot decide
    std::size_t apart = 0;
    for (int round = 0; round < 300; ++round) {
        const VolumeKind kind = round % 2 ? VolumeKind::obb : VolumeKind::aabb;
        const PlacedVolume box =
            place_volume(fit_volume(make_box("b", half), kind), random_vector(random, 1), any_rotation(random));
        const PlacedVolume ball = place_volume(sphere, random_vector(random, 1.5), Mat3::Identity());
        const PlacedVolume other = place_volume(fit_volume(make_box("c", half.reverse()), VolumeKind::obb),
                                                random_vector(random, 1.5), any_rotation(random));
        const PlacedVolume wall = place_volume(plane, random_vector(random, 1), any_rotation(random));

        const Vec3 seen = box.axes.transpose() * (ball.position - box.position);
        double squared = 0;
        for (int k = 0; k < 3; ++k) squared += std::pow(std::max(std::abs(seen[k]) - box.half_extents[k], 0.0), 2);
        if (const double gap = std::sqrt(squared) - ball.radius; std::abs(gap) > band) {
            CHECK(certainly_apart(box, ball) == (gap > 0));
            CHECK(certainly_apart(ball, box) == (gap > 0));
        }
        double lowest = infinity;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            lowest = std::min(
                lowest, wall.normal.dot(box.position + box.axes * sign.cwiseProduct(box.half_extents) - wall.position));
        }
        if (std::abs(lowest) > band) CHECK(certainly_apart(wall, box) == (lowest > 0));
        PlacedVolume larger = box;
        larger.half_extents += Vec3::Constant(band);
        const bool overlap = oracle::overlap_volume(faces(box), faces(other)) > 0;
        if (overlap == (oracle::overlap_volume(faces(larger), faces(other)) > 0)) {
            CHECK(certainly_apart(box, other) == !overlap);
            CHECK(certainly_apart(other, box) == !overlap);
            apart += !overlap;
        }
    }
    CHECK(apart > 50);
}

// A k-DOP against anything is tested along some axes only: it may be taken to overlap where it does not, never the
// other way round, and rarely.
TEST_CASE("k-DOPs that overlap are never apart, and most of those that do not are told apart", "[bounding_volumes]") {
    const unsigned seed = 20261105;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const Volumes &of_u = bounded()[3].volumes, &of_cone = bounded()[4].volumes;
    std::size_t apart = 0, told = 0;
    for (int round = 0; round < 60; ++round) {
        const std::size_t kind = 3 + round % 2, other = 1 + random() % 4;
        const PlacedVolume a = place_volume(of_cone[kind], Vec3::Zero(), any_rotation(random));
        const PlacedVolume b = place_volume(of_u[other], random_vector(random, 2.5), any_rotation(random));
        CAPTURE(round, kind, other);
        const bool overlap = oracle::overlap_volume(faces(a), faces(b)) > 1e-9;
        if (overlap) CHECK_FALSE(certainly_apart(a, b));
        apart += !overlap;
        told += certainly_apart(a, b);
        CHECK(certainly_apart(a, b) == certainly_apart(b, a));
    }
    CHECK(apart > 10);
    CHECK(10 * told >= 9 * apart);
}

TEST_CASE("The depth of overlapping volumes, along the normal, is what parts them", "[bounding_volumes]") {
    const unsigned seed = 20261106;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const std::vector<Fitted> all = bounded_and_half_space();
    std::size_t contacts = 0;
    for (int round = 0; round < 400; ++round) {
        const Fitted &first = all[random() % all.size()], &second = all[random() % (all.size() - 1)];
        const std::size_t kind_a = random() % 5, kind_b = random() % 5;
        const PlacedVolume a = place_volume(first.volumes[kind_a], random_vector(random, 1), any_rotation(random));
        PlacedVolume b = place_volume(second.volumes[kind_b], random_vector(random, 1), any_rotation(random));
        CAPTURE(round, first.shape.name, second.shape.name, kind_a, kind_b);
        const auto there = volume_contact(a, b), back = volume_contact(b, a);
        REQUIRE(there.has_value() == back.has_value());
        if (!there) continue;
        ++contacts;
        CHECK(there->depth > 0);
        CHECK(std::abs(there->normal.norm() - 1) < 1e-12);
        CHECK((there->normal + back->normal).norm() < 1e-9);
        CHECK(std::abs(there->depth - back->depth) < 1e-9);
        CHECK((a.position + there->point - b.position - back->point).norm() < 1e-9);
        // The axis between a sphere and a k-DOP turns as they move.
        if ((kind_a == 0 && kind_b > 2) || (kind_b == 0 && kind_a > 2)) continue;
        const Vec3 start = b.position;
        b.position = start + (there->depth + 1e-9) * there->normal;
        CHECK(certainly_apart(a, b));
        b.position = start + (there->depth - 1e-6) * there->normal;
        CHECK_FALSE(certainly_apart(a, b));
    }
    CHECK(contacts > 150);
}
