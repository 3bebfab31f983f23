// Contact models: from the intersecting triangles of two meshes to contact regions, in the body frame of mesh A.
#pragma once

#include "contact_region.h"

#include <kolize/mesh_narrowphase.h>

namespace kolize {

// Set of small integers that is emptied in constant time.
class Marks {
public:
    void reserve(std::size_t size) { stamps_.reserve(size); }
    void reset(std::size_t size) {
        if (stamps_.size() < size) stamps_.resize(size, 0);
        if (++now_ == 0) {
            std::fill(stamps_.begin(), stamps_.end(), 0u);
            now_ = 1;
        }
    }
    void set(std::uint32_t i) { stamps_[i] = now_; }
    bool test(std::uint32_t i) const { return stamps_[i] == now_; }

private:
    std::vector<std::uint32_t> stamps_;
    std::uint32_t now_ = 0;
};

// Where an edge of one mesh goes through a triangle of the other. The ids alone say which crossing it is, so the two
// triangle pairs that share it agree without comparing coordinates.
struct Crossing {
    std::uint64_t key = 0;  // (whose edge, edge, triangle)
    Vec3 point = Vec3::Zero();
    bool edge_of_a = false;
    std::uint32_t edge = 0;
    std::uint32_t inner_vertex = 0;  // the end of the edge that lies behind the triangle
};

struct ContourSegment {
    Crossing from, to;  // oriented along normal_A x normal_B
    std::uint32_t triangle_a = 0, triangle_b = 0;
    std::uint32_t parent = 0;  // union-find; afterwards the first segment of the region
};

// The part of one mesh that lies inside the other behind one region of the curve.
struct InnerPatch {
    std::vector<std::uint32_t> triangles;  // the region's own first, then those wholly inside
    std::vector<std::uint32_t> vertices;   // inside
    std::vector<std::uint32_t> edges;      // of those triangles
};

struct ContourScratch {
    std::vector<ContourSegment> segments;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> ends;  // (crossing key, segment)
    std::vector<Vec3> points;
    InnerPatch patch_a, patch_b;
    Marks vertices, triangles, edges;
    Marks pierced_a, pierced_b;    // edges that go through a triangle of the other mesh
    Marks repeated_a, repeated_b;  // of them, those that go through more than one

    // For meshes of at most these sizes; memory that is never used is never touched.
    void reserve(std::size_t vertices, std::size_t edges, std::size_t triangles);
};

// One region per connected part of the intersection curve. For closed meshes in general position (no crossing point
// exactly on an edge or vertex of the other mesh).
// Normal: direction of the vector area sum 1/2 p x q of the oriented curve, which is the outward area of A's surface
// inside B and the gradient of the overlap volume under translation (divergence theorem; Faure, Allard et al.
// 2008-2010). Depth: see overlap_depth.
void contour_regions(const MeshPair& pair, std::span<const TriangleHit> hits, ContourScratch& scratch,
                     std::vector<ContactRegion>& regions);

// The longest chord of the overlap along the normal, between the inner patches of both surfaces. Its ends lie at a
// vertex of one patch over a triangle of the other, or where two edges cross in the view along the normal. Exact where
// each surface bounds the overlap from one side, an estimate in deep or pierced overlaps; of large patches only the
// vertices that reach farthest are tried.
double overlap_depth(const MeshPair& pair, std::uint32_t region, const Vec3& normal, ContourScratch& scratch);

// The baseline of the source thesis: one contact whatever the number of places. Point: mean of the intersection points
// that two triangle pairs found bitwise alike (of all points, if none was). Normal: mean of the triangle normals of the
// body with fewer intersecting triangles, or of the static body. Where that mean vanishes the line of centres is taken.
void averaged_region(const MeshPair& pair, std::span<const TriangleHit> hits, bool a_is_static, bool b_is_static,
                     ContourScratch& scratch, std::vector<ContactRegion>& regions);

}  // namespace kolize
