#include <kolize/hierarchy.h>

#include <algorithm>
#include <numeric>

namespace kolize {

namespace {

constexpr double largest = std::numeric_limits<float>::max();

float nearest_float(double x) { return static_cast<float>(std::clamp(x, -largest, largest)); }

// The smallest float that is not below x (>= 0).
float round_up(double x) {
    const float nearest = nearest_float(x);
    return nearest < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

class Builder {
public:
    Builder(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles) {
        for (const auto& triangle : triangles) {
            for (const std::uint32_t v : triangle) corners_.push_back(vertices[v]);
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
        fill_blocks();
        return std::move(result_);
    }

private:
    // Fills a node with the triangles order[begin, end).
    void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
        const Aabb box = fit(node, begin, end);
        if (end - begin <= TriangleBlock::size) {
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
        constexpr double outward = 1 + 2 * std::numeric_limits<double>::epsilon();
        const Vec3f center = box.center().unaryExpr(&nearest_float);
        const Vec3 seen_from = center.cast<double>();
        result_.nodes[node].center = center;
        result_.nodes[node].half = ((box.max - seen_from).cwiseMax(seen_from - box.min) * outward).unaryExpr(&round_up);
        return box;
    }

    // A whole number of blocks goes to the left: every leaf but the last is full and begins a block.
    static std::uint32_t middle_of(std::uint32_t begin, std::uint32_t end) {
        const std::uint32_t blocks = (end - begin + TriangleBlock::size - 1) / TriangleBlock::size;
        return begin + (blocks + 1) / 2 * TriangleBlock::size;
    }

    // Equal centroids keep the order of their triangles: the tree depends on the mesh alone.
    std::uint32_t split(const Aabb& box, std::uint32_t begin, std::uint32_t end) {
        int axis = 0;
        (box.max - box.min).maxCoeff(&axis);
        const std::uint32_t middle = middle_of(begin, end);
        const auto order = result_.order.begin();
        std::nth_element(order + begin, order + middle, order + end, [&](std::uint32_t a, std::uint32_t b) {
            const double ca = centroids_[a][axis], cb = centroids_[b][axis];
            return ca != cb ? ca < cb : a < b;
        });
        return middle;
    }

    void fill_blocks() {
        const std::size_t count = result_.order.size();
        result_.blocks.resize((count + TriangleBlock::size - 1) / TriangleBlock::size);
        for (std::size_t i = 0; i < result_.blocks.size() * TriangleBlock::size; ++i) {
            const std::uint32_t triangle = result_.order[std::min(i, count - 1)];
            for (int k = 0; k < 3; ++k)
                for (int axis = 0; axis < 3; ++axis)
                    result_.blocks[i / TriangleBlock::size].corners[k][axis][i % TriangleBlock::size] =
                        nearest_float(corners_[3 * triangle + k][axis]);
        }
    }

    std::vector<Vec3> corners_;  // three a triangle
    std::vector<Aabb> boxes_;
    std::vector<Vec3> centroids_;
    Hierarchy result_;
};

}  // namespace

Hierarchy build_hierarchy(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles) {
    return Builder(vertices, triangles).run();
}

}  // namespace kolize
