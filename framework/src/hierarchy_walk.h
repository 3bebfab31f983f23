// Two hierarchies walked at once, for the pairs of triangles whose boxes meet.
#pragma once

#include "box_filter.h"

#include <bit>

namespace kolize {

struct IdPair {
    std::uint32_t a, b;
};

// False if one of the meshes is empty or the boxes around them are certainly apart.
template <class Filter>
bool roots_near(const MeshPair& pair, const Filter& filter) {
    if (pair.a.hierarchy.nodes.empty() || pair.b.hierarchy.nodes.empty()) return false;
    const HierarchyNode *a = pair.a.hierarchy.nodes.data(), *b = pair.b.hierarchy.nodes.data();
    return filter.nodes_near({a, a}, {b, b}) != 0;
}

// Calls visit(triangle of A, triangle of B) for every pair whose boxes are not certainly apart, each pair once, and
// stops where it returns false. Filter: BoxFilter, or what compares the nodes' other volumes.
template <class Filter, class Visit>
class HierarchyWalk {
public:
    // The roots are near each other.
    HierarchyWalk(const MeshPair& pair, const Filter& filter, Visit visit)
        : a_(pair.a.hierarchy), b_(pair.b.hierarchy), filter_(filter), visit_(visit) {}

    void run() {
        stack_[size_++] = {0, 0};
        while (size_ > 0) {
            const auto [i, j] = stack_[--size_];
            const HierarchyNode &a = a_.nodes[i], &b = b_.nodes[j];
            if (a.is_leaf() && b.is_leaf()) {
                if (!visit_leaves(a, b)) return;
            } else {
                constexpr float comparable = 0.25f;  // of squared sizes
                const float size_a = a.half.squaredNorm(), size_b = b.half.squaredNorm();
                const bool into_a = !a.is_leaf() && (b.is_leaf() || size_a >= comparable * size_b);
                const bool into_b = !b.is_leaf() && (a.is_leaf() || size_b >= comparable * size_a);
                push_near(into_a ? a.first : i, into_b ? b.first : j, into_a, into_b);
            }
        }
    }

private:
    // Of node i and, if so told, the one that follows it, and j likewise: those pairs that are not apart.
    void push_near(std::uint32_t i, std::uint32_t j, bool both_a, bool both_b) {
        const HierarchyNode* const a[2] = {&a_.nodes[i], &a_.nodes[i + both_a]};
        const HierarchyNode* const b[2] = {&b_.nodes[j], &b_.nodes[j + both_b]};
        const unsigned different = (both_a ? 0b1111u : 0b0011u) & (both_b ? 0b1111u : 0b0101u);
        for (unsigned rest = filter_.nodes_near(a, b) & different; rest != 0; rest &= rest - 1) {
            const unsigned bit = std::countr_zero(rest);
            stack_[size_++] = {i + bit / 2, j + bit % 2};
        }
    }

    // False when the walk may stop.
    bool visit_leaves(const HierarchyNode& a, const HierarchyNode& b) {
        constexpr std::uint32_t size = TriangleBlock::size;
        const unsigned near = filter_.triangles_near(a_.blocks[a.first / size], b_.blocks[b.first / size]);
        for (unsigned rest = near; rest != 0; rest &= rest - 1) {
            const unsigned bit = std::countr_zero(rest), i = bit / size, j = bit % size;
            if (i < a.count && j < b.count && !visit_(a_.order[a.first + i], b_.order[b.first + j])) return false;
        }
        return true;
    }

    const Hierarchy &a_, &b_;
    const Filter& filter_;
    Visit visit_;
    std::size_t size_ = 0;
    std::array<IdPair, 192> stack_;  // trees of 2^32 triangles are 30 deep: 60 x 3 + 1
};

}  // namespace kolize
