// Integrators: free motion of all bodies over one step. Framework strategies, chosen by name in [step].
#pragma once

#include <kolize/host.h>
#include <kolize/world.h>

#include <memory>
#include <string>
#include <vector>

namespace kolize {

class KOLIZE_API Integrator {
public:
    virtual ~Integrator() = default;

    // Moves every body that is neither static nor removed by dt seconds (dt > 0) under the world's forces.
    void advance(World& world, double dt, Host& host) const;

protected:
    // The moving bodies of [begin, end), each by its own state and constants and the world's forces alone. One call per
    // chunk of bodies, possibly from several threads at once.
    virtual void advance_bodies(World& world, std::size_t begin, std::size_t end, double dt) const = 0;
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
