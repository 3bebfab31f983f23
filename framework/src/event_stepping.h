// Stepping by events: every pair has its own time of impact, every body its own stretch of free motion.
#pragma once

#include "step_flow.h"
#include "stepping.h"

namespace kolize {

inline bool is_fixed(const World& world, std::uint32_t body) { return world.is_static[body] || world.removed[body]; }

// Impacts of one step are answered in the order of their times. An impact concerns the bodies that touch at that time
// and nobody else: all others go on undisturbed, and only pairs with a body whose velocity changed are looked at again.
// A few fast bodies therefore cost their own impacts and no more.
//
// Bodies that rest on each other would meet again as soon as they are let go. Where meetings become too slow to matter
// (rests()), the response is asked for velocities at which forces that do not change bring the bodies together again
// no sooner than at the end of the step, and there it stops them: the mean over the time is what a contact force would
// give (Moreau, "Unilateral contact and dry friction in finite freedom dynamics", 1988), and nothing overlaps on the
// way.
class EventStepping : public Stepping {
public:
    explicit EventStepping(int max_impacts) : max_impacts_(max_impacts) {}
    void step(Pipeline& pipeline, double dt) final;

protected:
    // times[i]: when candidates[i] begins to touch and approach, not before `from`; infinity if not until `until`.
    virtual void find_impacts(Pipeline& pipeline, std::span<const std::size_t> candidates, double from, double until,
                              std::span<double> times) = 0;
    // Adds rows of a candidate at the world's present poses; false if there are none. `known`: its impact is due.
    // `reach`: see NarrowphaseInput.
    virtual bool add_contacts(Pipeline& pipeline, std::size_t candidate, bool known, double reach) = 0;
    // Whether bodies that keep meeting are brought to rest, and held until the end of the step where even that does not
    // help. Otherwise their pair is left alone.
    virtual bool keeps_apart() const = 0;
    // After the last impact, with all bodies at the end of the step.
    virtual void finish(Pipeline&, double) {}

    const StepFlow& flow() const { return flow_; }

private:
    // Bodies that were let go in this step, and how.
    struct Meeting {
        Pair pair;
        double since = 0;    // s, in this step
        double length = 0;   // s, after which they were to meet again
        double closing = 0;  // m/s^2, by which they close besides what pulls them
    };

    void reserve(std::size_t bodies);
    void find_first_impacts(Pipeline& pipeline, double dt);
    std::size_t next_impact(const Pipeline& pipeline) const;
    bool is_done(const Pipeline& pipeline, std::size_t candidate) const;
    void look_again(Pipeline& pipeline, double time, double dt);
    void answer(Pipeline& pipeline, std::size_t candidate, double dt);
    void gather(Pipeline& pipeline, std::size_t candidate, double dt, bool settling);
    void take_bodies(Pipeline& pipeline, std::size_t candidate, double time);
    bool comes_close(const Pipeline& pipeline, std::size_t candidate, double time, double reach) const;
    void find_changed(Pipeline& pipeline, double time);
    void give_up(Pipeline& pipeline, std::size_t candidate, double time);
    void end_step(Pipeline& pipeline, double dt);

    // In event_stepping_rest.cpp.
    bool rests(const Pipeline& pipeline, std::size_t candidate, double dt) const;
    bool leaves_at_rest(const Pipeline& pipeline) const;
    void settle(Pipeline& pipeline, std::size_t candidate, double dt);
    double reach(const Pipeline& pipeline, std::size_t candidate, double dt, bool settling) const;
    bool add_resting(Pipeline& pipeline, std::size_t candidate, bool known, double reach, double dt);
    void let_go(Pipeline& pipeline, double kick, double length, double dt);
    double gained_energy(const World& world) const;
    double energy_to_spare(const World& world, double change) const;
    void measure_closing(const Pipeline& pipeline, std::size_t candidate);
    Meeting& meeting_of(const Pair& pair);
    double fastest_closing(const World& world, const Pair& pair) const;
    double path_error(const World& world, const Pair& pair) const;
    bool is_known_to_rest(const World& world, const Pair& pair) const;
    double pull(std::span<const std::uint32_t> bodies) const;

    int max_impacts_;
    StepFlow flow_;
    std::vector<double> times_;                  // by candidate
    std::vector<int> impacts_;                   // by candidate, in this step
    std::vector<std::uint8_t> gathered_;         // by candidate
    std::vector<std::uint32_t> bodies_;          // dynamic ones of the impact at hand
    std::vector<BodyState> before_;              // of bodies_, before they were let go
    std::vector<std::uint8_t> is_in_, changed_;  // by body
    std::vector<std::uint8_t> settled_;          // by body: in this step
    std::vector<Meeting> meetings_;              // sorted by pair
    std::vector<std::size_t> again_;             // candidates to look at again
    std::vector<double> again_times_;
};

// Time of impact by the narrowphase's sweep: nothing is missed, nothing overlaps.
std::unique_ptr<Stepping> make_continuous(const StepConfig& config);
// Time of impact by halving between the pose before and the pose after.
std::unique_ptr<Stepping> make_bisection(const StepConfig& config);

}  // namespace kolize
