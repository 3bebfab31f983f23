// When two moving bodies meet: conservative advancement over the pairs of features that can come close.
//
// Source   Mirtich, "Impulse-based dynamic simulation of rigid body systems", 1996, 2.3 (conservative advancement);
//          Zhang, Lee & Kim, "Interactive continuous collision detection for non-convex polyhedra", 2006 (C2A: bounds
//          on hierarchies); Catto, "Continuous collision", GDC 2013 (the separating axis turns with its features).
// A box pair or feature pair is left out for a span of time when a plane between the two stays between them for all of
// it, by a bound of second order in time. What is left is advanced feature pair by feature pair, always the one that is
// known safe for the shortest time, until one of them touches and approaches or all are safe to the end.
#pragma once

#include "sweep/moving_pair.h"

#include <vector>

namespace kolize {

struct ImpactScratch {
    struct Candidate {
        double time = 0;             // the features are known to be apart until then
        std::uint32_t a = 0, b = 0;  // triangles
    };
    std::vector<Candidate> candidates;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack;

    void reserve();
};

// See Narrowphase::find_impacts.
double find_impact(const MovingPair& pair, double from, double until, ImpactScratch& scratch);

// Calls visit(triangle of A, triangle of B) for feature pairs that a test of boxes does not keep farther apart than
// `reach` from the moment on for `span` seconds. False from visit ends the search.
template <class Visit>
void visit_near(const MovingPair& pair, const PairMoment& moment, double reach, double span, ImpactScratch& scratch,
                Visit&& visit);

}  // namespace kolize

#include "sweep/visit_near.h"
