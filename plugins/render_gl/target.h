// What is drawn on: an image of several samples a pixel, and the plain one that it is resolved into and read from.
#pragma once

#include "objects.h"

#include <kolize/renderer.h>

namespace kolize::gl {

class Target {
public:
    // Throws std::runtime_error for a size or a number of samples that this OpenGL does not take.
    Target(int width, int height, int samples);

    double aspect() const { return static_cast<double>(width_) / height_; }
    int width() const { return width_; }
    int height() const { return height_; }
    // Everything drawn from now on goes here, on an empty picture of this colour (linear).
    void clear(const float (&colour)[3]);
    void read(Image& image);
    // To the window whose context is current, from its lower left corner.
    void copy_to_window(int width, int height);

private:
    void resolve();

    int width_;
    int height_;
    Framebuffer drawn_, resolved_;
    Renderbuffer drawn_colour_, drawn_depth_, resolved_colour_;
    std::vector<std::uint8_t> bottom_up_;
};

}  // namespace kolize::gl
