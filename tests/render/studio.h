// A renderer with a small world before it, and a pinhole camera worked out by hand to judge its pictures by.
#pragma once

#include "framework/scenes.h"

#include <kolize/renderer.h>

#include <array>
#include <cmath>

namespace kolize::test {

struct Pixel {
    double x = 0, y = 0;  // from the left and from the top
};

struct Studio {
    explicit Studio(const std::map<std::string, Value>& settings = {}, int width = 320, int height = 240)
        : width(width),
          height(height),
          host(make_host(1)),
          renderer(plugins().make<Renderer>(stage("gl", settings), *host)) {
        world.materials.emplace_back();
        renderer->open(width, height);
    }

    std::uint32_t add(const Shape& shape, const Vec3& position, const Quat& orientation = Quat::Identity()) {
        world.shapes.push_back(shape);
        BodyDescription body;
        body.shape = static_cast<std::uint32_t>(world.shapes.size() - 1);
        body.is_static = shape.kind == ShapeKind::half_space;
        body.position = position;
        body.orientation = orientation;
        return world.add(body);
    }
    Image picture(double time = 0) {
        renderer->prepare(world, {rooms, skins});
        renderer->draw({world, time, camera, lights, explosions});
        Image image;
        renderer->read_pixels(image);
        return image;
    }

    // Where a point is in the picture.
    Pixel project(const Vec3& point) const {
        const Vec3 forward = (camera.target - camera.eye).normalized();
        const Vec3 right = forward.cross(camera.up).normalized(), up = right.cross(forward);
        const Vec3 p = point - camera.eye;
        const double scale = pixels_at(p.dot(forward));
        return {0.5 * width + scale * p.dot(right), 0.5 * height - scale * p.dot(up)};
    }
    // Length in the picture of one metre at this depth.
    double pixels_at(double depth) const { return 0.5 * height / std::tan(0.5 * camera.field_of_view) / depth; }

    int width, height;
    std::unique_ptr<Host> host;
    StagePtr<Renderer> renderer;
    World world;
    std::vector<Room> rooms;
    std::vector<Skin> skins;
    Camera camera{{0, 0, 10}, {0, 0, 0}, Vec3::UnitY(), 0.8, 0.1, 1000};
    std::vector<Light> lights{{LightKind::point, {0, 0, 10}}};
    std::vector<Explosion> explosions;
};

inline std::array<int, 3> at(const Image& image, int x, int y) {
    const std::size_t first = 3 * (static_cast<std::size_t>(y) * image.width + x);
    return {image.pixels[first], image.pixels[first + 1], image.pixels[first + 2]};
}
inline std::array<int, 3> at(const Image& image, const Pixel& p) {
    return at(image, static_cast<int>(p.x), static_cast<int>(p.y));
}
inline int brightness(const std::array<int, 3>& colour) { return colour[0] + colour[1] + colour[2]; }

// The pixels in which two pictures differ.
struct Difference {
    int count = 0;
    int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;

    double width() const { return right - left + 1; }
    double height() const { return bottom - top + 1; }
};

inline Difference difference(const Image& a, const Image& b) {
    Difference d;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            if (at(a, x, y) == at(b, x, y)) continue;
            ++d.count;
            d.left = std::min(d.left, x), d.right = std::max(d.right, x);
            d.top = std::min(d.top, y), d.bottom = std::max(d.bottom, y);
        }
    return d;
}

}  // namespace kolize::test
