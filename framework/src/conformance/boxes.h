// The boxes that the broadphase suite asks about.
#pragma once

#include <kolize/broadphase.h>

#include <string>

namespace kolize {

struct BoxScene {
    std::vector<Aabb> bounds;
    std::vector<std::uint8_t> is_static;
    std::vector<std::uint8_t> is_reference = {};  // empty: none
};

struct BoxSceneKind {
    const char* name;
    BoxScene (*make)(std::uint64_t seed);
};

// One for each way in which boxes are known to be awkward.
std::span<const BoxSceneKind> box_scene_kinds();

// Boxes of side 1 m, 0.25 to a cubic metre: about two overlaps each.
BoxScene uniform_boxes(std::size_t count, std::uint64_t seed);

// Each dynamic box goes up to 5 % of its size in each axis.
void move_boxes(BoxScene& scene, std::uint64_t seed);

// Rows in another order: row i of the result is row order[i] of the scene.
BoxScene permute(const BoxScene& scene, const std::vector<std::uint32_t>& order);

// By definition: every pair of overlapping closed boxes that are not both static, sorted.
std::vector<Pair> overlapping_pairs(const BoxScene& scene);

// "" if the pairs are a right answer: no overlapping pair is missing, and each one may stand there.
std::string fault(const BoxScene& scene, std::vector<Pair> pairs);

// "" if the boxes of all pairs overlap.
std::string inexact(const BoxScene& scene, std::vector<Pair> pairs);

// A declaration of the scene that pastes into a test.
std::string to_code(const BoxScene& scene);

}  // namespace kolize
