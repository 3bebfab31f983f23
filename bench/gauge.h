// What a run keeps of what physics keeps, measured alike for every engine from the states of its bodies alone.
#pragma once

#include "engine.h"

namespace bench {

struct Reading {
    double energy_error = 0;            // (E - E0) / scale at the end; E kinetic and of gravity, summed over the bodies
    double worst_energy_error = 0;      // the largest size of that after any step
    double angular_momentum_error = 0;  // largest |L - L0| / |L0| of the bodies' spins, each about its own centre
    double path_ratio = 1;              // way that the centres went, over the sum of their speeds times dt
    std::size_t escaped = 0;            // bodies whose centre was outside of every room, or not finite, after any step
    std::size_t stuck = 0;              // pairs that overlapped after every step for more than 0.5 s
};

// The energy's scale is the kinetic energy at the start and the work of gravity down to the lowest static body.
class Gauge {
public:
    Gauge(const kolize::World& start, const std::vector<kolize::Room>& rooms);

    // After each step of dt seconds.
    void look(const Engine& engine, double dt);
    Reading reading() const;

private:
    struct Totals {
        double energy = 0;
        kolize::Vec3 spin = kolize::Vec3::Zero();
    };
    Totals totals() const;
    double fall_energy() const;
    void count_escapes();
    void count_stuck(const Engine& engine, double dt);

    kolize::World world_;  // as the engine has it after the last step
    std::vector<kolize::Room> rooms_;
    std::vector<std::uint32_t> dynamic_;
    Totals initial_;
    double energy_scale_ = 0;
    double path_ = 0, expected_path_ = 0;  // m
    Reading reading_;
    std::vector<bool> has_escaped_;

    struct Touch {
        kolize::Pair pair;
        double duration = 0;  // s, without a break
    };
    std::vector<kolize::Pair> touching_;
    std::vector<Touch> open_;
};

}  // namespace bench
