// Steppings: how the stages are called to get from one step to the next. Chosen by [step] mode.
#pragma once

#include "pipeline.h"

namespace kolize {

class Stepping {
public:
    virtual ~Stepping() = default;
    virtual void step(Pipeline& pipeline, double dt) = 0;
};

// discrete   move everything, then answer the contacts found; bodies may overlap for some steps
// rollback   the thesis's: whatever touches after the motion goes back to its last pose; at the end of a step nothing
//            overlaps that was free before. Putting bodies back does not keep potential energy or angular momentum.
// bisection  the thesis's "optimised pseudo-dynamic": the first approaching contact of each pair in the step is found
// in
//            time by halving, to tolerance * dt, and the pair goes on from there. What overlaps only in between is
//            missed.
// continuous the same with times of impact from the narrowphase's sweep: nothing is missed, at any speed or spin, and
//            nothing overlaps. Bodies that lie on each other are at rest: see event_stepping.h.
// Throws std::invalid_argument for another mode.
std::unique_ptr<Stepping> make_stepping(const StepConfig& config);

}  // namespace kolize
