// Bodies in pictures, judged by a pinhole camera and by areas in closed form.
#include "render/studio.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace kolize;
using namespace kolize::test;

namespace {

// Orange, the first colour of the palette: red above green above blue, whatever the light.
bool is_orange(const std::array<int, 3>& c) { return c[0] > 1.2 * c[1] && c[1] > 1.8 * c[2] && c[0] > 40; }

struct Spot {
    int count = 0;
    double farthest = 0;  // from the place where they should be, pixels
};

Spot orange_about(const Image& image, const Pixel& center) {
    Spot spot;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (is_orange(at(image, x, y))) {
                ++spot.count;
                spot.farthest = std::max(spot.farthest, std::hypot(x + 0.5 - center.x, y + 0.5 - center.y));
            }
    return spot;
}

}  // namespace

TEST_CASE("A ball is seen where a pinhole camera sees it, in its colour, and nowhere else after it moves", "[render]") {
    Studio studio({{"gloss", 0.0}});
    studio.camera.eye = {1, 2, 12};
    studio.camera.up = {0.2, 1, 0};
    const double radius = 0.3;
    const std::uint32_t ball = studio.add(make_sphere("ball", radius), {0, 0, 0});
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(3, -1, 2), Vec3(-2.5, 2, -4)}) {
        CAPTURE(place.transpose());
        studio.world.position[ball] = place;
        const Vec3 sight = (studio.camera.target - studio.camera.eye).normalized(), to_ball = place - studio.camera.eye;
        const double seen = radius * studio.pixels_at(to_ball.dot(sight));
        const double stretch =
            to_ball.norm() / to_ball.dot(sight);  // away from the middle a ball is seen as an ellipse
        const Spot spot = orange_about(studio.picture(), studio.project(place));
        CHECK(spot.farthest < 1.06 * seen * stretch + 1);
        CHECK(spot.count == Approx(std::numbers::pi * seen * seen * stretch).epsilon(0.1));
    }
}

TEST_CASE("A turned box and its mesh cover the same pixels, those of its outline", "[render]") {
    const Vec3 half(0.8, 0.4, 0.3);
    Studio studio;
    const Image empty = studio.picture();
    const Quat turn(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
    studio.add(make_box("box", half), {0.5, -0.3, 0}, turn);
    const Difference as_box = difference(studio.picture(), empty);
    Studio other;
    other.add(make_mesh("mesh", box_soup(half)), {0.5, -0.3, 0}, turn);
    CHECK(difference(other.picture(), empty).count == as_box.count);

    // Turned by a right angle its width is its former height; the front is nearer by half a depth.
    const double scale = studio.pixels_at(10 - half.z());
    CHECK(as_box.width() == Approx(2 * half.y() * scale).margin(2.5));
    CHECK(as_box.height() == Approx(2 * half.x() * scale).margin(2.5));
    CHECK(as_box.left == Approx(studio.project({0.5 - half.y(), 0, half.z()}).x).margin(2));
}

TEST_CASE("The nearer body hides the farther one", "[render]") {
    Studio studio({{"gloss", 0.0}, {"colour_by", std::string("body")}});
    const std::uint32_t orange = studio.add(make_sphere("a", 1), {0, 0, 0});
    studio.add(make_sphere("b", 1), {0, 0, -3});
    CHECK(is_orange(at(studio.picture(), 160, 120)));
    studio.world.position[orange].z() = -6;
    CHECK_FALSE(is_orange(at(studio.picture(), 160, 120)));
}

TEST_CASE("Far from the origin a scene looks the same to the last byte", "[render]") {
    Studio studio;
    studio.add(make_sphere("ball", 1), {-1.5, 0.25, 0});
    studio.add(make_box("box", {0.5, 0.75, 0.5}), {1.5, -0.5, 1});
    studio.rooms = {room_of(4)};
    const Image near = studio.picture();
    const Vec3 away(1 << 20, -(1 << 21), 1 << 20);
    for (Vec3* place : {&studio.world.position[0], &studio.world.position[1], &studio.rooms[0].min,
                        &studio.rooms[0].max, &studio.camera.eye, &studio.camera.target, &studio.lights[0].position})
        *place += away;
    CHECK(difference(studio.picture(), near).count == 0);
}

TEST_CASE("Flat shading shows the triangles of a mesh that smooth shading rounds off", "[render]") {
    // A prism of eight sides seen from the side; its edges turn by 45 degrees.
    TriangleSoup soup;
    const int n = 8;
    for (const double y : {-1.0, 1.0})
        for (int i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * (i + 0.5) / n;
            soup.vertices.push_back({std::cos(angle), y, -std::sin(angle)});
        }
    for (std::uint32_t i = 0, j = n - 1; i < n; j = i++) {
        soup.triangles.push_back({j, i, i + n});
        soup.triangles.push_back({j, i + n, j + n});
        if (i < 2) continue;
        soup.triangles.push_back({0, i, i - 1});
        soup.triangles.push_back({n, n + i - 1, n + i});
    }
    const auto brightest_step = [&](double crease) {
        Studio studio({{"crease", crease}, {"gloss", 0.0}});
        studio.lights[0].position = {6, 0, 8};
        studio.add(make_mesh("prism", soup), {0, 0, 0});
        const Image image = studio.picture();
        const double x = studio.project({std::sin(std::numbers::pi / n), 0, std::cos(std::numbers::pi / n)}).x;
        const auto side = [&](double shift) { return brightness(at(image, {x + shift, 120})); };
        return std::abs(side(3) - side(-3));
    };
    CHECK(brightest_step(0) > 15);
    CHECK(brightest_step(60) < 0.5 * brightest_step(0));
}

TEST_CASE("Ten thousand bodies are drawn, each at its place", "[render]") {
    Studio studio({{"samples", std::int64_t{1}}}, 640, 480);
    studio.world.shapes = {make_sphere("ball", 0.02), make_box("box", Vec3::Constant(0.02))};
    const auto place = [](int column, int row) { return Vec3(0.07 * (column - 49.5), 0.07 * (row - 49.5), 0); };
    const Image empty = studio.picture();
    for (int i = 0; i < 10000; ++i) {
        BodyDescription body;
        body.shape = static_cast<std::uint32_t>(i % 2);
        body.position = place(i % 100, i / 100);
        studio.world.add(body);
    }
    const Image image = studio.picture();
    int seen = 0;
    for (int i = 0; i < 10000; ++i) {
        const Pixel p = studio.project(place(i % 100, i / 100));
        seen += at(image, p) != at(empty, p);
    }
    CHECK(seen == 10000);
}
