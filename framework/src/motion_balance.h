// What free motion may change of a body, and by how much it did otherwise. Formulas: docs/ledger.md.
#pragma once

#include <kolize/scene.h>

namespace kolize {

// By how much a quantity is off, and by how much it may be.
struct Balance {
    double off = 0;
    double limit = 0;

    bool holds() const { return std::abs(off) <= limit; }  // false for NaN
};

struct MotionBalance {
    Balance energy;            // J
    Balance momentum;          // N s
    Balance angular_momentum;  // N m s, about where the centre of mass was before
};

// Of a dynamic body that has moved for `time` seconds under gravity, its constant force and torque, and drag.
MotionBalance balance_of_motion(const World& world, std::uint32_t body, const BodyState& before, const BodyState& after,
                                double time, const LedgerConfig& tolerance);

// Kinetic energy (J) that rounding of the angular velocity alone may make: in a slender body a small error across its
// axis meets a large moment.
double energy_rounding(const World& world, std::uint32_t body, const BodyState& state);
// The largest angular momentum (N m s) that this angular velocity could have in any direction.
double angular_scale(const World& world, std::uint32_t body, const BodyState& state);

}  // namespace kolize
