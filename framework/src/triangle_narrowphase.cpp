#include "hierarchy_walk.h"
#include "volume_hierarchies.h"

#include <optional>

namespace kolize {

namespace {

// Collects the pairs of triangles that the walk finds, and hands them to the test in batches.
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
    std::array<IdPair, 64> ids_;
    std::size_t limit_;
};

template <class Filter>
void walk(const TriangleNarrowphase& stage, const MeshPair& pair, const Filter& filter, TriangleHits& hits) {
    if (!roots_near(pair, filter)) return;  // many pairs of bodies end here: nothing else is set up before
    std::array<std::uint8_t, 64> hit;
    std::optional<std::array<TriangleSegment, 64>> segments;
    if (pair.want_segments) segments.emplace();
    // Tests one batch; false once nothing more needs to be known.
    auto test = [&](auto ids, std::span<const TrianglePair> pairs) {
        const std::size_t count = pairs.size();
        using Segments = std::span<TriangleSegment>;
        stage.intersect_triangles(pairs, std::span(hit).first(count),
                                  segments ? Segments(*segments).first(count) : Segments());
        hits.tests += count;
        for (std::size_t i = 0; i < count; ++i)
            if (hit[i]) {
                hits.hits.push_back({ids[i].a, ids[i].b, segments ? (*segments)[i] : TriangleSegment{}});
                if (pair.first_only) return false;
            }
        return true;
    };
    Batch batch(pair, test);
    bool go_on = true;
    HierarchyWalk(pair, filter, [&](std::uint32_t a, std::uint32_t b) { return go_on = batch.add(a, b); }).run();
    if (go_on) batch.flush();
}

}  // namespace

void TriangleNarrowphase::intersect_meshes(const MeshPair& pair, TriangleHits& hits) const {
    const BoxFilter boxes(pair);
    if (!volumes_) return walk(*this, pair, boxes, hits);
    const NodeVolumes &a = volumes_->shapes[pair.shape_a], &b = volumes_->shapes[pair.shape_b];
    const auto walk_by = [&](const auto& nodes) { walk(*this, pair, NodeFilter(pair, boxes, nodes), hits); };
    switch (volumes_->kind) {
    case VolumeKind::sphere: return walk_by(SphereNodes(pair, a, b));
    case VolumeKind::obb: return walk_by(BoxNodes(pair, a, b));
    default: return walk_by(SlabNodes(pair, a, b, volumes_->kind == VolumeKind::kdop18 ? 9 : 13));
    }
}

}  // namespace kolize
