// The gap between two convex features, points, segments or triangles, and the plane that separates them.
#pragma once

#include <kolize/math.h>

#include <array>

namespace kolize {

struct ConvexFeature {
    std::array<Vec3, 3> corners;
    int count = 3;  // 3; 2: a segment; 1: a point

    int edges() const { return count < 3 ? 1 : 3; }  // a point counts as one edge without length
    Vec3 edge(int k) const { return corners[(k + 1) % count] - corners[k]; }
};

struct FeatureGap {
    double distance = infinity;  // m, of the nearest points; of triangles that intersect it says nothing
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  // nearest points
    Vec3 normal = Vec3::Zero();  // unit, from A to B: of the separating plane, or any where there is none
    double projected = 0;        // m, least of normal . (corner of B - corner of A): > 0 proves the features apart
    // Directions in A or B that lie in the separating plane: as the bodies turn, the plane has to turn with them.
    struct Tie {
        Vec3 direction = Vec3::Zero();
        bool of_a = false;
    };
    std::array<Tie, 2> ties;
    int tie_count = 0;
};

// Nearest points: of all pairs of edges, and of corners over faces (Ericson, Real-Time Collision Detection, 5.1). The
// direction between them is lost in rounding when they are close; then the plane is taken along the faces and edges.
FeatureGap gap_between(const ConvexFeature& a, const ConvexFeature& b);

// Least of normal . (corner of B - corner of A).
double projected_gap(const ConvexFeature& a, const ConvexFeature& b, const Vec3& normal);

}  // namespace kolize
