// Pairs that the narrowphase need not see, because volumes around the two bodies are apart.
#pragma once

#include <kolize/bounding_volumes.h>
#include <kolize/broadphase.h>
#include <kolize/host.h>
#include <kolize/world.h>

#include <span>
#include <string>
#include <vector>

namespace kolize {

class Cull {
public:
    // kind: a VolumeKind, or "auto" for one that suits each shape.
    Cull(const std::string& kind, const World& world);

    // Puts the volumes of the pairs' bodies where they stand now; asked for are then pairs of these.
    void place(const World& world, std::span<const Pair> pairs, Host& host);
    bool certainly_apart(const Pair& pair) const;

private:
    std::vector<ShapeVolume> shapes_;
    std::vector<PlacedVolume> bodies_;
    std::vector<std::uint8_t> is_wanted_;  // by body
    std::vector<std::uint32_t> wanted_;
};

}  // namespace kolize
