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
}

void Cull::place(const World& world, Host& host) {
    constexpr std::size_t grain = 256;
    host.parallel_for(bodies_.size(), grain, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t body = begin; body < end; ++body)
            bodies_[body] = place_volume(shapes_[world.shape[body]], world.position[body],
                                         world.orientation[body].toRotationMatrix());
    });
}

bool Cull::certainly_apart(const Pair& pair) const { return kolize::certainly_apart(bodies_[pair.a], bodies_[pair.b]); }

}  // namespace kolize
