// What a run costs and how well it keeps what physics keeps. Formulas: docs/accuracy.md.
#pragma once

#include <kolize/simulation.h>

#include <array>
#include <chrono>

namespace kolize {

enum class Phase : std::size_t { integrate, broadphase, narrowphase, response, step, count };

// Time per stage and step. Samples are kept in memory that was reserved before the first step.
class StageClock {
public:
    using Clock = std::chrono::steady_clock;

    void reserve(std::uint64_t steps);
    void add(Phase phase, Clock::duration time) { open_[static_cast<std::size_t>(phase)] += time; }
    void end_step();
    StageTime summary(Phase phase) const;
    double latest_us(Phase phase) const;

private:
    static constexpr auto phases = static_cast<std::size_t>(Phase::count);
    std::array<Clock::duration, phases> open_{};
    std::array<std::vector<float>, phases> samples_us_;
};

// Sums over the dynamic bodies that are still there.
struct Totals {
    double kinetic = 0;                    // J
    double potential = 0;                  // J, of gravity and constant forces, from the reference point
    Vec3 momentum = Vec3::Zero();          // N s
    Vec3 angular_momentum = Vec3::Zero();  // N m s, about the reference point
    double energy() const { return kinetic + potential; }
};

// What came into or left the system in ways the scene declares; taken off before anything is called drift.
struct Exchange {
    double work = 0;                      // J: drag, torques, restitution below 1, removed bodies
    Vec3 impulse = Vec3::Zero();          // N s: forces, static bodies, removed bodies
    Vec3 angular_impulse = Vec3::Zero();  // N m s, about the reference point
};

class Measure {
public:
    StageClock clock;
    std::uint64_t pairs = 0, contacts = 0, triangle_tests = 0, events = 0, unresolved = 0, failures = 0;
    std::uint64_t steps = 0;

    void start(const World& world, const std::vector<Room>& rooms, std::uint64_t expected_steps);

    // Forces act on what moves: `moved` wants to be told. Without forces it need not be called.
    bool watches_motion() const { return has_forces_ || has_losses_; }
    // A live body has moved freely for `time` seconds.
    void moved(const World& world, std::uint32_t body, const BodyState& before, const BodyState& after, double time);
    // After the response: impulses from static bodies, energy that restitution took, depths, which pairs touch.
    // Pairs that may rest on each other are never stuck.
    void after_response(const World& world, const std::vector<Contact>& contacts, double dissipated_J, bool rests);
    // J, of what is done to velocities besides motion and response.
    void add_work(double work) { exchange_.work += work; }
    // Whatever `alter` does to the world counts as exchanged.
    template <class Alter>
    void change(const World& world, Alter&& alter) {
        const Totals before = totals(world);
        alter();
        account_for(world, before);
    }
    // Before body leaves the world.
    void before_removal(const World& world, std::uint32_t body);
    void end_step(const World& world, double dt);

    // The exchange so far can be set aside and brought back when a stepping takes a motion back.
    void save() { saved_ = exchange_; }
    void restore() { exchange_ = saved_; }

    void write(const World& world, RunResult& result) const;
    Reading reading() const;

private:
    Totals totals(const World& world) const;
    void account_for(const World& world, const Totals& before);
    void watch(const World& world, std::uint32_t body);
    void add_body(const World& world, std::uint32_t body, const BodyState& state, Totals& totals) const;
    Vec3 force_on(const World& world, std::uint32_t body) const;
    void set_scales(const World& world);
    void measure_drift(const World& world);
    void count_escapes(const World& world);
    void count_stuck(double dt);

    std::vector<Room> rooms_;
    Vec3 reference_ = Vec3::Zero();  // centre of mass of the scene at the start
    bool has_forces_ = false;        // gravity or constant forces: their impulse is known in closed form
    bool has_losses_ = false;        // drag or torques: their work is taken as measured around the motion
    Totals initial_, latest_;
    Exchange exchange_, saved_;
    double energy_scale_ = 0, momentum_scale_ = 0, angular_scale_ = 0;
    double energy_drift_ = 0, momentum_drift_ = 0, angular_drift_ = 0, max_depth_ = 0;

    // Pairs in contact, sorted, and since when without a break.
    struct Touch {
        Pair pair;
        double since = 0;  // simulated s
        bool counted = false;
    };
    std::vector<Pair> touching_;
    std::vector<Touch> open_, next_;
    std::vector<std::uint8_t> has_escaped_;
    std::uint64_t escaped_ = 0, stuck_ = 0;
    double time_ = 0;
};

}  // namespace kolize
