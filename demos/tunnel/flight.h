// The pilot's controls become the force and torque of the fighter's engines: pure functions, without memory.
//
// Pilot's axes: x forward (roll), y up (yaw), z to the right (pitch); they are the axes of the fighter's model. Each of
// them has four virtual engines: a force and a torque, both ways.
#pragma once

#include <kolize/input.h>
#include <kolize/window.h>

#include <set>

namespace kolize::tunnel {

enum class Control {
    relative,  // engines do what the pilot asks for and nothing else
    autopilot  // and damp what the pilot does not ask for
};

struct Engines {
    double mass = 1000;                      // kg, of the fighter
    Vec3 inertia = Vec3::Constant(1000);     // about the pilot's axes, kg m^2
    Vec3 max_force = Vec3::Constant(1000);   // N, along each axis, either way
    Vec3 max_torque = Vec3::Constant(1000);  // N m, likewise
    double settle = 0.1;  // s; the autopilot's, not below one step: what it damps falls by exp(-1) in it
};

// What the pilot asks for. Shares are of the engine's maximum, -1 to 1; 0 asks for nothing.
struct Demand {
    Vec3 thrust = Vec3::Zero();
    Vec3 turn = Vec3::Zero();
    Vec3 turn_rate = Vec3::Zero();  // rad/s, kept by the autopilot where `turn` asks for nothing
    bool full_stop = false;         // damp everything, whatever else is asked for
};

struct Motion {
    Quat axes = Quat::Identity();          // pilot's axes to world
    Vec3 velocity = Vec3::Zero();          // m/s, world axes
    Vec3 angular_velocity = Vec3::Zero();  // rad/s, world axes
};

struct Load {
    Vec3 force = Vec3::Zero();   // N, world axes
    Vec3 torque = Vec3::Zero();  // N m, world axes
};

// W S: forward, back. A D: left, right. E Q: up, down. Up Down: nose up, down. Left Right: yaw, or roll while Control
// is held. Space: full stop. Opposite keys cancel. While G is held, Up and Down are about gravity.
Demand demand_of(const std::set<Key>& held);

// What the engines do until the next step.
Load engine_load(const Engines& engines, const Demand& demand, Control control, const Motion& motion);

}  // namespace kolize::tunnel
