// One ring of stages around one world: what a stepping strategy drives.
#pragma once

#include "cull.h"
#include "ledger.h"
#include "measure.h"

#include <kolize/observer.h>
#include <kolize/simulation.h>

#include <utility>

namespace kolize {

struct Rule {
    const LoadedPlugin* plugin;
    StagePtr<Response> stage;
    std::vector<std::string> kinds;
    Detail detail;                  // what the narrowphase is asked for on behalf of this rule
    std::vector<Contact> contacts;  // of this step, canonical order
    std::vector<std::size_t> rows;  // where they stand in Pipeline::contacts
    std::vector<std::uint8_t> hit;  // see ResponseInput
    std::vector<BodyState> before;  // of the two bodies of each contact: to find out over which one the rule failed
};

class Pipeline {
public:
    Pipeline(const Scene& scene, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps);

    // Free motion of all bodies.
    void integrate(double dt);
    // Pairs and contacts of the present poses. Measures nothing but time: a stepping may look as often as it likes.
    void detect();
    // Hands the contacts to their rules and takes removed bodies out. `settle`: see ResponseInput.
    void respond(double dt, double settle = 0);

    // Contacts whose bodies approach each other at the contact point.
    bool approaching() const;

    // For steppings that follow each pair by itself through the step. A candidate is a pair that a rule takes and whose
    // boxes overlap somewhere on the way from now until a time of the flow.
    void find_candidates(const Flow& flow, double until);
    void update_swept_bounds(const Flow& flow, double until);
    // The same for what a body may meet now that its motion has changed: appends those that are not there yet.
    void add_candidates_of(std::uint32_t body, const Flow& flow, double from, double until);
    const std::vector<Pair>& candidates() const { return routed_; }
    // times[i] for pairs[i]: see Narrowphase::find_impacts.
    void find_impacts(std::span<const Pair> some_pairs, const Flow& flow, double from, double until,
                      std::span<double> times);
    // Appends a candidate's rows to `contacts`, at the world's present poses; false if there are none. `touching` and
    // `reach`: see Narrowphase::find_touching.
    bool add_contacts(std::size_t candidate, bool touching, double reach = 0);
    // Gives bodies the velocity that the forces which do not change would give them in `time` seconds; below 0 it is
    // taken back.
    void kick(std::span<const std::uint32_t> bodies, const Flow& flow, double time);
    // Puts rows that were added one pair at a time into canonical order.
    void sort_contacts();
    bool is_detailed(std::size_t candidate) const { return detail_[candidate] != Detail::overlap; }
    // To be called for every body and stretch of motion that is not done by integrate().
    // Throws where the motion leads to something that is not finite.
    void moved(std::uint32_t body, const BodyState& before, const BodyState& after, double time);
    const Integrator& integrator() const { return *integrator_; }
    [[noreturn]] void refuse_motion(const std::string& what) const;

    // Poses and velocities, kept in buffers that are allocated once.
    void save();
    void restore();
    // Puts one body's pose back to the saved one. It keeps its velocity, and its angular velocity in its own frame.
    void put_back(std::uint32_t body);

    void begin_step(double dt);
    void end_step(double dt);
    // Of a run from its beginning; a capsule's run begins later.
    std::uint64_t step_number() const { return first_step_ + measure.steps; }

    // In pipeline_inputs.cpp: what is put in between two steps. Throws std::invalid_argument, before anything changes.
    void put_in(const ForcesInput& input);
    void put_in(const LoadInput& input);
    void put_in(const PlaceInput& input);
    void put_in(const RemoveInput& input);
    // Goes on where another pipeline of the same scene has come to; the walls of the rooms are each pipeline's own.
    void take_over(const Pipeline& before);
    // What the rules' responses remember, rule by rule.
    void save_memory(std::vector<ResponseMemory>& memory) const;

    void outline(Outline& outline) const;
    void find_crossings(std::vector<CrossingLine>& crossings) const;

    World world;
    std::vector<Pair> pairs;
    Contacts contacts;
    std::vector<Event> events;
    Measure measure;
    std::optional<Ledger> ledger;

