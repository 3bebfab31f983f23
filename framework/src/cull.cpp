#include "cull.h"

namespace kolize {

namespace {

VolumeKind suitable(ShapeKind kind) {
    switch (kind) {
    case ShapeKind::mesh:
    case ShapeKind::hull: return VolumeKind::kdop18;
    case ShapeKind::box: return VolumeKind::obb;
    default: return VolumeKind::sphere;
    }
}

}  // namespace

Cull::Cull(const std::string& kind, const World& world) {
    for (const Shape& shape : world.shapes)
        shapes_.push_back(fit_volume(shape, kind == "auto" ? suitable(shape.kind) : volume_kind(kind)));
    bodies_.resize(world.size());
    is_wanted_.resize(world.size());
    wanted_.reserve(world.size());
}

void Cull::place(const World& world, std::span<const Pair> pairs, Host& host) {
    constexpr std::size_t grain = 256;
    for (const std::uint32_t body : wanted_) is_wanted_[body] = 0;
    wanted_.clear();
    for (const Pair& pair : pairs)
        for (const std::uint32_t body : {pair.a, pair.b}) {
            if (!is_wanted_[body]) wanted_.push_back(body);
            is_wanted_[body] = 1;
        }
    host.parallel_for(wanted_.size(), grain, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (const std::uint32_t body : std::span(wanted_).subspan(begin, end - begin))
            bodies_[body] = place_volume(shapes_[world.shape[body]], world.position[body],
                                         world.orientation[body].toRotationMatrix());
    });
}

bool Cull::certainly_apart(const Pair& pair) const { return kolize::certainly_apart(bodies_[pair.a], bodies_[pair.b]); }

}  // namespace kolize
