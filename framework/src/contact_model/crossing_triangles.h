// Where two triangles cross, decided exactly and without ties.
#pragma once

#include "exact_volume.h"

#include <kolize/mesh_narrowphase.h>

#include <array>
#include <cstdint>
#include <optional>

namespace kolize {

// The infinitesimal step by which A is thought to be moved wherever exact arithmetic finds a tie: first towards the
// centre of B, so that touching solids count as overlapping; where that leaves the tie, by something infinitely smaller
// along a coordinate axis, and another one. Every tie is decided as the determinants at hand change to first order,
// which is how two solids in general position would decide it: neighbouring triangle pairs always agree, and the curve
// of intersection of closed meshes is closed. Exchanging the bodies turns the step round: it is the same relative
// motion. After Edelsbrunner & Muecke, "Simulation of simplicity", ACM TOG 9(1), 1990, with a translation in place of
// independent perturbations, so that coplanar faces stay parallel and never cross.
class Nudge {
public:
    explicit Nudge(const Vec3& towards_b);

    // Sign of step . (u x v); 0 only if u and v are parallel.
    int sign_of(const Span& u, const Span& v);

    // Whether the step towards B has left a tie that one of the others has decided: faces of both bodies lie in a plane
    // with the line of centres. The opposite is then as good.
    bool went_sideways() const { return went_sideways_; }
    Nudge to_other_side() const;

private:
    std::array<Vec3, 3> steps_;  // each infinitely smaller than the one before
    bool went_sideways_ = false;
};

// Where an edge of one mesh goes through a triangle of the other. The ids alone say which crossing it is, so the two
// triangle pairs that share it agree without comparing coordinates.
struct Crossing {
    std::uint64_t key = 0;  // (whose edge, edge, triangle)
    Vec3 point = Vec3::Zero();
    double part = 0;  // of the edge, from its lower vertex
    bool edge_of_a = false;
    bool goes_in = false;  // seen along the edge, from its lower vertex to the higher
    std::uint32_t edge = 0;
    std::uint32_t inner_vertex = 0;  // the end of the edge that lies behind the triangle
};

struct ContourSegment {
    Crossing from, to;  // along normal_A x normal_B: every crossing is the end of one segment and the start of the next
    std::uint32_t triangle_a = 0, triangle_b = 0;
    std::uint32_t loop = 0;    // union-find; afterwards the first segment of the closed curve that this one is part of
    std::uint32_t region = 0;  // likewise, of the connected part of the overlap
};

// The common segment of a triangle of A and one of B, or nothing.
std::optional<ContourSegment> cross(const MeshPair& pair, Nudge& nudge, std::uint32_t triangle_a,
                                    std::uint32_t triangle_b);

}  // namespace kolize
