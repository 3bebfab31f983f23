// What two narrowphases do not agree on, made small and kept in a file.
#pragma once

#include "witness.h"

#include <kolize/scene.h>

#include <filesystem>
#include <optional>

namespace kolize::cli {

// A capsule whose only two bodies are the pair; of meshes that the two witnesses see in different triangles, one such
// triangle of each, in the frame in which both looked at them. Witnesses are prepared for the world.
Scene smallest_scene(const World& world, const Pair& pair, Witness& truth, Witness& other, const PluginLibrary& library,
                     Host& host);

// The triangles alone; nothing if the witnesses see the same ones, or not with the triangles taken out of their meshes.
std::optional<World> two_triangles(const World& world, const Pair& pair, Witness& truth, Witness& other,
                                   const PluginLibrary& library, Host& host);

// The two bodies, which become 0 and 1, with all that the world knows of them.
World two_bodies(const World& world, const Pair& pair);

}  // namespace kolize::cli
