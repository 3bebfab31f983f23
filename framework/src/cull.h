// Pairs that the narrowphase need not see, because volumes around the two bodies are apart.
#pragma once

#include <kolize/bounding_volumes.h>
#include <kolize/broadphase.h>
#include <kolize/host.h>
#include <kolize/world.h>

#include <optional>
#include <string>
#include <vector>

namespace kolize {

class Cull {
public:
    // kind: a VolumeKind, or "auto" for one that suits each shape.
    Cull(const std::string& kind, const World& world);

    // Puts the volumes where the bodies stand now.
    void place(const World& world, Host& host);
    bool certainly_apart(const Pair& pair) const;

private:
    std::vector<ShapeVolume> shapes_;
    std::vector<PlacedVolume> bodies_;
};

}  // namespace kolize
