// Integrators: free motion of all bodies over one step. Framework strategies, chosen by name in [step].
#pragma once

#include <kolize/host.h>
#include <kolize/flow.h>

#include <memory>
#include <string>
#include <vector>

namespace kolize {

class KOLIZE_API Integrator {
public:
    virtual ~Integrator() = default;

    // Moves every body that is neither static nor removed by dt seconds (dt > 0) under the world's forces.
    void advance(World& world, double dt, Host& host) const;
    // The same for one body that is neither static nor removed, from a state of its own: its constants and the forces
    // are the world's. Several threads may call at once.
    virtual void advance_body(const World& world, std::uint32_t body, double dt, BodyState& state) const = 0;

    // Bounds of the motion over `time` seconds from the state, done in calls of at most `call` seconds each.
    MotionBound bound(const World& world, std::uint32_t body, const BodyState& state, double time, double call) const;

protected:
    // Sets the two errors of the bound, whose other fields are known.
    virtual void set_errors(const World& world, std::uint32_t body, double call, MotionBound& bound) const = 0;
};

// semi_implicit_euler  v += h a, then x += h v; omega kept constant in free rotation (no gyroscopic term)
// momentum_euler       the thesis's: angular momentum kept, orientation by one explicit Euler step with normalisation;
//                      kinetic energy grows at every step unless the body spins about a principal axis
// pdmv4                preprocessed discrete Moser-Veselov, order 4 (Hairer & Vilmart, J. Phys. A 39 (2006) 13225),
//                      with the exact parabola for gravity: energy and angular momentum kept to rounding
// Throws std::invalid_argument for another name.
KOLIZE_API std::unique_ptr<Integrator> make_integrator(const std::string& name);
KOLIZE_API const std::vector<std::string>& integrator_names();

}  // namespace kolize
