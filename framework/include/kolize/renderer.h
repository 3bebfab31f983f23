// Renderer: makes pictures of a world after a step. It reads the world and the events and never writes them.
#pragma once

#include <kolize/room.h>
#include <kolize/stage.h>
#include <kolize/window.h>
#include <kolize/world.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kolize {

// Where the picture is taken from. World frame, m.
struct Camera {
    Vec3 eye = Vec3::UnitZ();
    Vec3 target = Vec3::Zero();  // in the middle of the picture
    Vec3 up = Vec3::UnitY();     // any length; not along the line of sight
    double field_of_view = 0.9;  // vertical, rad
    double near = 0.1;           // what is nearer or farther than this along the line of sight is not drawn, m
    double far = 1000;
};

enum class LightKind : std::uint32_t { point, spot };

// Its brightness falls smoothly to nothing at its range.
struct Light {
    LightKind kind = LightKind::point;
    Vec3 position = Vec3::Zero();            // m; world frame, or the model frame of the body it is attached to
    Vec3 direction = -Vec3::UnitY();         // spot: where it shines, any length; same frame
    Vec3 colour = Vec3::Ones();              // red, green, blue; linear, 1 is full
    double range = 100;                      // m
    double cone = 0.5;                       // spot: half the angle of the cone, rad, below pi / 2
    std::optional<std::uint32_t> body = {};  // attached to this one
};

struct Explosion {
    Vec3 position = Vec3::Zero();  // world frame, m
    double radius = 1;             // of the body that exploded, m
    double start = 0;              // simulated time, s
};

using Rgba = std::array<std::uint8_t, 4>;  // red, green, blue in sRGB, and the opacity

// One pixel wide or little more; seen through what stands before it, but fainter. World frame, m.
struct Line {
    Vec3 from = Vec3::Zero();
    Vec3 to = Vec3::Zero();
    Rgba colour = {255, 255, 255, 255};
};

// Text over the picture; it may have several lines. Lengths are shares of the picture's width (x) and height.
struct Caption {
    std::string text;
    double x = 0, y = 0;                // of the anchor, from the left and from the top
    double anchor_x = 0, anchor_y = 0;  // the anchor in the text: 0 its left or upper border, 1 its right or lower one
    double height = 0.03;               // of a line
    Rgba colour = {255, 255, 255, 255};
};

// All that one picture shows.
struct Frame {
    const World& world;
    double time = 0;  // simulated, s
    Camera camera;
    std::span<const Light> lights;  // a renderer may leave out all but the first eight
    std::span<const Explosion> explosions;
    std::span<const Line> lines = {};
    std::span<const Caption> captions = {};
};

// Three bytes a pixel (red, green, blue; sRGB), row by row from the top.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;
};

// A picture that covers the bodies of one shape, laid on along the three axes of the body frame.
struct Skin {
    std::uint32_t shape = 0;
    Image image;
    double side = 1;  // m, of the picture on the body; it repeats
};

// What does not change from frame to frame, besides the world's shapes.
struct Scenery {
    std::span<const Room> rooms;
    std::span<const Skin> skins = {};
};

// Contract (held by the conformance suite for every plugin):
// - the same frame gives the same bytes on the same machine, whatever was drawn before;
// - rooms are drawn by their inner sides only, and room walls (is_room_wall) not as bodies;
// - removed bodies, and bodies whose pose is not finite, are not drawn.
// Members are called by one thread and in this order: open or open_window, prepare, then draw and read_pixels as often
// as wanted.
class KOLIZE_API Renderer : public Stage {
public:
    static constexpr StageKind kind = StageKind::render;

    // Makes a picture of this size, in pixels, to draw on; needs no display. Throws std::runtime_error with one
    // sentence where the machine cannot.
    virtual void open(int width, int height) = 0;
    // The same in a window, whose size in pixels the pictures have from then on; they are the same pictures. The window
    // lives as long as the renderer. Throws std::runtime_error with one sentence where there is no display, or where
    // the renderer opens no windows (as here).
    virtual Window& open_window(const std::string& title, int width, int height);
    // Takes over the shapes of this world and the scenery; may be called again. Frames drawn later are of this world,
    // or of one with the same bodies in other places.
    virtual void prepare(const World& world, const Scenery& scenery) = 0;
    virtual void draw(const Frame& frame) = 0;
    // The frame drawn last. Resizes the image as needed.
    virtual void read_pixels(Image& image) = 0;
};

}  // namespace kolize
