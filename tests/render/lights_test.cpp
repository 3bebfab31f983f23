// Lights, rooms and explosions in pictures.
#include "render/studio.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace kolize;
using namespace kolize::test;

TEST_CASE("A light that is attached to a body goes and turns with it", "[render]") {
    Studio studio({{"gloss", 0.0}});
    studio.add(make_sphere("lit", 1), {0, 0, 0});
    const std::uint32_t carrier = studio.add(make_box("carrier", Vec3::Constant(0.1)), {0, 3, 4});
    Light lamp;
    lamp.kind = LightKind::spot;
    lamp.direction = {0, -3, -4};  // towards the ball as long as the carrier is not turned
    lamp.range = 8;
    lamp.cone = 0.5;
    lamp.body = carrier;
    studio.lights = {lamp};
    const auto ball = [&] { return brightness(at(studio.picture(), 160, 110)); };

    const int lit = ball();
    studio.lights.clear();
    const int dark = ball();
    CHECK(lit > 1.5 * dark);
    studio.lights = {lamp};
    studio.world.orientation[carrier] = Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitY()));
    CHECK(ball() == dark);
    studio.world.orientation[carrier] = Quat::Identity();
    studio.world.position[carrier] = {0, 9, 12};  // out of range
    CHECK(ball() == dark);
    studio.world.position[carrier] = {0, 3, 4};
    CHECK(ball() == lit);
    studio.world.removed[carrier] = 1;
    CHECK(ball() == dark);
}

TEST_CASE("A lamp attached off the centre of mass is in the model's frame", "[render]") {
    // The centre of mass of this tetrahedron is a quarter of a metre from the model's origin along each axis.
    TriangleSoup soup;
    soup.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    Studio studio({{"gloss", 0.0}});
    studio.add(make_sphere("lit", 1), {0, 0, 0});
    const std::uint32_t carrier = studio.add(make_mesh("carrier", soup), {0, 20, 0});
    Light lamp;
    lamp.range = 6;
    lamp.position = {0, 3, 4};
    studio.lights = {lamp};
    const Image free = studio.picture();
    studio.lights[0].body = carrier;
    studio.lights[0].position = Vec3(0, 3, 4) - Vec3(0, 20, 0);
    REQUIRE(studio.world.position[carrier].isApprox(Vec3(0.25, 20.25, 0.25)));
    CHECK(difference(studio.picture(), free).count < 20);  // rounding of the principal axes
}

TEST_CASE("A half-space fills the picture below its horizon", "[render]") {
    Studio studio;
    studio.camera.eye = {0, 2, 10};
    studio.camera.target = {0, 2, 0};  // level: the horizon is in the middle
    const Image empty = studio.picture();
    studio.add(make_half_space("floor", Vec3::UnitY(), 0), {0, 0, 0});
    const Difference floor = difference(studio.picture(), empty);
    CHECK(floor.top >= 120);
    CHECK(floor.top < 128);
    CHECK(floor.bottom == 239);
    CHECK(floor.width() == 320);
}

TEST_CASE("An open side of a room shows no wall", "[render]") {
    Studio studio;
    studio.camera.field_of_view = 0.3;  // only the far wall
    const Image empty = studio.picture();
    studio.rooms = {room_of(4)};
    CHECK(difference(studio.picture(), empty).count == 320 * 240);
    studio.rooms[0].open = {false, false, false, false, true, false};
    CHECK(difference(studio.picture(), empty).count == 0);
}

TEST_CASE("An explosion appears at its place, plays its pictures and ends", "[render]") {
    Studio studio({{"explosion_fps", 16.0}, {"explosion_scale", 2.0}});  // 32 pictures: 2 s
    const Image nothing = studio.picture();
    studio.explosions = {{{1.5, -1, 0}, 0.5, 3.0}};
    CHECK(difference(studio.picture(2.99), nothing).count == 0);
    CHECK(difference(studio.picture(5.01), nothing).count == 0);
    const Image early = studio.picture(3.5);
    const Difference seen = difference(early, nothing);
    const Pixel center = studio.project({1.5, -1, 0});
    const double half = 2 * 0.5 * studio.pixels_at(10);
    CHECK(seen.count > 0.5 * half * half);
    CHECK(seen.left > center.x - 1.15 * half);
    CHECK(seen.right < center.x + 1.15 * half);
    CHECK(seen.top > center.y - 1.15 * half);
    CHECK(seen.bottom < center.y + 1.15 * half);
    CHECK(difference(studio.picture(3.52), early).count == 0);  // the same sixteenth of a second
    CHECK(difference(studio.picture(3.57), early).count > 0);
}

TEST_CASE("Billboards turn freely, or about the upright only", "[render]") {
    const auto shape = [](const std::string& turn, const std::string& facing) {
        Studio studio({{"billboard_turn", turn}, {"billboard_facing", facing}});
        studio.camera.eye = 10 * Vec3(0, std::sin(1.0), std::cos(1.0));  // from above
        const Image nothing = studio.picture();
        studio.explosions = {{{0, 0, 0}, 0.5, 0.0}};
        const Difference seen = difference(studio.picture(0.5), nothing);
        return seen.height() / seen.width();
    };
    CHECK(shape("spherical", "camera") == Approx(1).margin(0.15));
    CHECK(shape("spherical", "screen") == Approx(1).margin(0.15));
    CHECK(shape("cylindrical", "camera") == Approx(std::cos(1.0)).margin(0.15));
    CHECK(shape("cylindrical", "screen") == Approx(std::cos(1.0)).margin(0.15));
}

TEST_CASE("Only so many explosions are shown as the pool holds, the newest", "[render]") {
    Studio one, all({{"explosion_pool", std::int64_t{1}}});
    one.explosions = {{{2, 0, 0}, 0.5, 0.1}};
    all.explosions = {{{-2, 0, 0}, 0.5, 0.0}, {{2, 0, 0}, 0.5, 0.1}};
    const Image with_one = one.picture(0.5);
    CHECK(difference(all.picture(0.5), with_one).count == 0);
}
