#include "volume_hierarchies.h"

#include "bounding_volumes/box_search.h"

namespace kolize {

namespace {

class NodeFitter {
public:
    NodeFitter(const Mesh& mesh, VolumeKind kind) : mesh_(mesh), kind_(kind) {
        const std::size_t count = mesh.hierarchy.nodes.size();
        if (kind == VolumeKind::sphere) result_.spheres.resize(count);
        if (kind == VolumeKind::obb) result_.boxes.resize(count);
        if (kind == VolumeKind::kdop18 || kind == VolumeKind::kdop26) result_.slabs.resize(count);
        if (count > 0) fit(0);
    }

    NodeVolumes take() { return std::move(result_); }

private:
    // Appends the corners below a node to `points_`, after those that are there.
    void fit(std::uint32_t index) {
        const HierarchyNode& node = mesh_.hierarchy.nodes[index];
        const std::size_t begin = points_.size();
        if (node.is_leaf()) {
            for (std::uint32_t i = 0; i < node.count; ++i)
                for (const std::uint32_t v : mesh_.triangles[mesh_.hierarchy.order[node.first + i]])
                    points_.push_back(mesh_.vertices[v]);
        } else {
            fit(node.first);
            fit(node.first + 1);
        }
        enclose(index, std::span(points_).subspan(begin));
    }

    void enclose(std::uint32_t index, std::span<const Vec3> points) {
        if (kind_ == VolumeKind::sphere) result_.spheres[index] = smallest_enclosing_sphere(points);
        if (kind_ == VolumeKind::obb) result_.boxes[index] = principal_box(points);
        if (!result_.slabs.empty())
            result_.slabs[index] = slab_reach(points, 0, Mat3::Identity(), kind_ == VolumeKind::kdop18 ? 9 : 13);
    }

    const Mesh& mesh_;
    VolumeKind kind_;
    NodeVolumes result_;
    std::vector<Vec3> points_;
};

}  // namespace

MeshNarrowphase::VolumeHierarchies::VolumeHierarchies(VolumeKind node_kind, const World& world) : kind(node_kind) {
    for (const Shape& shape : world.shapes)
        shapes.push_back(shape.mesh ? NodeFitter(*shape.mesh, kind).take() : NodeVolumes{});
}

bool BoxNodes::near(std::size_t i, std::size_t j) const {
    const OrientedBox &a = a_[i], &b = b_[j];
    const Vec3 &ha = a.half_extents, &hb = b.half_extents;
    const Mat3 turn = a.axes.transpose() * b_to_a_.rotation * b.axes, reach = turn.cwiseAbs();
    const Vec3 way = a.axes.transpose() * (b_to_a_ * b.center - a.center);
    if (((way.cwiseAbs() - ha - reach * hb).array() > slack_).any()) return false;
    if ((((turn.transpose() * way).cwiseAbs() - hb - reach.transpose() * ha).array() > slack_).any()) return false;
    for (int k = 0; k < 3; ++k) {
        const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        for (int l = 0; l < 3; ++l) {
            const int l1 = (l + 1) % 3, l2 = (l + 2) % 3;
            const double of_a = ha[k1] * reach(k2, l) + ha[k2] * reach(k1, l);
            const double of_b = hb[l1] * reach(k, l2) + hb[l2] * reach(k, l1);
            if (std::abs(way[k2] * turn(k1, l) - way[k1] * turn(k2, l)) - of_a - of_b > slack_) return false;
        }
    }
    return true;
}

SlabNodes::SlabNodes(const MeshPair& pair, const NodeVolumes& a, const NodeVolumes& b, int slabs)
    : a_(a.slabs), b_(b.slabs), slabs_(slabs), slack_(2 * comparison_slack(pair)) {
    const Mat3& turn = pair.b_to_a.rotation;
    for (int k = 0; k < slabs; ++k) {
        of_b_[k] = slab_sum(turn.transpose() * slab_direction(k), slabs);
        of_a_[k] = slab_sum(turn * slab_direction(k), slabs);
        along_a_[k] = slab_direction(k).dot(pair.b_to_a.translation);
        along_b_[k] = slab_direction(k).dot(turn.transpose() * pair.b_to_a.translation);
    }
}

bool SlabNodes::near(std::size_t i, std::size_t j) const {
    const SlabReach &a = a_[i], &b = b_[j];
    for (int k = 0; k < slabs_; ++k)
        if (along_a_[k] - of_b_[k].of_opposite(b) - a[2 * k] > slack_ ||
            -along_a_[k] - of_b_[k].of(b) - a[2 * k + 1] > slack_ ||
            along_b_[k] - b[2 * k + 1] - of_a_[k].of(a) > slack_ ||
            -along_b_[k] - b[2 * k] - of_a_[k].of_opposite(a) > slack_)
            return false;
    return true;
}

}  // namespace kolize
