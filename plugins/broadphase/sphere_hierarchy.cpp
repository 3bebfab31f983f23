// Broadphase by a hierarchy of bounding spheres: groups of boxes whose spheres are apart cannot overlap.
//
// Spheres are rounded outward, and what they leave is tested box against box. While boxes stay near their neighbours
// the tree of the last step is kept and only its spheres are made anew.
#include <kolize/plugin.h>

#include <algorithm>

namespace {

using kolize::Aabb;
using kolize::Pair;
using kolize::Vec3;

// Relative error of the few roundings between a box and a sphere test, with a wide margin.
constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();

struct Sphere {
    Vec3 center = Vec3::Zero();
    double radius = 0;

    // Computed radii are too small by a part of themselves, and by what the center was rounded.
    Sphere(const Vec3& c, double r) : center(c), radius(r + rounding * (r + c.cwiseAbs().maxCoeff())) {}
    Sphere() = default;

    // Coordinates beyond 1e150 overflow to infinity or NaN here: not known to be apart.
    bool is_apart_from(const Sphere& o) const {
        const double reach = radius + o.radius;
        return (center - o.center).squaredNorm() > reach * reach;
    }
};

Sphere sphere_around(const Aabb& box) {
    const Vec3 half = 0.5 * box.max - 0.5 * box.min;
    return {0.5 * box.min + 0.5 * box.max, half.norm()};
}

Sphere sphere_around(const Sphere& a, const Sphere& b) {
    const Vec3 offset = b.center - a.center;
    const double distance = offset.norm();
    if (distance + b.radius <= a.radius) return a;
    if (distance + a.radius <= b.radius) return b;
    const double radius = 0.5 * (distance + a.radius + b.radius);
    return {a.center + offset * ((radius - a.radius) / distance), radius};
}

Aabb united(const Aabb& a, const Aabb& b) { return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)}; }

// Of the sphere around two spheres and the one around a box, now one is tighter and now the other.
const Sphere& smaller(const Sphere& a, const Sphere& b) { return a.radius < b.radius ? a : b; }

// The left child of node n is node n + 1.
struct Node {
    Sphere sphere = {};
    std::uint32_t right = 0;  // 0: a leaf
    std::uint32_t begin = 0, end = 0;
    bool is_static = false;  // every box of it
};

struct Item {
    Aabb box;
    std::uint32_t row = 0;
    bool is_static = false;
};

class SphereHierarchy final : public kolize::Broadphase {
public:
    static void parameters(kolize::Parameters<SphereHierarchy>& p) {
        p.add("leaf_size", &SphereHierarchy::leaf_size_).range(1, 1e6).doc("Most boxes in a leaf of the tree.");
        p.add("rebuild_at", &SphereHierarchy::rebuild_at_)
            .range(1, 1e6)
            .doc("The tree is built anew when its spheres have grown by this factor on average.");
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) override {
        kolize::require_valid_bounds(input.bounds);
        if (input.bounds.size() < 2) return;
        update(input);
        pairs_ = &pairs;
        find_within(0);
    }

    // The spheres of the tree; the level is the depth.
    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        kolize::require_valid_bounds(input.bounds);
        if (input.bounds.empty()) return;
        update(input);
        add_spheres(0, 0, outline);
    }

