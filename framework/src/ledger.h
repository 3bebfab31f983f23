// The ledger of a run: what every call of a stage may change of the world, and whether it kept to that. Only the first
// break is kept; after it nothing is checked any more. What is checked, and against which limits: docs/ledger.md.
#pragma once

#include "motion_balance.h"

#include <kolize/simulation.h>

namespace kolize {

// "3", or "3 'name'" where it has one.
std::string body_text(const World& world, std::uint32_t body);

class Ledger {
public:
    Ledger(const LedgerConfig& limits, const World& world);

    void begin_step(std::uint64_t step, double time);
    // A body that is neither static nor removed has moved freely for `time` seconds, or was moved by a stepping in no
    // time. `stage` is "integrator" or "stepping".
    void after_motion(const World& world, std::uint32_t body, const BodyState& before, const BodyState& after,
                      double time, const char* stage, const std::string& name);

    // Around every call of a plugin.
    void before_stage(const World& world);
    // Of a broadphase or narrowphase: nothing may have changed, bit for bit.
    void after_search(const World& world, StageKind stage, const char* plugin);
    // The contacts that a response is about to get.
    void check_depths(std::span<const Contact> contacts, const char* narrowphase);
    // `contacts` with the impulses that the response has written. Bodies that settle may gain energy: see
    // ResponseInput.
    void after_response(const World& world, std::span<const Contact> contacts, double dissipated_J, bool settling,
                        const char* plugin);

    const std::optional<LedgerBreak>& first_break() const { return break_; }

private:
    // All that a stage could reach of the bodies. World as in before_stage.
    struct Columns {
        std::vector<Vec3> position, velocity, angular_velocity, inverse_inertia;
        std::vector<Quat> orientation;
        std::vector<double> inverse_mass;
        std::vector<std::uint8_t> is_static, removed;
    };
    // What a body got in one call of a response, by the contacts' own account.
    struct Received {
        Vec3 impulse = Vec3::Zero();  // N s
        Vec3 moment = Vec3::Zero();   // N m s, about the centre of mass
        double impulses = 0;          // N s, sum of the magnitudes
        double moments = 0;           // N m s, likewise
        std::uint32_t parent = 0;     // union-find forest of the bodies that contacts link
        double gained_J = 0;          // of a root: kinetic energy that came to all that are linked to it
        bool in_contact = false;
    };

    void record(const std::string& stage, const std::string& plugin, std::vector<std::uint32_t> bodies,
                const std::string& quantity, const std::string& unit, const Balance& balance);
    void check_untouched(const World& world, const std::string& stage, const char* plugin);
    void check_rest(const World& world, const char* plugin);
    void book(const World& world, std::span<const Contact> contacts);
    void link(const Contact& contact);
    std::uint32_t root(std::uint32_t body);
    void check_momenta(const World& world, std::span<const Contact> contacts, std::uint32_t body, const char* plugin);
    void check_energy(const World& world, std::span<const Contact> contacts, double dissipated_J, bool settling,
                      const char* plugin);
    BodyState state_before(const World& world, std::uint32_t body) const;

    LedgerConfig limits_;
    std::uint64_t step_ = 0;
    double time_ = 0;
    Columns before_;
    std::vector<Received> received_;       // by body
    std::vector<std::uint32_t> involved_;  // dynamic bodies in the contacts at hand, by id
    std::optional<LedgerBreak> break_;
};

}  // namespace kolize
