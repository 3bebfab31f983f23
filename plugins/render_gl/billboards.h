// Draws explosions: squares that turn to the eye and play the pictures of a sprite sheet.
#pragma once

#include "program.h"
#include "view.h"

#include <string>

namespace kolize::gl {

// How a billboard turns (Akenine-Moeller, Haines and Hoffman, Real-Time Rendering, 2018, 13.6).
struct BillboardStyle {
    bool cylindrical = false;     // turns about the camera's up direction only; else freely
    bool screen_aligned = false;  // parallel to the picture; else facing the eye
    double scale = 4;             // half side over the radius of the body that exploded
    double fps = 24;              // pictures a second
    std::size_t pool = 256;       // at most so many at once: the newest
};

class Billboards {
public:
    Billboards();

    // Those that are playing at the frame's time, the farthest first.
    void draw(const Frame& frame, const View& view, const BillboardStyle& style);

private:
    struct Sprite {
        Eigen::Vector3f center, across, upward;
        float number;  // of the picture
    };
    void collect(const Frame& frame, const View& view, const BillboardStyle& style);

    Program program_;
    VertexArray array_;
    Buffer buffer_;
    Texture sheet_;
    std::vector<Sprite> sprites_;  // kept between frames, so that nothing is allocated in warm ones
};

}  // namespace kolize::gl
