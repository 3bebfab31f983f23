// A camera that the pointer moves around a place.
#pragma once

#include <kolize/renderer.h>

namespace kolize::cli {

// Dragging with the left button turns it about the target, with another one shifts it; the wheel goes nearer and back.
class OrbitCamera {
public:
    explicit OrbitCamera(const Camera& start) : start_(start), camera_(start) {}

    const Camera& camera() const { return camera_; }
    void reset() { camera_ = start_; }
    // `height` of the picture in pixels.
    void handle(const WindowEvent& event, int height);

private:
    void turn(double dx, double dy);               // rad
    void shift(double dx, double dy, int height);  // pixels

    Camera start_, camera_;
    bool turning_ = false, shifting_ = false;
    double x_ = 0, y_ = 0;
};

}  // namespace kolize::cli
