// Narrowphase: from candidate pairs to contacts.
#pragma once

#include <kolize/contact.h>
#include <kolize/flow.h>

namespace kolize {

struct NarrowphaseInput {
    const World& world;
    std::span<const Pair> pairs;     // body ids, a < b, sorted, no duplicates, never two static bodies
    std::span<const Detail> detail;  // what to find out about each pair; same length as pairs
    double reach = 0;                // m, for find_touching
};

struct ImpactInput {
    const World& world;  // shapes and constants; the motion is the flow's
    const Flow& flow;
    std::span<const Pair> pairs;  // as in NarrowphaseInput
    double from = 0, until = 0;   // s
};

// Contract (held by the conformance suite for every plugin):
// - a pair gets rows exactly when the two solids' surfaces overlap as far as this plugin can tell;
// - rows stand in canonical order and hold what contact.h says, no more than the detail asked for;
// - swapping the two bodies swaps the arms and negates the normal; moving or turning both changes nothing else;
// - the answer for a pair does not depend on the other pairs, on earlier steps or on the number of threads;
// - no NaN leaves, whatever comes in: a non-finite pose gives std::invalid_argument naming the body;
// - warm calls allocate nothing.
class KOLIZE_API Narrowphase : public Stage {
public:
    static constexpr StageKind kind = StageKind::narrowphase;

    // The most detail this object, as configured, can give.
    virtual Detail gives() const = 0;

    // Called once before the first step, and again if the world's shapes change.
    virtual void prepare(const World& world) = 0;

    // Appends to `contacts`, which comes empty and keeps its capacity between steps.
    virtual void find_contacts(const NarrowphaseInput& input, Contacts& contacts) = 0;

    // For stepping `continuous`, if the descriptor's capabilities have time_of_impact; otherwise never called.
    // times[i]: a moment at which pair i stands within twice touch_distance and approaches, such that the pair does not
    // overlap between input.from and then; infinity if there is none until input.until. Never late: nothing is missed.
    virtual void find_impacts(const ImpactInput& input, std::span<double> times);
    // Contacts of pairs that stand within four times touch_distance without overlapping, at the world's present poses,
    // depth 0; and points whose gap is no wider than input.reach, with depth = -gap (or nearer than that). Appends rows
    // in canonical order, each point a region of its own.
    virtual void find_touching(const NarrowphaseInput& input, Contacts& contacts);

    // For whoever looks on, if the capabilities have `crossings`: where the surfaces of the pairs cross at the world's
    // present poses, whatever their detail. Appends, pair by pair; pairs without closed meshes give nothing.
    virtual void find_crossings(const NarrowphaseInput& input, std::vector<CrossingLine>& crossings);
};

// The gap (m) at which two bodies in motion count as touching: far below any length of the scene, far above the
// rounding of positions where the bodies are.
KOLIZE_API double touch_distance(const World& world, std::uint32_t a, std::uint32_t b);

}  // namespace kolize
