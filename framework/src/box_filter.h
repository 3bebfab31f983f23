// Boxes of two placed meshes in float, four pairs at a time: certainly apart, or not.
#pragma once

#include "lanes.h"

#include <kolize/mesh_narrowphase.h>

namespace kolize {

// Compares along the face axes of both frames; edge axes rarely reject more than they cost (Gottschalk, Lin & Manocha,
// "OBBTree", SIGGRAPH 1996, have all fifteen). Rounding never makes two boxes seem apart, so what the exact triangle
// test sees decides, and the result is the same with any instruction set.
class BoxFilter {
public:
    explicit BoxFilter(const MeshPair& pair);

    // Bit 2 i + j is set unless a[i] and b[j] are certainly apart.
    unsigned nodes_near(const HierarchyNode* const (&a)[2], const HierarchyNode* const (&b)[2]) const;

    // Bit 4 i + j is set unless the boxes, in A's frame, of triangle i of A and triangle j of B are certainly apart.
    unsigned triangles_near(const TriangleBlock& a, const TriangleBlock& b) const;

private:
    Lanes rotation_[3][3];  // B's frame to A's
    Lanes reach_[3][3];     // its absolute values
    Lanes translation_[3];
    Lanes slack_;  // m, more than all rounding can amount to
};

}  // namespace kolize
