// The picture of a skin as a texture that repeats, with all its coarser levels.
#pragma once

#include "objects.h"

#include <kolize/renderer.h>

namespace kolize::gl {

class SkinTexture {
public:
    // `repeats` of the picture in a unit of the surface that it is laid on. Throws std::runtime_error for a picture
    // that is larger than this OpenGL takes, or empty.
    SkinTexture(const Image& image, double repeats);

    GLuint name() const { return texture_.name(); }
    float repeats() const { return repeats_; }

private:
    Texture texture_;
    float repeats_;
};

}  // namespace kolize::gl
