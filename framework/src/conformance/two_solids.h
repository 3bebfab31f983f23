// Pairs of solids in random poses, for the narrowphase suite.
#pragma once

#include <kolize/plugin.h>

#include <random>

namespace kolize {

// Two bodies, ids 0 and 1, of the kinds that the plugin takes.
World random_two_solids(std::mt19937_64& random, std::uint32_t shape_kinds);

// The same two with their ids exchanged.
World exchanged(const World& world);

// Everything turned about the origin, then moved.
World placed_elsewhere(const World& world, const Mat3& rotation, const Vec3& translation);

Mat3 random_rotation(std::mt19937_64& random);

// As text that shows shapes and poses to the last bit.
std::string to_text(const World& world);

enum class Overlap { apart, overlapping, too_close_to_tell };

// Brute force in long double over all edges and triangles of the two surfaces (a sphere or half-space: over closest
// points); too close where a decision hangs on the last digits, or where one solid may lie inside the other.
Overlap reference_overlap(const World& world);

}  // namespace kolize
