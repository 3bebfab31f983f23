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
    takes_nan,
    allocates,
    undeclared_outline,
    empty_outline,
    misplaced_cells,
    thick_planes
};
constexpr Fault fault = Fault::FAULT;

bool overlap(const kolize::Aabb& a, const kolize::Aabb& b) {
    if (fault != Fault::loses_touching) return a.overlaps(b);
    return (a.min.array() < b.max.array()).all() && (b.min.array() < a.max.array()).all();
}

class Faulty final : public kolize::Broadphase {
public:
    void find_pairs(const kolize::BroadphaseInput& input, std::vector<kolize::Pair>& pairs) override {
        if (fault != Fault::takes_nan) kolize::require_valid_bounds(input.bounds);
        if (fault != Fault::remembers || seen_.size() != input.bounds.size())
            seen_.assign(input.bounds.begin(), input.bounds.end());
        if (fault == Fault::allocates) seen_.shrink_to_fit(), seen_.reserve(seen_.size() + 1);
        for (std::uint32_t a = 0; a < seen_.size(); ++a)
            for (std::uint32_t b = a + 1; b < seen_.size(); ++b)
                if (overlap(seen_[a], seen_[b])) report(input, a, b, pairs);
    }

    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        if (fault == Fault::undeclared_outline || fault == Fault::thick_planes)
            outline.boxes.push_back({input.bounds[0]});
        if (fault == Fault::misplaced_cells)
            for (const kolize::Aabb& box : input.bounds)
                outline.boxes.push_back({{box.max, box.max + box.max - box.min}});
    }

private:
    static void report(const kolize::BroadphaseInput& input, std::uint32_t a, std::uint32_t b,
                       std::vector<kolize::Pair>& pairs) {
        if (fault != Fault::reports_static && input.is_static[a] && input.is_static[b]) return;
        pairs.push_back(fault == Fault::unordered ? kolize::Pair{b, a} : kolize::Pair{a, b});
        if (fault == Fault::repeats) pairs.push_back({a, b});
    }

    std::vector<kolize::Aabb> seen_;
};

constexpr const char* declared = fault == Fault::thick_planes                                       ? "planes"
                                 : fault == Fault::empty_outline || fault == Fault::misplaced_cells ? "cells"
                                                                                                    : nullptr;

}  // namespace

KOLIZE_PLUGIN(Faulty, .name = FAULT_NAME, .summary = "brute force with a fault", .source = "tests",
              .capabilities = {.outline = declared})
