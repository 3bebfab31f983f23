#include "camera.h"

#include <algorithm>
#include <cmath>

namespace kolize::tunnel {
namespace {

constexpr double usual_distance = 17, nearest = 7, farthest = 70;  // m
constexpr double softness = 0.22;                                  // s
constexpr double zoom_rate = 1;                                    // 1/s: times e in a second
constexpr double free_speed = 15;                                  // m/s
constexpr double free_turn = 1;                                    // rad/s
const Vec3 above(0, 0.24, 0);           // eye over what it follows, in shares of the distance
const Vec3 pilots_seat(1, 1.3, 0);      // m, in the pilot's axes
const Vec3 before_the_nose(9, 2.5, 0);  // m, likewise: to look back from
const Vec3 missile_tail(-0.3, 0.08, 0);
const Quat a_little_down(Eigen::AngleAxisd(-0.1, Vec3::UnitZ()));

}  // namespace

const char* to_string(View view) {
    static constexpr const char* names[] = {"free", "behind the fighter", "on the fighter", "on the missile"};
    return names[static_cast<int>(view)];
}

void CameraMan::start(const Subject& fighter) {
    view_ = View::behind;
    aims_at_fighter_ = false;
    distance_ = usual_distance;
    late_ = fighter.axes;
}

void CameraMan::next_view(const Subject& fighter, const Subject* missile) {
    const Camera now = camera(fighter, missile);
    const int views = missile ? 4 : 3;
    view_ = static_cast<View>((static_cast<int>(view_) + 1) % views);
    if (view_ != View::free) return;
    const Vec3 forward = (now.target - now.eye).normalized(), right = forward.cross(now.up).normalized();
    Mat3 axes;
    axes << forward, right.cross(forward), right;
    free_ = {Quat(axes), now.eye};
}

void CameraMan::follow(const Subject& fighter, const Subject* missile, const Demand& demand, double zoom, double dt) {
    if (view_ == View::on_missile && !missile) view_ = View::behind;
    late_ = late_.slerp(1 - std::exp(-dt / softness), fighter.axes).normalized();
    distance_ = std::clamp(distance_ * std::exp(zoom * zoom_rate * dt), nearest, farthest);
    if (view_ != View::free) return;
    const Vec3 turn = dt * free_turn * demand.turn;
    if (!turn.isZero(0))
        free_.axes = (free_.axes * Quat(Eigen::AngleAxisd(turn.norm(), turn.normalized()))).normalized();
    free_.position += free_.axes * (dt * free_speed * demand.thrust);
}

Camera CameraMan::looking(const Quat& axes, const Vec3& eye, const Vec3& fighter) const {
    Camera camera;
    camera.eye = eye;
    const Vec3 to_fighter = fighter - eye;
    const bool at_fighter = aims_at_fighter_ && to_fighter.norm() > 1e-3;
    const Vec3 sight = at_fighter ? Vec3(to_fighter.normalized()) : axes * Vec3::UnitX();
    camera.target = eye + sight;
    camera.up = axes * Vec3::UnitY();
    if (camera.up.cross(sight).norm() < 1e-3) camera.up = axes * Vec3::UnitX();
    camera.field_of_view = 1.0;
    camera.near = 0.2;
    camera.far = 900;
    return camera;
}

Camera CameraMan::camera(const Subject& fighter, const Subject* missile) const {
    switch (view_) {
    case View::free: return looking(free_.axes, free_.position, fighter.position);
    case View::on_missile:
        if (missile) {
            const Vec3 eye = missile->position + missile->axes * (distance_ * missile_tail);
            return looking(missile->axes, eye, fighter.position);
        }
        [[fallthrough]];
    case View::behind: {
        const Quat axes = late_ * a_little_down;
        return looking(axes, fighter.position + late_ * (distance_ * (above - Vec3::UnitX())), fighter.position);
    }
    default: {
        const Vec3& seat = aims_at_fighter_ ? before_the_nose : pilots_seat;
        return looking(fighter.axes, fighter.position + fighter.axes * seat, fighter.position);
    }
    }
}

}  // namespace kolize::tunnel
