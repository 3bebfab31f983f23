#include <kolize/self_intersection.h>

#include <algorithm>
#include <optional>

namespace kolize {

namespace {

using Corners = std::array<Vec3, 3>;

// Six times the volume of the tetrahedron (a, b, c, d), or zero if rounding leaves its sign open.
//
// With u, v, w the corners as seen from d, e the rounding unit and M the largest coordinate: the sum below is wrong by
// less than 7.1 e P, where P is the sum of its absolute terms (Shewchuk, "Adaptive precision floating-point arithmetic
// and fast robust geometric predicates", Discrete Comput. Geom. 18, 1997), and P <= 2 M (u^2 + v^2 + w^2). Coordinates
// come rounded, too: one that was turned and moved into place by four roundings or so. Those move u, v and w by
// 8 sqrt(3) e M at most, and the volume by 14 e M (u^2 + v^2 + w^2). Both together are below 30 e M (u^2 + v^2 + w^2).
class CertainVolume {
public:
    explicit CertainVolume(double largest_coordinate)
        : bound_(15 * std::numeric_limits<double>::epsilon() * largest_coordinate) {}

    double operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
        const Vec3 u = a - d, v = b - d, w = c - d;
        const double volume = u.dot(v.cross(w));
        return std::abs(volume) > bound_ * (u.squaredNorm() + v.squaredNorm() + w.squaredNorm()) ? volume : 0;
    }

private:
    double bound_;
};

Aabb bounds_of(const TriangleSoup& surface) {
    Aabb box;
    for (const Triangle& t : surface.triangles)
        for (const std::uint32_t v : t) box.include(surface.vertices[v]);
    return box;
}

// The vertices in a cube of unit size about the origin, where the boxes of a hierarchy are tight. Rounding keeps the
// order of coordinates: boxes that overlap still do.
TriangleSoup to_unit_cube(const TriangleSoup& surface, const Aabb& bounds) {
    TriangleSoup result{{}, surface.triangles, {}, {}};
    const double size = bounds.half_extents().maxCoeff();
    const double scale = size > std::numeric_limits<double>::min() ? 0.5 / size : 1;
    for (const Vec3& p : surface.vertices) result.vertices.push_back((p - bounds.center()) * scale);
    return result;
}

bool opposite(double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); }

class Finder {
public:
    explicit Finder(const TriangleSoup& surface)
        : surface_(surface),
          bounds_(bounds_of(surface)),
          volume_(surface.triangles.empty() ? 0 : bounds_.min.cwiseAbs().cwiseMax(bounds_.max.cwiseAbs()).maxCoeff()) {
        const TriangleSoup local = to_unit_cube(surface, bounds_);
        hierarchy_ = build_hierarchy(local.vertices, local.triangles);
        boxes_.resize(surface.triangles.size());
        for (std::uint32_t t = 0; t < boxes_.size(); ++t)
            for (const std::uint32_t v : local.triangles[t]) boxes_[t].include(local.vertices[v]);
    }

    SelfIntersections run() {
        for (std::uint32_t t = 0; t < boxes_.size(); ++t) visit(0, t);
        return found_;
    }

private:
    Corners corners(std::uint32_t triangle) const {
        const auto& [a, b, c] = surface_.triangles[triangle];
        return {surface_.vertices[a], surface_.vertices[b], surface_.vertices[c]};
    }

    bool have_common_vertex(std::uint32_t a, std::uint32_t b) const {
        const Triangle &ta = surface_.triangles[a], &tb = surface_.triangles[b];
        return std::find_first_of(ta.begin(), ta.end(), tb.begin(), tb.end()) != ta.end();
    }

    // Looks below a node for triangles of higher ids that cross the given one.
    void visit(std::uint32_t index, std::uint32_t triangle) {
        const HierarchyNode& node = hierarchy_.nodes[index];
        if (is_apart(node, boxes_[triangle])) return;
        if (!node.is_leaf()) {
            visit(node.first, triangle);
            visit(node.first + 1, triangle);
            return;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const std::uint32_t other = hierarchy_.order[i];
            if (other <= triangle || !boxes_[other].overlaps(boxes_[triangle])) continue;
            if (!have_common_vertex(triangle, other)) look_at(triangle, other);
        }
    }

    // Centre and half extents of a node are exact, but not their sum.
    static bool is_apart(const HierarchyNode& node, const Aabb& box) {
        constexpr auto slack = 2 * std::numeric_limits<double>::epsilon();
        const Vec3 center = node.center.cast<double>(), half = node.half.cast<double>();
        return (box.min.array() > (center + half).array() + slack).any() ||
               (box.max.array() < (center - half).array() - slack).any();
    }

    // Pairs come by their lower id, but by their higher one in any order.
    void look_at(std::uint32_t lower, std::uint32_t higher) {
        const Corners a = corners(lower), b = corners(higher);
        std::optional<Vec3> point = find_passage(a, b);
        if (!point) point = find_passage(b, a);
        if (!point) return;
        const bool first = found_.pairs++ == 0 || (found_.triangle_a == lower && higher < found_.triangle_b);
        if (first) found_ = {found_.pairs, lower, higher, *point};
    }

    // Where the first side of a triangle that does so passes through another triangle.
    std::optional<Vec3> find_passage(const Corners& triangle, const Corners& face) const {
        double height[3];
        for (int k = 0; k < 3; ++k) height[k] = volume_(face[0], face[1], face[2], triangle[k]);
        for (int k = 0; k < 3; ++k) {
            const int next = (k + 1) % 3;
            if (!opposite(height[k], height[next]) || !passes_within(triangle[k], triangle[next], face)) continue;
            const double part = std::abs(height[k]) / (std::abs(height[k]) + std::abs(height[next]));
            return triangle[k] + part * (triangle[next] - triangle[k]);
        }
        return std::nullopt;
    }

    // The line through p and q runs past all three sides of the face on the same side.
    bool passes_within(const Vec3& p, const Vec3& q, const Corners& face) const {
        const double past[3] = {volume_(p, q, face[0], face[1]), volume_(p, q, face[1], face[2]),
                                volume_(p, q, face[2], face[0])};
        return (past[0] > 0 && past[1] > 0 && past[2] > 0) || (past[0] < 0 && past[1] < 0 && past[2] < 0);
    }

    const TriangleSoup& surface_;
    Aabb bounds_;
    CertainVolume volume_;
    Hierarchy hierarchy_;      // in the unit cube
    std::vector<Aabb> boxes_;  // of the triangles, in the unit cube
    SelfIntersections found_;
};

}  // namespace

SelfIntersections find_self_intersections(const TriangleSoup& surface) { return Finder(surface).run(); }

}  // namespace kolize
