// Draws thin lines over the picture: once where nothing stands before them, once more and fainter where something does.
#pragma once

#include "program.h"
#include "view.h"

namespace kolize::gl {

class Lines {
public:
    Lines();
    void draw(std::span<const Line> lines, const View& view, int width, int height);

private:
    // A line as the shader takes it.
    struct Instance {
        Eigen::Vector3f from, to;
        Rgba colour;
    };

    Program program_;
    VertexArray array_;
    Buffer buffer_;
    std::vector<Instance> instances_;  // kept between frames, so that nothing is allocated in warm ones
};

}  // namespace kolize::gl
