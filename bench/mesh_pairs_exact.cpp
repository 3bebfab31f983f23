#include "mesh_pairs_rivals.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <numeric>

namespace bench {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct Solid {
    std::vector<kolize::Aabb> boxes;
    std::vector<Kernel::Triangle_3> triangles;

    Solid(const kolize::TriangleSoup& surface, const kolize::Transform& placement) {
        for (const kolize::Triangle& t : surface.triangles) {
            kolize::Vec3 p[3];
            kolize::Aabb& box = boxes.emplace_back();
            for (int k = 0; k < 3; ++k) box.include(p[k] = placement * surface.vertices[t[k]]);
            const auto point = [](const kolize::Vec3& v) { return Kernel::Point_3(v.x(), v.y(), v.z()); };
            triangles.emplace_back(point(p[0]), point(p[1]), point(p[2]));
        }
    }
};

std::vector<std::uint32_t> by_lower_x(const std::vector<kolize::Aabb>& boxes) {
    std::vector<std::uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](auto i, auto j) { return boxes[i].min.x() < boxes[j].min.x(); });
    return order;
}

}  // namespace

TrianglePairs exact_pairs(const kolize::TriangleSoup& surface, const kolize::Transform& copy_to_mesh) {
    const Solid a(surface, {}), b(surface, copy_to_mesh);
    double widest = 0;
    for (const kolize::Aabb& box : a.boxes) widest = std::max(widest, box.max.x() - box.min.x());
    const std::vector<std::uint32_t> order = by_lower_x(a.boxes);
    TrianglePairs pairs;
    for (std::uint32_t j = 0; j < b.boxes.size(); ++j) {
        const kolize::Aabb& box = b.boxes[j];
        auto i = std::partition_point(order.begin(), order.end(),
                                      [&](auto id) { return a.boxes[id].min.x() < box.min.x() - 2 * widest; });
        for (; i != order.end() && a.boxes[*i].min.x() <= box.max.x(); ++i)
            if (a.boxes[*i].overlaps(box) && CGAL::do_intersect(a.triangles[*i], b.triangles[j]))
                pairs.emplace_back(*i, j);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace bench
