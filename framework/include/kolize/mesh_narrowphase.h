// The framework's half of a narrowphase that tests triangles: everything but the triangles.
//
// Three independent choices make contacts between meshes: how candidate triangle pairs are found (the hierarchy walk,
// or a plugin's own), the triangle-triangle test, and the contact model. A triangle-test plugin derives from
// TriangleNarrowphase and writes one function, on a batch of pairs.
#pragma once

#include <kolize/narrowphase.h>

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace kolize {

// Two triangles in the body frame of mesh A (m).
struct TrianglePair {
    Vec3 a[3];
    Vec3 b[3];
};

// The segment (or point) that two triangles share, as the test sees it.
struct TriangleSegment {
    Vec3 p = Vec3::Zero();
    Vec3 q = Vec3::Zero();
};

// Intersecting triangles of one mesh pair, in canonical order: by triangle of A, then triangle of B.
struct TriangleHit {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    TriangleSegment segment;  // in the body frame of mesh A; only if points were asked for
};

struct TriangleHits {
    std::vector<TriangleHit> hits;
    std::uint64_t tests = 0;
    void clear() {
        hits.clear();
        tests = 0;
    }
};

struct MeshPair {
    const Mesh& a;
    const Mesh& b;
    Transform b_to_a;           // body frame of B to body frame of A
    std::uint32_t shape_a = 0;  // into World::shapes
    std::uint32_t shape_b = 0;
    bool first_only = false;  // overlap is all that is asked: stop at the first hit
    bool want_segments = false;
};

class TriangleNarrowphase;

// Handles spheres, boxes and half-spaces analytically where both shapes are primitive, a sphere or half-space against a
// mesh by closest features, and meshes (a box is twelve triangles) by intersect_meshes and the contact model.
class KOLIZE_API MeshNarrowphase : public Narrowphase {
public:
    MeshNarrowphase();
    ~MeshNarrowphase() override;
    Detail gives() const override;
    void attach(Host& host) override;
    void prepare(const World& world) override;  // an overriding function calls this one first
    void find_contacts(const NarrowphaseInput& input, Contacts& contacts) final;
    void find_impacts(const ImpactInput& input, std::span<double> times) final;
    void find_touching(const NarrowphaseInput& input, Contacts& contacts) final;
    void find_crossings(const NarrowphaseInput& input, std::vector<CrossingLine>& crossings) final;

    // The triangles of two meshes that intersect, without contacts; the shapes are those prepared for. Clears nothing;
    // appends. Called by several threads at once, each with its own `hits`; `hits` may be in any order.
    virtual void intersect_meshes(const MeshPair& pair, TriangleHits& hits) const = 0;

    // contour  intersection segments joined into regions; a region's normal is the direction of its vector area
    // averaged the thesis's: mean of the intersection points, normal of the triangle or body that is hit
    std::string contact = "contour";
    // Volumes at the nodes of the meshes' trees, where the framework walks them: aabb, sphere, obb, kdop18, kdop26
    std::string hierarchy = "aabb";

    template <class T, class Parameters>
    static void mesh_parameters(Parameters& p) {
        p.add("contact", &T::contact)
            .choices({"contour", "averaged"})
            .doc("Contact model: how intersecting triangles become contacts.");
        if constexpr (std::is_base_of_v<TriangleNarrowphase, T>)
            p.add("hierarchy", &T::hierarchy)
                .choices({"aabb", "sphere", "obb", "kdop18", "kdop26"})
                .doc("Volumes of the trees over the meshes' triangles. What is found does not depend on it.");
    }

private:
    friend class PairCollider;  // does one pair of bodies
    friend class TriangleNarrowphase;
    struct Workspace;
    std::vector<std::unique_ptr<Workspace>> workspaces_;  // one per chunk of pairs
    struct SweepWorkspace;
    std::vector<std::unique_ptr<SweepWorkspace>> sweeps_;  // likewise
    struct VolumeHierarchies;
    std::unique_ptr<VolumeHierarchies> volumes_;  // of the world's shapes, if `hierarchy` is not aabb
};

// Walks the two hierarchies and hands candidate triangle pairs to the test in batches.
class KOLIZE_API TriangleNarrowphase : public MeshNarrowphase {
public:
    void intersect_meshes(const MeshPair& pair, TriangleHits& hits) const final;

    // For each pair: hit[i] = 1 if the closed triangles intersect; then, if `segments` is not empty, segments[i].
    // All spans have the same length (segments may be empty). Called by several threads at once.
    virtual void intersect_triangles(std::span<const TrianglePair> pairs, std::span<std::uint8_t> hit,
                                     std::span<TriangleSegment> segments) const = 0;
};

}  // namespace kolize
