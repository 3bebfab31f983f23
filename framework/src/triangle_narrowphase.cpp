#include <kolize/mesh_narrowphase.h>

#include <algorithm>

namespace kolize {

namespace {

// Descends both hierarchies at once, always into the larger box, and collects triangle pairs whose boxes overlap.
template <class Flush>
class HierarchyWalk {
public:
    HierarchyWalk(const MeshPair& pair, Flush flush) : pair_(pair), flush_(flush) {
        // Rounding may not make two boxes seem apart; Gottschalk, Lin & Manocha (OBBTree, 1996) do likewise.
        reach_ = pair.b_to_a.rotation.cwiseAbs().array() + 1e-12;
    }

    void run() {
        if (pair_.a.hierarchy.nodes.empty() || pair_.b.hierarchy.nodes.empty()) return;
        std::array<std::pair<std::uint32_t, std::uint32_t>, 128> stack;  // median splits keep both trees shallow
        std::size_t size = 0;
        stack[size++] = {0, 0};
        while (size > 0) {
            const auto [i, j] = stack[--size];
            const HierarchyNode &a = pair_.a.hierarchy.nodes[i], &b = pair_.b.hierarchy.nodes[j];
            if (apart(a, b)) continue;
            if (a.is_leaf() && b.is_leaf()) {
                if (!visit_leaves(a, b)) return;
            } else if (b.is_leaf() || (!a.is_leaf() && a.half.squaredNorm() > b.half.squaredNorm())) {
                stack[size++] = {a.first + 1, j};
                stack[size++] = {a.first, j};
            } else {
                stack[size++] = {i, b.first + 1};
                stack[size++] = {i, b.first};
            }
        }
        flush_(count_, ids_, pairs_);
    }

private:
    // Separation along the face axes of both boxes; edge axes rarely reject more than they cost.
    bool apart(const HierarchyNode& a, const HierarchyNode& b) const {
        const Vec3 t = pair_.b_to_a * b.center - a.center;
        if ((t.cwiseAbs().array() > (a.half + reach_ * b.half).array()).any()) return true;
        const Vec3 u = pair_.b_to_a.rotation.transpose() * t;
        return (u.cwiseAbs().array() > (b.half + reach_.transpose() * a.half).array()).any();
    }

    // False when the walk may stop.
    bool visit_leaves(const HierarchyNode& a, const HierarchyNode& b) {
        for (std::uint32_t j = b.first; j < b.first + b.count; ++j) {
            const std::uint32_t tb = pair_.b.hierarchy.order[j];
            Vec3 corners[3];
            for (int k = 0; k < 3; ++k) corners[k] = pair_.b_to_a * pair_.b.vertices[pair_.b.triangles[tb][k]];
            const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
            const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
            for (std::uint32_t i = a.first; i < a.first + a.count; ++i)
                if (!add(pair_.a.hierarchy.order[i], tb, corners, low, high)) return false;
        }
        return true;
    }

    bool add(std::uint32_t ta, std::uint32_t tb, const Vec3 (&corners)[3], const Vec3& low, const Vec3& high) {
        const Triangle& t = pair_.a.triangles[ta];
        const Vec3 &p = pair_.a.vertices[t[0]], &q = pair_.a.vertices[t[1]], &r = pair_.a.vertices[t[2]];
        if ((p.cwiseMin(q).cwiseMin(r).array() > high.array()).any() ||
            (p.cwiseMax(q).cwiseMax(r).array() < low.array()).any())
            return true;
        pairs_[count_] = {{p, q, r}, {corners[0], corners[1], corners[2]}};
        ids_[count_++] = {ta, tb};
        if (count_ < (pair_.first_only ? 1 : pairs_.size())) return true;
        const bool go_on = flush_(count_, ids_, pairs_);
        count_ = 0;
        return go_on;
    }

    const MeshPair& pair_;
    Flush flush_;
    Mat3 reach_;
    std::size_t count_ = 0;
    std::array<TrianglePair, 64> pairs_;
    std::array<std::pair<std::uint32_t, std::uint32_t>, 64> ids_;
};

}  // namespace

void TriangleNarrowphase::intersect_meshes(const MeshPair& pair, TriangleHits& hits) const {
    std::array<std::uint8_t, 64> hit;
    std::array<TriangleSegment, 64> segments;
    // Tests one batch; false once nothing more needs to be known.
    const auto flush = [&](std::size_t count, const auto& ids, const auto& pairs) {
        if (count == 0) return true;
        const std::size_t wanted = pair.want_segments ? count : 0;
        intersect_triangles({pairs.data(), count}, {hit.data(), count}, {segments.data(), wanted});
        hits.tests += count;
        for (std::size_t i = 0; i < count; ++i)
            if (hit[i]) {
                hits.hits.push_back({ids[i].first, ids[i].second, wanted ? segments[i] : TriangleSegment{}});
                if (pair.first_only) return false;
            }
        return true;
    };
    HierarchyWalk(pair, flush).run();
}

}  // namespace kolize
