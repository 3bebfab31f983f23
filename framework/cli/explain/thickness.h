// How thin things are, how far they move in a step, and whether a step may carry one through another.
#pragma once

#include <kolize/simulation.h>

#include <optional>
#include <vector>

namespace kolize::cli {

// The length of the shortest way straight through a shape, m; infinite for a half-space. Of a mesh the shortest of the
// ways inward from the middles of some of its triangles: it may be thinner where two faces meet in an edge.
double thickness(const Shape& shape);

// A body that moves so far in a step that it may be on the other side of another one before anybody has looked.
struct Leap {
    std::uint32_t body = 0;
    double travel = 0;       // m in a step, its own and that of the fastest other body
    double room = infinity;  // m: its thickness and that of the thinnest thing that it may meet
    double share() const { return travel / room; }
};

// Steppings that look at the ends of steps only rest on small leaps; `continuous` does not, and half-spaces have no
// other side.
class LeapWatch {
public:
    LeapWatch(const World& world, double dt);

    // Whether it was made for these bodies: another pipeline may have other walls.
    bool fits(const World& world, double dt) const { return world.size() == thickness_.size() && dt == dt_; }
    // The largest leap, by its share, that the present velocities make; linear in the number of bodies.
    Leap largest(const World& world) const;

private:
    double dt_;
    std::vector<double> thickness_;            // of each body
    std::vector<std::uint32_t> thinnest_two_;  // bodies
};

}  // namespace kolize::cli
