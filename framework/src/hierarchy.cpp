#include <kolize/hierarchy.h>

#include <algorithm>
#include <numeric>

namespace kolize {

namespace {

constexpr std::uint32_t max_leaf = 4;  // triangles

class Builder {
public:
    Builder(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles) {
        for (const auto& triangle : triangles) {
            Aabb& box = boxes_.emplace_back();
            for (const std::uint32_t v : triangle) box.include(vertices[v]);
            centroids_.push_back((vertices[triangle[0]] + vertices[triangle[1]] + vertices[triangle[2]]) / 3);
        }
        result_.order.resize(triangles.size());
        std::iota(result_.order.begin(), result_.order.end(), 0u);
    }

    Hierarchy run() {
        const auto count = static_cast<std::uint32_t>(result_.order.size());
        if (count == 0) return {};
        result_.nodes.emplace_back();
        build(0, 0, count);
        return std::move(result_);
    }

private:
    // Fills a node with the triangles order[begin, end).
    void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
        const Aabb box = fit(node, begin, end);
        if (end - begin <= max_leaf) {
            result_.nodes[node].first = begin;
            result_.nodes[node].count = end - begin;
            return;
        }
        const std::uint32_t middle = split(box, begin, end);
        const auto left = static_cast<std::uint32_t>(result_.nodes.size());
        result_.nodes[node].first = left;
        result_.nodes.resize(left + 2);
        build(left, begin, middle);
        build(left + 1, middle, end);
    }

    // The half extents are those seen from the rounded centre, rounded outward: no vertex is left out.
    Aabb fit(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
        Aabb box;
        for (std::uint32_t i = begin; i < end; ++i) {
            box.include(boxes_[result_.order[i]].min);
            box.include(boxes_[result_.order[i]].max);
        }
        const Vec3 center = box.center();
        constexpr double outward = 1 + 2 * std::numeric_limits<double>::epsilon();
        result_.nodes[node].center = center;
        result_.nodes[node].half = (box.max - center).cwiseMax(center - box.min) * outward;
        return box;
    }

    // Equal centroids keep the order of their triangles: the tree depends on the mesh alone.
    std::uint32_t split(const Aabb& box, std::uint32_t begin, std::uint32_t end) {
        int axis = 0;
        (box.max - box.min).maxCoeff(&axis);
        const std::uint32_t middle = begin + (end - begin) / 2;
        const auto order = result_.order.begin();
        std::nth_element(order + begin, order + middle, order + end, [&](std::uint32_t a, std::uint32_t b) {
            const double ca = centroids_[a][axis], cb = centroids_[b][axis];
            return ca != cb ? ca < cb : a < b;
        });
        return middle;
    }

    std::vector<Aabb> boxes_;
    std::vector<Vec3> centroids_;
    Hierarchy result_;
};

}  // namespace

Hierarchy build_hierarchy(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles) {
    return Builder(vertices, triangles).run();
}

}  // namespace kolize