    // Lets whoever looks on see something; the time that takes is left out of the step's.
    template <class Call>
    void show(Call&& call) {
        const auto start = StageClock::Clock::now();
        for (Observer* observer : observers) call(*observer);
        shown_ += StageClock::Clock::now() - start;
    }
    StageClock::Clock::duration take_time_shown() { return std::exchange(shown_, {}); }
    std::vector<Observer*> observers;

    const LoadedPlugin* broadphase_plugin;
    const LoadedPlugin* narrowphase_plugin;
    StagePtr<Broadphase> broadphase;
    StagePtr<Narrowphase> narrowphase;
    std::vector<Rule> rules;
    ShapeKind walls = ShapeKind::half_space;

private:
    static constexpr std::uint32_t no_rule = ~0u, no_row = ~0u;

    void require_dynamic(std::uint32_t body) const;
    void wake_all() { world.asleep.assign(world.size(), 0); }
    void restore_memory(const Scene& scene);
    void negotiate(const PipelineConfig& config, const PluginLibrary& plugins);
    void use_bounding_spheres();
    void reserve();
    void number_rows();
    void update_bounds();
    BroadphaseInput broadphase_input() const { return {bounds_, row_is_static_, generation_, row_is_reference_}; }
    void find_pairs();
    void add_half_space_pairs();
    bool reaches_behind(const Aabb& box, std::uint32_t wall) const;
    void route_pairs();
    void cull_pairs();
    bool route(const Pair& pair);
    void require_fit(const Contact& contact, const Pair& asked, Detail detail, bool touching) const;
    void find_contacts();
    void respond_with(Rule& rule, double dt, double settle);
    void swap_places(Rule& rule);
    void remove_bodies();

    // In pipeline_checks.cpp: nothing that is not a number leaves the stage that made it.
    [[noreturn]] void fail(const char* stage, const std::string& plugin, const std::string& what) const;
    void require_finite_motion(std::uint32_t body, const BodyState& after) const;
    [[noreturn]] void refuse_path(std::uint32_t body, const BodyState& end) const;  // whose bounds are not finite
    void require_finite_response(const Rule& rule, double dissipated_J, std::size_t first_event) const;
    void require_finite_world() const;
    void require_times(std::span<const Pair> some_pairs, double from, std::span<const double> times) const;
    std::string blamed_pair(std::span<const Pair> some_pairs, std::span<const Detail> detail) const;
    std::string blamed_pair(const Rule& rule, double dt) const;

    // `blame` gives the pair that a call failed over, as " (bodies 1 and 2)", or "".
    template <class Call, class Blame>
    void run_stage(StageKind kind, const char* plugin, Call&& call, Blame&& blame);

    Host& host_;
    std::string integrator_name_;
    std::unique_ptr<Integrator> integrator_;
    std::uint64_t first_step_ = 0;
    std::size_t scene_bodies_;  // those after them are walls
    std::vector<Room> rooms_;
    std::uint64_t expected_steps_;
    LedgerConfig ledger_config_;
    std::vector<std::uint32_t> rule_of_kinds_;  // kinds x kinds -> rule; no_rule where none fits
    std::vector<std::uint32_t> rows_;           // broadphase row -> body
    std::vector<std::uint32_t> row_of_;         // body -> broadphase row; no_row for a half-space or a removed body
    std::vector<std::uint32_t> unbounded_;      // half-space bodies
    std::vector<Aabb> bounds_;                  // by row
    std::vector<std::uint8_t> row_is_static_;
    std::vector<std::uint8_t> row_is_reference_;  // empty where there is none
    std::uint64_t generation_ = 0;
    std::vector<Pair> found_;   // what the broadphase said, rows
    std::vector<Pair> routed_;  // pairs that a rule takes and whose boxes do overlap
    std::vector<Detail> detail_;
    std::vector<std::uint32_t> rule_;  // by routed pair
    std::optional<Cull> cull_;
    Contacts one_pair_;
    StageClock::Clock::duration shown_{};
    std::vector<std::uint8_t> is_partner_;  // by body
    std::vector<BodyState> before_;         // by body
    std::vector<std::uint8_t> swapped_;     // by body
    struct Saved {
        std::vector<Vec3> position, velocity, angular_velocity;
        std::vector<Quat> orientation;
    } saved_;
};

}  // namespace kolize
