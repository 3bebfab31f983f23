// The fighter's missiles: a fixed number of bodies, removed until they are fired and again when they are gone.
#pragma once

#include "tunnel_scene.h"

namespace kolize::tunnel {

inline constexpr double missile_speed = 80;         // m/s, over the fighter's
inline constexpr double missile_life = 4;           // s
inline constexpr double time_between_shots = 0.25;  // s

class Magazine {
public:
    Magazine() = default;
    explicit Magazine(std::vector<std::uint32_t> missiles);

    // Appends the removal of missiles that have flown too long and, while the trigger is held, the next shot as soon as
    // one is due and a missile is left. `time`: simulated, s, never less than in the call before.
    void decide(const TunnelScene& tunnel, const World& world, bool trigger, double time, std::vector<Input>& inputs);
    // After a step: missiles that the world has removed fly no more.
    void observe(const World& world);

    // The missile fired last of those that fly.
    std::optional<std::uint32_t> latest() const;
    std::size_t left() const;  // to be fired
    std::uint64_t fired() const { return fired_; }

private:
    struct Missile {
        std::uint32_t body;
        std::uint64_t shot = 0;  // counted from 1; 0 while it does not fly
        double time = 0;         // of the shot, s
    };
    Missile* next_free();

    std::vector<Missile> missiles_;
    std::uint64_t fired_ = 0;
    double next_shot_ = 0;  // not before this time, s
};

}  // namespace kolize::tunnel
