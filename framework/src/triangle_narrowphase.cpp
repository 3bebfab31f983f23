#include "hierarchy_walk.h"

namespace kolize {

namespace {

// Collects the pairs of triangles whose boxes overlap in A's frame, and hands them over in batches.
template <class Test>
class Batch {
public:
    Batch(const MeshPair& pair, Test& test) : pair_(pair), test_(test), limit_(pair.first_only ? 1 : pairs_.size()) {}

    // False when nothing more needs to be known.
    bool add(std::uint32_t a, std::uint32_t b) {
        TrianglePair& next = pairs_[count_];
        for (int k = 0; k < 3; ++k) {
            next.a[k] = pair_.a.vertices[pair_.a.triangles[a][k]];
            next.b[k] = pair_.b_to_a * pair_.b.vertices[pair_.b.triangles[b][k]];
        }
        ids_[count_++] = {a, b};
        return count_ < limit_ || flush();
    }

    bool flush() {
        const std::size_t count = count_;
        count_ = 0;
        return count == 0 || test_(std::span(ids_).first(count), std::span(pairs_).first(count));
    }

private:
    const MeshPair& pair_;
    Test& test_;
    std::size_t count_ = 0;
    std::array<TrianglePair, 64> pairs_;
    std::array<std::pair<std::uint32_t, std::uint32_t>, 64> ids_;
    std::size_t limit_;
};

}  // namespace

void TriangleNarrowphase::intersect_meshes(const MeshPair& pair, TriangleHits& hits) const {
    std::array<std::uint8_t, 64> hit;
    std::array<TriangleSegment, 64> segments;
    // Tests one batch; false once nothing more needs to be known.
    auto test = [&](auto ids, std::span<const TrianglePair> pairs) {
        const std::size_t count = pairs.size(), wanted = pair.want_segments ? count : 0;
        intersect_triangles(pairs, {hit.data(), count}, {segments.data(), wanted});
        hits.tests += count;
        for (std::size_t i = 0; i < count; ++i)
            if (hit[i]) {
                hits.hits.push_back({ids[i].first, ids[i].second, wanted ? segments[i] : TriangleSegment{}});
                if (pair.first_only) return false;
            }
        return true;
    };
    Batch batch(pair, test);
    bool go_on = true;
    HierarchyWalk(pair, [&](std::uint32_t a, std::uint32_t b) { return go_on = batch.add(a, b); }).run();
    if (go_on) batch.flush();
}

}  // namespace kolize
