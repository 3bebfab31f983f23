// Lines and captions over a picture.
#include "render/studio.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

constexpr Rgba red = {255, 0, 0, 255};

Image drawn(Studio& studio, const std::vector<Line>& lines, const std::vector<Caption>& captions = {}) {
    studio.renderer->prepare(studio.world, {studio.rooms});
    studio.renderer->draw({studio.world, 0, studio.camera, studio.lights, studio.explosions, lines, captions});
    Image image;
    studio.renderer->read_pixels(image);
    return image;
}

int redness(const std::array<int, 3>& colour) { return colour[0] - colour[1]; }

}  // namespace

TEST_CASE("A line is drawn between its ends, a few pixels thick, in its colour", "[render][lines]") {
    Studio studio({{"samples", std::int64_t(1)}});
    const Image empty = drawn(studio, {});
    const Vec3 from(-2, 1, 0), to(1, -0.5, 1);
    const Image image = drawn(studio, {{from, to, red}});
    const Pixel start = studio.project(from), end = studio.project(to);
    const Difference d = difference(image, empty);
    CHECK(d.left == Approx(start.x).margin(2));
    CHECK(d.right == Approx(end.x).margin(2));
    CHECK(d.top == Approx(start.y).margin(2));
    CHECK(d.bottom == Approx(end.y).margin(2));
    const double length = std::hypot(end.x - start.x, end.y - start.y);
    CHECK(d.count > length);
    CHECK(d.count < 4 * length);
    const Pixel middle = studio.project(0.5 * (from + to));
    CHECK(at(image, middle) == std::array{255, 0, 0});
}

TEST_CASE("A line behind a body shows through, fainter", "[render][lines]") {
    Studio studio({{"samples", std::int64_t(1)}});
    studio.add(make_box("box", {1, 1, 1}), Vec3::Zero());
    const Image empty = drawn(studio, {});
    const Image image = drawn(studio, {{Vec3(-3, 0, -2), Vec3(3, 0, -2), red}});
    const Pixel hidden = studio.project(Vec3(0, 0, -2)), free = studio.project(Vec3(2.5, 0, -2));
    CHECK(redness(at(image, free)) == 255);
    const int through = redness(at(image, hidden)) - redness(at(empty, hidden));
    CHECK(through > 20);
    CHECK(through < 200);
    const Image before = drawn(studio, {{Vec3(-3, 0, 1.5), Vec3(3, 0, 1.5), red}});
    CHECK(redness(at(before, studio.project(Vec3(0, 0, 1.5)))) == 255);
}

TEST_CASE("A line that passes the eye is cut off, and one behind it is not drawn", "[render][lines]") {
    Studio studio({{"samples", std::int64_t(1)}});
    const Image empty = drawn(studio, {});
    CHECK(difference(drawn(studio, {{Vec3(0, 0, 20), Vec3(1, 1, 15), red}}), empty).count == 0);
    const Vec3 ahead(1, 0.5, 0), past(-1, -0.5, 30);
    const Image image = drawn(studio, {{ahead, past, red}});
    const Vec3 between = ahead + 0.2 * (past - ahead);
    REQUIRE(between.z() < studio.camera.eye.z());
    CHECK(at(image, studio.project(between)) == std::array{255, 0, 0});
    CHECK(difference(drawn(studio, {{Vec3(0, 0, std::nan("")), ahead, red}}), empty).count == 0);
}

TEST_CASE("A caption stands at its anchor, in its colour, as high as asked for", "[render][captions]") {
    Studio studio({{"samples", std::int64_t(1)}}, 640, 480);
    const Image empty = drawn(studio, {});
    Caption caption{"HHHH\nHHHH"};
    caption.height = 26.0 / 480;
    caption.colour = {40, 200, 90, 255};
    const auto place = [&](double x, double y, double anchor_x, double anchor_y) {
        caption.x = x, caption.y = y, caption.anchor_x = anchor_x, caption.anchor_y = anchor_y;
        return difference(drawn(studio, {}, {caption}), empty);
    };
    const Difference upper_left = place(0.1, 0.1, 0, 0);
    CHECK(upper_left.left == Approx(64).margin(4));
    CHECK(upper_left.top == Approx(48).margin(6));
    CHECK(upper_left.height() == Approx(2 * 26).margin(10));
    const Difference lower_right = place(0.9, 0.9, 1, 1);
    CHECK(lower_right.right == Approx(0.9 * 640).margin(4));
    CHECK(lower_right.bottom == Approx(0.9 * 480).margin(8));
    CHECK(lower_right.width() == upper_left.width());
    const Difference middle = place(0.5, 0.5, 0.5, 0.5);
    CHECK(0.5 * (middle.left + middle.right) == Approx(320).margin(3));
    CHECK(0.5 * (middle.top + middle.bottom) == Approx(240).margin(6));

    const Image image = drawn(studio, {}, {caption});
    int in_colour = 0;
    for (int y = middle.top; y <= middle.bottom; ++y)
        for (int x = middle.left; x <= middle.right; ++x) in_colour += at(image, x, y) == std::array{40, 200, 90};
    CHECK(in_colour > 100);
}

TEST_CASE("Captions of several heights do not change each other", "[render][captions]") {
    Studio studio({{"samples", std::int64_t(1)}}, 640, 480);
    Caption small{"small"}, large{"LARGE"};
    small.height = 0.03;
    large.height = 0.1;
    large.y = 0.5;
    const Image alone = drawn(studio, {}, {small});
    drawn(studio, {}, {large});
    CHECK(drawn(studio, {}, {small}).pixels == alone.pixels);
    const Image both = drawn(studio, {}, {small, large});
    CHECK(difference(both, alone).top > 230);
}
