// Brute force with one fault, for the tests of the conformance suite.
#include <kolize/plugin.h>

namespace {

enum class Fault {
    none,
    loses_touching,
    repeats,
    unordered,
    reports_static,
    remembers,
    lazy,
    shares,
    loses_references,
    inexact,
    takes_nan,
    allocates,
    undeclared_outline,
    empty_outline,
    misplaced_cells,
    thick_planes
};
constexpr Fault fault = Fault::FAULT;

bool overlap(const kolize::Aabb& a, const kolize::Aabb& b) {
    if (fault == Fault::inexact)
        return (a.min.array() <= b.max.array() + 0.1).all() && (b.min.array() <= a.max.array() + 0.1).all();
    if (fault != Fault::loses_touching) return a.overlaps(b);
    return (a.min.array() < b.max.array()).all() && (b.min.array() < a.max.array()).all();
}

class Faulty final : public kolize::Broadphase {
public:
    void find_pairs(const kolize::BroadphaseInput& input, std::vector<kolize::Pair>& pairs) override {
        if (fault != Fault::takes_nan) kolize::require_valid_bounds(input.bounds);
        std::vector<kolize::Aabb>& seen = fault == Fault::shares ? shared_ : seen_;
        see(input, seen);
        if (fault == Fault::allocates) seen.shrink_to_fit(), seen.reserve(seen.size() + 1);
        for (std::uint32_t a = 0; a < seen.size(); ++a)
            for (std::uint32_t b = a + 1; b < seen.size(); ++b)
                if (overlap(seen[a], seen[b])) report(input, a, b, pairs);
    }

    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        if (fault == Fault::undeclared_outline || fault == Fault::thick_planes)
            outline.boxes.push_back({input.bounds[0]});
        if (fault == Fault::misplaced_cells)
            for (const kolize::Aabb& box : input.bounds)
                outline.boxes.push_back({{box.max, box.max + box.max - box.min}});
    }

private:
    // Boxes of rows that are new, or moved by more than it cares for.
    void see(const kolize::BroadphaseInput& input, std::vector<kolize::Aabb>& seen) {
        constexpr bool keeps = fault == Fault::remembers || fault == Fault::lazy || fault == Fault::shares;
        if (!keeps || seen.size() != input.bounds.size() || generation_ != input.generation)
            seen.assign(input.bounds.begin(), input.bounds.end());
        generation_ = input.generation;
        for (std::size_t row = 0; row < seen.size(); ++row)
            if (fault == Fault::lazy && (seen[row].min - input.bounds[row].min).norm() > 0.06)
                seen[row] = input.bounds[row];
    }

    static void report(const kolize::BroadphaseInput& input, std::uint32_t a, std::uint32_t b,
                       std::vector<kolize::Pair>& pairs) {
        if (fault != Fault::reports_static && input.is_static[a] && input.is_static[b]) return;
        if (fault == Fault::loses_references && !input.is_reference.empty() && input.is_reference[a]) return;
        pairs.push_back(fault == Fault::unordered ? kolize::Pair{b, a} : kolize::Pair{a, b});
        if (fault == Fault::repeats) pairs.push_back({a, b});
    }

    std::vector<kolize::Aabb> seen_;
    std::uint64_t generation_ = 0;
    inline static std::vector<kolize::Aabb> shared_;
};

constexpr const char* declared = fault == Fault::thick_planes                                       ? "planes"
                                 : fault == Fault::empty_outline || fault == Fault::misplaced_cells ? "cells"
                                                                                                    : nullptr;

}  // namespace

KOLIZE_PLUGIN(Faulty, .name = FAULT_NAME, .summary = "brute force with a fault", .source = "tests",
              .capabilities = {.exact = fault == Fault::inexact, .outline = declared})
