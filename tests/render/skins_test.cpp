// Pictures laid on bodies: which colour is where, worked out by hand.
#include "render/studio.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace kolize;
using namespace kolize::test;

namespace {

// Red and green above, blue and yellow below.
Image four_colours() {
    using Colour = std::array<std::uint8_t, 3>;
    constexpr Colour red = {255, 0, 0}, green = {0, 255, 0}, blue = {0, 0, 255}, yellow = {255, 255, 0};
    Image image{64, 64, {}};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const Colour& colour = y < 32 ? (x < 32 ? red : green) : (x < 32 ? blue : yellow);
            image.pixels.insert(image.pixels.end(), colour.begin(), colour.end());
        }
    return image;
}

Image one_colour(std::uint8_t red, std::uint8_t green, std::uint8_t blue) { return {1, 1, {red, green, blue}}; }

// Which of red, green and blue are there, whatever the light: "r", "rg" and so on.
std::string channels(const std::array<int, 3>& colour) {
    const int most = std::max({colour[0], colour[1], colour[2]});
    std::string names;
    for (std::size_t i = 0; i < 3; ++i)
        if (2 * colour[i] > most) names += "rgb"[i];
    return names;
}

struct Side {
    Vec3 outward, right, up;
};

// As somebody sees them who stands before them, no side mirrored.
const std::array<Side, 6> sides = {{{Vec3::UnitX(), -Vec3::UnitZ(), Vec3::UnitY()},
                                    {-Vec3::UnitX(), Vec3::UnitZ(), Vec3::UnitY()},
                                    {Vec3::UnitY(), Vec3::UnitX(), -Vec3::UnitZ()},
                                    {-Vec3::UnitY(), Vec3::UnitX(), Vec3::UnitZ()},
                                    {Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()},
                                    {-Vec3::UnitZ(), -Vec3::UnitX(), Vec3::UnitY()}}};

// What is seen of a cube of one metre, at (x, y) from the middle of a side.
std::string seen(Studio& studio, const Side& side, double x, double y) {
    studio.camera.eye = 4 * side.outward;
    studio.camera.up = side.up;
    studio.lights[0].position = studio.camera.eye;
    const Image image = studio.picture();
    return channels(at(image, studio.project(0.5 * side.outward + x * side.right + y * side.up)));
}

}  // namespace

TEST_CASE("Every side of a cube shows the whole picture, upright and not mirrored", "[render]") {
    Studio studio({{"gloss", 0.0}});
    studio.add(make_box("cube", Vec3::Constant(0.5)), {0, 0, 0});
    studio.skins = {{0, four_colours(), 1}};
    for (const Side& side : sides) {
        CAPTURE(side.outward.transpose());
        CHECK(seen(studio, side, -0.25, 0.25) == "r");
        CHECK(seen(studio, side, 0.25, 0.25) == "g");
        CHECK(seen(studio, side, -0.25, -0.25) == "b");
        CHECK(seen(studio, side, 0.25, -0.25) == "rg");
    }
}

TEST_CASE("A picture repeats every side of it, with its middle on the axis", "[render]") {
    Studio studio({{"gloss", 0.0}});
    studio.add(make_box("cube", Vec3::Constant(0.5)), {0, 0, 0});
    studio.skins = {{0, four_colours(), 0.5}};
    // One copy reaches from -0.25 to 0.25 m, the next one from there to 0.75 m.
    CHECK(seen(studio, sides[4], -0.125, 0.125) == "r");
    CHECK(seen(studio, sides[4], 0.125, 0.125) == "g");
    CHECK(seen(studio, sides[4], 0.375, 0.125) == "r");
    CHECK(seen(studio, sides[4], 0.125, -0.375) == "g");
    CHECK(seen(studio, sides[4], 0.375, -0.125) == "b");
}

TEST_CASE("A picture turns with its body", "[render]") {
    Studio studio({{"gloss", 0.0}});
    const std::uint32_t cube = studio.add(make_box("cube", Vec3::Constant(0.5)), {0, 0, 0});
    studio.skins = {{0, four_colours(), 1}};
    // A quarter turn to the left, as it is seen: what was above on the right is above on the left.
    studio.world.orientation[cube] = Quat(Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ()));
    CHECK(seen(studio, sides[4], -0.25, 0.25) == "g");
    CHECK(seen(studio, sides[4], -0.25, -0.25) == "r");
    CHECK(seen(studio, sides[4], 0.25, -0.25) == "b");
    CHECK(seen(studio, sides[4], 0.25, 0.25) == "rg");
}

TEST_CASE("A skin takes the place of a ball's colour and octants, and only of its shape", "[render]") {
    Studio studio({{"gloss", 0.0}, {"colour_by", std::string("shape")}});
    studio.add(make_sphere("plain", 1), {-1.5, 0, 0});
    studio.add(make_sphere("blue", 1), {1.5, 0, 0});
    const Image before = studio.picture();
    studio.skins = {{1, one_colour(0, 0, 255), 1}};
    const Image image = studio.picture();
    for (const Vec3& place : {Vec3(1.1, 0.4, 0.8), Vec3(1.9, 0.4, 0.8), Vec3(1.1, -0.4, 0.8), Vec3(1.9, -0.4, 0.8)})
        CHECK(channels(at(image, studio.project(place))) == "b");
    const auto bright = [&](double y) { return brightness(at(image, studio.project({1.5, y, 0.9}))); };
    CHECK(bright(0.4) == Approx(bright(-0.4)).margin(25));  // octants: one is darker by two thirds
    const Difference changed = difference(image, before);
    CHECK(changed.left > 160);
    CHECK(changed.count > 1000);
    studio.skins.clear();
    CHECK(difference(studio.picture(), before).count == 0);
}
