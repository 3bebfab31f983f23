#include "magazine.h"

#include <algorithm>

namespace kolize::tunnel {
namespace {

constexpr double clearance = 1.5;  // m, from the fighter's nose to the missile's origin

PlaceInput shot(const TunnelScene& tunnel, const World& world, std::uint32_t missile) {
    const Quat axes = axes_of(world, tunnel.fighter);
    const Vec3 nose = axes * Vec3(fighter_length / 2 + clearance, 0, 0);
    const Vec3 muzzle = world.model_position(tunnel.fighter) + nose;
    const Vec3 velocity = world.velocity[tunnel.fighter] + axes * Vec3(missile_speed, 0, 0);
    return {missile, placed(world, missile, muzzle, axes, velocity)};
}

}  // namespace

Magazine::Magazine(std::vector<std::uint32_t> missiles) {
    for (const std::uint32_t body : missiles) missiles_.push_back({body});
}

Magazine::Missile* Magazine::next_free() {
    const auto free = std::find_if(missiles_.begin(), missiles_.end(), [](const Missile& m) { return m.shot == 0; });
    return free == missiles_.end() ? nullptr : &*free;
}

void Magazine::decide(const TunnelScene& tunnel, const World& world, bool trigger, double time,
                      std::vector<Input>& inputs) {
    for (Missile& missile : missiles_) {
        if (missile.shot == 0 || time - missile.time < missile_life) continue;
        missile.shot = 0;
        inputs.push_back(RemoveInput{missile.body});
    }
    Missile* missile = next_free();
    if (!trigger || time < next_shot_ || !missile) return;
    missile->shot = ++fired_;
    missile->time = time;
    next_shot_ = time + time_between_shots;
    inputs.push_back(shot(tunnel, world, missile->body));
}

void Magazine::observe(const World& world) {
    for (Missile& missile : missiles_)
        if (world.removed[missile.body]) missile.shot = 0;
}

std::optional<std::uint32_t> Magazine::latest() const {
    const auto last = std::max_element(missiles_.begin(), missiles_.end(),
                                       [](const Missile& a, const Missile& b) { return a.shot < b.shot; });
    return last == missiles_.end() || last->shot == 0 ? std::nullopt : std::optional(last->body);
}

std::size_t Magazine::left() const {
    return static_cast<std::size_t>(
        std::count_if(missiles_.begin(), missiles_.end(), [](const Missile& m) { return m.shot == 0; }));
}

}  // namespace kolize::tunnel
