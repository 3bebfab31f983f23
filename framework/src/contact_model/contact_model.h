// Contact models: from the intersecting triangles of two meshes to contact regions, in the body frame of mesh A.
#pragma once

#include "contact_model/crossing_triangles.h"
#include "contact_model/marks.h"
#include "contact_region.h"

namespace kolize {

// The part of one mesh that lies inside the other behind one region.
struct InnerPatch {
    std::vector<std::uint32_t> triangles;  // the region's own first, then those wholly inside
    std::vector<std::uint32_t> vertices;   // inside
    std::vector<std::uint32_t> edges;      // of those triangles
};

// A triangle of either patch in the view along a region's normal, which is the third axis.
struct ViewedTriangle {
    Vec3 corners[3];
    bool of_a = false;
    bool leaves = false;  // its outside is up: a way up through it leaves the body
};

// Where a region lies, and the area of A's surface inside B.
struct RegionArea {
    Vec3 center = Vec3::Zero();
    Vec3 area = Vec3::Zero();
};

struct ContourScratch {
    std::vector<ContourSegment> segments;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> ends;  // (crossing key, segment), sorted
    std::vector<std::uint32_t> along_edge;                      // of `ends`: the crossings of one edge, in their order
    std::vector<std::uint32_t> inside_of;                       // per vertex that is marked: a segment of its region
    std::vector<Vec3> points;
    std::vector<std::uint32_t> curve;    // the segments that `points` stand on
    std::vector<RegionArea> other_side;  // the regions after the nudge to the other side
    InnerPatch patch_a, patch_b;
    std::vector<ViewedTriangle> view;
    Marks vertices, triangles, edges;
    Marks pierced_a, pierced_b;    // edges that go through a triangle of the other mesh
    Marks repeated_a, repeated_b;  // of them, those that go through more than one

    // For meshes of at most these sizes; memory that is never used is never touched.
    void reserve(std::size_t vertices, std::size_t edges, std::size_t triangles);
};

// One region for each connected part of the overlap of two closed meshes. They may touch, share corners, edges or
// faces, or be the same: ties are decided as if A were moved by an infinitesimal step (see Nudge), so touching surfaces
// overlap if that step, towards B, makes them do so.
//
// Normal: direction of the vector area sum 1/2 p x q of the oriented curve, which is the outward area of A's surface
// inside B and the gradient of the overlap volume under translation (divergence theorem; Faure, Allard et al.
// 2008-2010). Where a thin part is pierced right through, that gradient vanishes or means little: the loops of the
// region are then turned to agree with the line of centres, which leads out on the side the body came from.
// Where faces of both bodies lie in one plane along the line of centres, the volume has no gradient but one on either
// side; then the mean of the two is taken.
// Depth and points: see overlap_depth.h.
void contour_regions(const MeshPair& pair, std::span<const TriangleHit> hits, ContourScratch& scratch,
                     std::vector<ContactRegion>& regions);

// Whether contour_regions would find any.
bool surfaces_cross(const MeshPair& pair, std::span<const TriangleHit> hits);

// The baseline of the source thesis: one contact whatever the number of places. Point: mean of the intersection points
// that two triangle pairs found bitwise alike (of all points, if none was). Normal: mean of the triangle normals of the
// body with fewer intersecting triangles, or of the static body. Where that mean vanishes the line of centres is taken.
void averaged_region(const MeshPair& pair, std::span<const TriangleHit> hits, bool a_is_static, bool b_is_static,
                     ContourScratch& scratch, std::vector<ContactRegion>& regions);

}  // namespace kolize
