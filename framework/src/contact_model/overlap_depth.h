// How deep two meshes overlap along a region's normal: at the points of its curve, and at most.
#pragma once

#include "contact_model/contact_model.h"

namespace kolize {

// Depths are lengths of chords of the overlap along the normal (m). A vertex inside the other body counts from there to
// that body's surface, whether or not its own body fills all of that way. Exact otherwise, up to faces so steep that
// they are seen edge-on.
class OverlapDepth {
public:
    // Needs join_segments done. Collects both inner patches of the region.
    OverlapDepth(const MeshPair& pair, std::uint32_t region, const Vec3& normal, ContourScratch& scratch);

    struct Chord {
        double length = 0;
        Vec3 middle = Vec3::Zero();  // frame of A
    };

    // Of the longest chord of all: of those from the vertices inside, from the curve, and between edges that cross in
    // the view along the normal. Of large patches only the vertices that reach farthest are tried, and no edges.
    Chord longest();

    // At a point of the curve. Where it lies on an edge within 45 degrees of the normal it stands for the vertex at
    // that edge's inner end: a box that is sunk in a floor has its corners' depths.
    double at(const Crossing& crossing) const;

private:
    struct Hit {
        double gap = infinity;  // m, along the way
        bool exits = true;      // the body that is hit is left there, not entered
    };
    Hit first_hit(const Vec3& from, int up, bool of_a) const;
    double vertex_depth(bool of_a, const Vec3& viewed) const;
    Chord chord_at(const Vec3& viewed) const;
    double edge_depth(const Vec3& on_a, const Vec3& on_b) const;

    void try_vertices(bool of_a, Chord& best);
    void try_curve(Chord& best) const;
    void try_edges(Chord& best) const;
    Chord chord(const Vec3& viewed_end, double length, int up) const;
    Vec3 viewed(bool of_a, std::uint32_t vertex) const;
    void add_view(bool of_a);

    const MeshPair& pair_;
    std::uint32_t region_;
    ContourScratch& scratch_;
    Mat3 axes_;             // rows: two across, the normal
    double tolerance_ = 0;  // m, below which two heights are the same
};

}  // namespace kolize
