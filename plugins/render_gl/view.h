// What camera and lights are to the shaders. Everything is handed over relative to the eye, in world axes: differences
// are taken in double precision, so that a scene far from the origin loses nothing in the floats.
#pragma once

#include "objects.h"

#include <kolize/renderer.h>

namespace kolize::gl {

// The camera of one frame.
struct View {
    View(const Camera& camera, double aspect);

    Eigen::Vector3f from_eye(const Vec3& place) const { return (place - eye).cast<float>(); }

    Vec3 eye;
    Vec3 right, up, back;  // unit, world axes
    double far;            // m
    double cotangent;      // of half the vertical field of view
    Eigen::Matrix4f clip;  // from places relative to the eye to clip coordinates
};

// The uniform block "Lighting" of the shaders.
class Lighting {
public:
    static constexpr int max_lights = 8;
    static constexpr GLuint binding = 0;

    void upload(const Frame& frame, const View& view);

private:
    Buffer buffer_;
};

}  // namespace kolize::gl
