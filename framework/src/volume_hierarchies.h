// Spheres, turned boxes or k-DOPs at the nodes of the meshes' hierarchies, and the walk's comparisons of them.
//
// The tree is the mesh's own (kolize/hierarchy.h), its boxes exchanged for volumes that are fitted to the triangles
// below each node. Doubles, and a bound for their rounding: what intersects is never told apart.
#pragma once

#include "bounding_volumes/slab_reach.h"
#include "box_filter.h"

#include <kolize/bounding_volumes.h>
#include <kolize/mesh_narrowphase.h>

#include <vector>

namespace kolize {

// Of one mesh, by node; one of the lists is filled.
struct NodeVolumes {
    std::vector<BoundingSphere> spheres;
    std::vector<OrientedBox> boxes;
    std::vector<SlabReach> slabs;
};

struct MeshNarrowphase::VolumeHierarchies {
    VolumeKind kind;
    std::vector<NodeVolumes> shapes;  // by shape of the world; empty where the shape has no mesh

    VolumeHierarchies(VolumeKind node_kind, const World& world);
};

// Everything that is compared comes from a few dozen roundings of something no larger than the two meshes and the way
// between them.
inline double comparison_slack(const MeshPair& pair) {
    const double reach = pair.a.radius + pair.b.radius + pair.b_to_a.translation.norm();
    return 256 * std::numeric_limits<double>::epsilon() * reach;
}

class SphereNodes {
public:
    SphereNodes(const MeshPair& pair, const NodeVolumes& a, const NodeVolumes& b)
        : a_(a.spheres), b_(b.spheres), b_to_a_(pair.b_to_a), slack_(comparison_slack(pair)) {}

    bool near(std::size_t i, std::size_t j) const {
        constexpr double underflow = 1e-300;
        const double reach = a_[i].radius + b_[j].radius + slack_;
        return !((b_to_a_ * b_[j].center - a_[i].center).squaredNorm() > reach * reach + underflow);
    }

private:
    const std::vector<BoundingSphere>&a_, &b_;
    Transform b_to_a_;
    double slack_;
};

// All fifteen axes: Gottschalk, Lin & Manocha, "OBBTree", SIGGRAPH 1996.
class BoxNodes {
public:
    BoxNodes(const MeshPair& pair, const NodeVolumes& a, const NodeVolumes& b)
        : a_(a.boxes), b_(b.boxes), b_to_a_(pair.b_to_a), slack_(comparison_slack(pair)) {}

    bool near(std::size_t i, std::size_t j) const;

private:
    const std::vector<OrientedBox>&a_, &b_;
    Transform b_to_a_;
    double slack_;
};

// Along the directions of both frames. How far a k-DOP reaches in a direction of the other's is bounded by the same sum
// of three of its own directions at every node, so that nothing is turned on the way.
class SlabNodes {
public:
    SlabNodes(const MeshPair& pair, const NodeVolumes& a, const NodeVolumes& b, int slabs);

    bool near(std::size_t i, std::size_t j) const;

private:
    const std::vector<SlabReach>&a_, &b_;
    int slabs_;
    double slack_;
    std::array<SlabSum, 13> of_b_, of_a_;           // in directions of A's frame for B, and the other way round
    std::array<double, 13> along_a_{}, along_b_{};  // of the way from A's origin to B's
};

// What HierarchyWalk asks for: nodes by their volumes, triangles by their boxes.
template <class Nodes>
class NodeFilter {
public:
    NodeFilter(const MeshPair& pair, const BoxFilter& boxes, const Nodes& nodes)
        : first_a_(pair.a.hierarchy.nodes.data()),
          first_b_(pair.b.hierarchy.nodes.data()),
          boxes_(boxes),
          nodes_(nodes) {}

    unsigned nodes_near(const HierarchyNode* const (&a)[2], const HierarchyNode* const (&b)[2]) const {
        unsigned mask = 0;
        for (int i = 0; i < (a[0] == a[1] ? 1 : 2); ++i)
            for (int j = 0; j < (b[0] == b[1] ? 1 : 2); ++j)
                mask |= unsigned(nodes_.near(a[i] - first_a_, b[j] - first_b_)) << (2 * i + j);
        return mask;
    }
    unsigned triangles_near(const TriangleBlock& a, const TriangleBlock& b) const {
        return boxes_.triangles_near(a, b);
    }

private:
    const HierarchyNode *first_a_, *first_b_;
    const BoxFilter& boxes_;
    const Nodes& nodes_;
};

}  // namespace kolize