private:
    void update(const kolize::BroadphaseInput& input) {
        if (input.generation != generation_ || input.bounds.size() != items_.size()) {
            build(input);
        } else {
            for (Item& item : items_) item.box = input.bounds[item.row];
            fit_spheres();
            if (total_radius() > rebuild_at_ * built_radius_) build(input);
        }
    }

    void add_spheres(std::uint32_t index, std::uint32_t level, kolize::Outline& outline) const {
        const Node& node = nodes_[index];
        outline.balls.push_back({node.sphere.center, node.sphere.radius, level});
        if (node.right == 0) return;
        add_spheres(index + 1, level + 1, outline);
        add_spheres(node.right, level + 1, outline);
    }

    void build(const kolize::BroadphaseInput& input) {
        generation_ = input.generation;
        items_.clear();
        for (std::uint32_t row = 0; row < input.bounds.size(); ++row)
            items_.push_back({input.bounds[row], row, input.is_static[row] != 0});
        nodes_.clear();
        divide(0, static_cast<std::uint32_t>(items_.size()));
        fit_spheres();
        built_radius_ = total_radius();
    }

    // Halves the boxes at the median of their centres along the axis on which these are spread most.
    std::uint32_t divide(std::uint32_t begin, std::uint32_t end) {
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back({.begin = begin, .end = end});
        if (end - begin > static_cast<std::uint32_t>(leaf_size_)) {
            const int axis = longest_axis(begin, end);
            const std::uint32_t middle = begin + (end - begin) / 2;
            std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                             [axis](const Item& a, const Item& b) { return center(a, axis) < center(b, axis); });
            divide(begin, middle);
            nodes_[index].right = divide(middle, end);
        }
        return index;
    }

    // Children stand behind their parent: from the back, every sphere finds those it has to enclose.
    void fit_spheres() {
        extents_.resize(nodes_.size());
        for (std::size_t n = nodes_.size(); n-- > 0;) {
            Node& node = nodes_[n];
            if (node.right == 0) {
                fit_leaf(node, extents_[n]);
            } else {
                const Node &left = nodes_[n + 1], &right = nodes_[node.right];
                extents_[n] = united(extents_[n + 1], extents_[node.right]);
                node.sphere = smaller(sphere_around(left.sphere, right.sphere), sphere_around(extents_[n]));
                node.is_static = left.is_static && right.is_static;
            }
        }
    }

    void fit_leaf(Node& leaf, Aabb& extent) const {
        extent = items_[leaf.begin].box;
        leaf.sphere = sphere_around(extent);
        leaf.is_static = items_[leaf.begin].is_static;
        for (std::uint32_t i = leaf.begin + 1; i < leaf.end; ++i) {
            extent = united(extent, items_[i].box);
            leaf.sphere = smaller(sphere_around(leaf.sphere, sphere_around(items_[i].box)), sphere_around(extent));
            leaf.is_static = leaf.is_static && items_[i].is_static;
        }
    }

    double total_radius() const {
        double sum = 0;
        for (const Node& node : nodes_) sum += node.sphere.radius;
        return sum;
    }

    static double center(const Item& item, int axis) { return 0.5 * item.box.min[axis] + 0.5 * item.box.max[axis]; }

    int longest_axis(std::uint32_t begin, std::uint32_t end) const {
        Aabb centers;
        for (std::uint32_t i = begin; i < end; ++i) centers.include(items_[i].box.center());
        int axis = 0;
        (centers.max - centers.min).maxCoeff(&axis);
        return axis;
    }

    void find_within(std::uint32_t index) {
        const Node& node = nodes_[index];
        if (node.is_static) return;
        if (node.right == 0) {
            for (std::uint32_t i = node.begin; i < node.end; ++i)
                for (std::uint32_t j = i + 1; j < node.end; ++j) test(items_[i], items_[j]);
            return;
        }
        find_within(index + 1);
        find_within(node.right);
        find_between(index + 1, node.right);
    }

    // The larger sphere is opened first: that is the one more likely to hold nothing near the other.
    void find_between(std::uint32_t a, std::uint32_t b) {
        const Node& node_a = nodes_[a];
        const Node& node_b = nodes_[b];
        if (node_a.sphere.is_apart_from(node_b.sphere) || (node_a.is_static && node_b.is_static)) return;
        if (node_a.right != 0 && (node_b.right == 0 || node_a.sphere.radius >= node_b.sphere.radius)) {
            find_between(a + 1, b);
            find_between(node_a.right, b);
        } else if (node_b.right != 0) {
            find_between(a, b + 1);
            find_between(a, node_b.right);
        } else {
            for (std::uint32_t i = node_a.begin; i < node_a.end; ++i)
                for (std::uint32_t j = node_b.begin; j < node_b.end; ++j) test(items_[i], items_[j]);
        }
    }

    void test(const Item& a, const Item& b) {
        if (a.box.overlaps(b.box) && !(a.is_static && b.is_static))
            pairs_->push_back({std::min(a.row, b.row), std::max(a.row, b.row)});
    }

    int leaf_size_ = 2;
    double rebuild_at_ = 1.03;

    std::uint64_t generation_ = 0;
    double built_radius_ = 0;  // m, the sum over all nodes when the tree was built
    std::vector<Item> items_;  // in the order of the leaves
    std::vector<Node> nodes_;
    std::vector<Aabb> extents_;  // of all boxes below each node; only to find the smaller sphere
    std::vector<Pair>* pairs_ = nullptr;
};

}  // namespace

KOLIZE_PLUGIN(
    SphereHierarchy, .name = "sphere_hierarchy", .summary = "binary tree of bounding spheres",
    .source =
        "Hubbard, Approximating polyhedra with spheres for time-critical collision detection (1996), 3; Ericson, "
        "Real-Time Collision Detection (2005), 6.2.1 and 6.5.1",
    .cost =
        "O(N log N) to build and about O(N + pairs) to walk; O(N) instead of building while the tree of the last step "
        "is kept. About 200 bytes a box.",
    .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
    .choose = "Bodies of very different sizes or uneven density; for similar ones grid is several times faster.",
    .capabilities = {.exact = true, .outline = "spheres"})
