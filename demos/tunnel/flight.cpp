#include "flight.h"

#include <algorithm>

namespace kolize::tunnel {
namespace {

// One pair of engines, forward and backward.
struct Axis {
    double inertia;  // kg or kg m^2
    double maximum;  // N or N m
    double settle;   // s
    bool damps;      // where nothing is asked for
};

double engine(const Axis& axis, double share, double speed, double wanted_speed) {
    const double push =
        share != 0 || !axis.damps ? share * axis.maximum : axis.inertia * (wanted_speed - speed) / axis.settle;
    return std::clamp(push, -axis.maximum, axis.maximum);
}

}  // namespace

Demand demand_of(const std::set<Key>& held) {
    const auto is = [&](Key key) { return held.contains(key) ? 1.0 : 0.0; };
    const auto letter = [&](char key) { return is(static_cast<Key>(key)); };
    Demand demand;
    demand.thrust = {letter('W') - letter('S'), letter('E') - letter('Q'), letter('D') - letter('A')};
    const double sideways = is(Key::left) - is(Key::right);
    const bool rolls = held.contains(Key::control);
    const double nose_up = letter('G') > 0 ? 0 : is(Key::up) - is(Key::down);
    demand.turn = {rolls ? -sideways : 0, rolls ? 0 : sideways, nose_up};
    demand.full_stop = held.contains(Key::space);
    return demand;
}

Load engine_load(const Engines& engines, const Demand& demand, Control control, const Motion& motion) {
    const bool damps = control == Control::autopilot || demand.full_stop;
    const double listens = demand.full_stop ? 0 : 1;
    const Vec3 velocity = motion.axes.conjugate() * motion.velocity;
    const Vec3 spin = motion.axes.conjugate() * motion.angular_velocity;
    Load load;
    for (int i = 0; i < 3; ++i) {
        load.force[i] = engine({engines.mass, engines.max_force[i], engines.settle, damps}, listens * demand.thrust[i],
                               velocity[i], 0);
        load.torque[i] = engine({engines.inertia[i], engines.max_torque[i], engines.settle, damps},
                                listens * demand.turn[i], spin[i], listens * demand.turn_rate[i]);
    }
    return {motion.axes * load.force, motion.axes * load.torque};
}

}  // namespace kolize::tunnel
