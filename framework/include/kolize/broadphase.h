// Broadphase: from the bounds of all boxes to the pairs that may touch.
#pragma once

#include <kolize/math.h>
#include <kolize/stage.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace kolize {

// Two rows (or bodies), a < b.
struct Pair {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    friend auto operator<=>(const Pair&, const Pair&) = default;
};

struct BroadphaseInput {
    // World-frame boxes in metres, finite, min <= max in every axis. A row keeps its meaning while `generation` stays.
    std::span<const Aabb> bounds;
    // 1 where the row never moves while `generation` stays. Same length as bounds.
    std::span<const std::uint8_t> is_static;
    // Changes whenever rows were added, removed or renumbered, or a static row moved.
    std::uint64_t generation = 0;
    // 1 where the row's box is a subspace, for broadphases that divide space by bodies. Same length as bounds, or empty
    // where there is none. Constant while `generation` stays.
    std::span<const std::uint8_t> is_reference = {};
};

// How a broadphase divides space, for whoever looks on. World frame, m.
struct Outline {
    struct Box {
        Aabb box;                 // flat along one axis: a piece of a plane
        std::uint32_t level = 0;  // of a tree, the root being 0
    };
    struct Ball {
        Vec3 center = Vec3::Zero();
        double radius = 0;
        std::uint32_t level = 0;
    };
    std::vector<Box> boxes;
    std::vector<Ball> balls;
};

// Contract (held by the conformance suite for every plugin):
// - conservative: every pair of overlapping closed boxes is reported, unless both rows are static;
// - a pair whose boxes do not overlap may be reported; a pair of two static rows may not;
// - no pair twice, never a row with itself, a < b; the order is free (the framework sorts);
// - the same input gives the same set, whatever came before and however many threads the host has;
// - non-finite or inverted boxes: std::invalid_argument that names the row;
// - warm calls of the same size allocate nothing.
class Broadphase;

// The other broadphases that were found, for one that chooses among them. Lives as long as the stage.
class KOLIZE_API BroadphaseChoice {
public:
    virtual ~BroadphaseChoice() = default;
    virtual std::size_t size() const = 0;
    virtual const char* name(std::size_t i) const = 0;
    // With its default parameters, attached. Throws what making it throws.
    virtual std::shared_ptr<Broadphase> make(std::size_t i) const = 0;
};

class KOLIZE_API Broadphase : public Stage {
public:
    static constexpr StageKind kind = StageKind::broadphase;

    // Appends to `pairs`, which comes empty and keeps its capacity between steps.
    virtual void find_pairs(const BroadphaseInput& input, std::vector<Pair>& pairs) = 0;

    // Called once after attach(), if the descriptor's capabilities have `chooses`.
    virtual void choose_from(std::shared_ptr<const BroadphaseChoice> others);

    // Appends how find_pairs divides space for this input. Called only where the descriptor's capabilities have
    // `outline`, and only if somebody looks on: find_pairs keeps nothing for it.
    virtual void outline(const BroadphaseInput& input, Outline& outline);
};

// Throws std::invalid_argument naming the first row whose box is not finite or has min > max.
KOLIZE_API void require_valid_bounds(std::span<const Aabb> bounds);

}  // namespace kolize
