// Where the flight is seen from.
#pragma once

#include "flight.h"

#include <kolize/renderer.h>

namespace kolize::tunnel {

enum class View { free, behind, on_fighter, on_missile };

const char* to_string(View view);

// What a camera follows: pilot's axes to world, and the centre, m.
struct Subject {
    Quat axes = Quat::Identity();
    Vec3 position = Vec3::Zero();
};

// All of it is set: how the camera is turned first, then where it stands because of that.
class CameraMan {
public:
    // Takes its place behind the fighter at once.
    void start(const Subject& fighter);

    // The view after this one; that of the missile only while one flies.
    void next_view(const Subject& fighter, const Subject* missile);
    void change_aim() { aims_at_fighter_ = !aims_at_fighter_; }
    // Once a step. `zoom` above 0 goes farther away, below 0 nearer. The demand moves the free camera. Where the
    // missile is gone (null), the view behind the fighter takes over.
    void follow(const Subject& fighter, const Subject* missile, const Demand& demand, double zoom, double dt);

    Camera camera(const Subject& fighter, const Subject* missile) const;
    View view() const { return view_; }
    bool aims_at_fighter() const { return aims_at_fighter_; }

private:
    Camera looking(const Quat& axes, const Vec3& eye, const Vec3& fighter) const;

    View view_ = View::behind;
    bool aims_at_fighter_ = false;
    double distance_ = 0;  // m, behind what is followed
    Quat late_;            // follows the fighter's axes softly
    Subject free_;
};

}  // namespace kolize::tunnel
