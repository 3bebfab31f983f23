#include "viewer/orbit_camera.h"

#include <algorithm>
#include <cmath>

namespace kolize::cli {

void OrbitCamera::handle(const WindowEvent& event, int height) {
    const double dx = event.x - x_, dy = event.y - y_;
    switch (event.kind) {
    case WindowEventKind::button_down: (event.button == 0 ? turning_ : shifting_) = true; break;
    case WindowEventKind::button_up: (event.button == 0 ? turning_ : shifting_) = false; break;
    case WindowEventKind::pointer:
        if (turning_) turn(-4 * dx / height, 4 * dy / height);
        if (shifting_) shift(dx, dy, height);
        break;
    case WindowEventKind::scroll:
        camera_.eye = camera_.target + std::pow(0.9, event.y) * (camera_.eye - camera_.target);
        return;  // x and y are no place
    default: return;
    }
    x_ = event.x;
    y_ = event.y;
}

// About the upward direction, then up and down, as far as a little short of it.
void OrbitCamera::turn(double dx, double dy) {
    const Vec3 up = camera_.up.normalized();
    Vec3 arm = Eigen::AngleAxisd(dx, up) * (camera_.eye - camera_.target);
    const double height = std::asin(std::clamp(arm.normalized().dot(up), -1.0, 1.0));
    const double wanted = std::clamp(height + dy, -1.5, 1.5);
    arm = Eigen::AngleAxisd(wanted - height, arm.cross(up).normalized()) * arm;
    camera_.eye = camera_.target + arm;
}

// What lies at the target's distance goes with the pointer.
void OrbitCamera::shift(double dx, double dy, int height) {
    const Vec3 sight = camera_.target - camera_.eye;
    const double metres = 2 * std::tan(0.5 * camera_.field_of_view) * sight.norm() / height;  // a pixel
    const Vec3 right = sight.cross(camera_.up).normalized(), up = right.cross(sight).normalized();
    const Vec3 way = metres * (dy * up - dx * right);
    camera_.eye += way;
    camera_.target += way;
}

}  // namespace kolize::cli
