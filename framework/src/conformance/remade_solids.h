// The two solids of a world made otherwise, in ways of which it is known what they do to the contacts.
#pragma once

#include <kolize/plugin.h>

#include <random>

namespace kolize {

// All lengths times a power of two: no digit changes.
World scaled(const World& world, double power_of_two);

// Left and right exchanged: x is -x.
World mirrored(const World& world);

// The same surfaces of meshes, with vertices and triangles numbered otherwise.
World renumbered_meshes(const World& world, std::mt19937_64& random);

// The same surfaces of meshes, every triangle made of four.
World subdivided_meshes(const World& world);

}  // namespace kolize
