#include "mesh_contacts.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace kolize {

using Feature = SurfacePoint::Feature;

// Ericson, Real-Time Collision Detection, 5.1.5: the Voronoi regions of the corners, the edges, then the face.
SurfacePoint nearest_on_triangle(const Mesh& mesh, std::uint32_t triangle, const Vec3& p) {
    const Triangle& t = mesh.triangles[triangle];
    const Triangle& e = mesh.triangle_edges[triangle];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const auto at = [&](const Vec3& point, Feature feature, std::uint32_t id) {
        return SurfacePoint{point, (p - point).norm(), feature, id, triangle};
    };
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d1 <= 0 && d2 <= 0) return at(a, Feature::vertex, t[0]);
    if (d3 >= 0 && d4 <= d3) return at(b, Feature::vertex, t[1]);
    if (d6 >= 0 && d5 <= d6) return at(c, Feature::vertex, t[2]);
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(a + ab * (d1 / (d1 - d3)), Feature::edge, e[0]);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(a + ac * (d2 / (d2 - d6)), Feature::edge, e[2]);
    if (va <= 0 && d4 >= d3 && d5 >= d6)
        return at(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), Feature::edge, e[1]);
    const double scale = 1 / (va + vb + vc);
    return at(a + ab * (vb * scale) + ac * (vc * scale), Feature::face, triangle);
}

namespace {

void collect_near(const Mesh& mesh, const Vec3& center, double radius, std::vector<SurfacePoint>& candidates) {
    candidates.clear();
    if (mesh.hierarchy.nodes.empty()) return;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const HierarchyNode& node = mesh.hierarchy.nodes[stack[--depth]];
        const Vec3 gap = ((center - node.center.cast<double>()).cwiseAbs() - node.half.cast<double>()).cwiseMax(0.0);
        if (gap.squaredNorm() > radius * radius) continue;
        if (!node.is_leaf()) {
            stack[depth++] = node.first;
            stack[depth++] = node.first + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const SurfacePoint s = nearest_on_triangle(mesh, mesh.hierarchy.order[i], center);
            if (s.distance < radius) candidates.push_back(s);
        }
    }
    std::sort(candidates.begin(), candidates.end(), [](const SurfacePoint& x, const SurfacePoint& y) {
        return std::tie(x.feature, x.id, x.triangle) < std::tie(y.feature, y.id, y.triangle);
    });
}

double corner_angle(const Mesh& mesh, std::uint32_t triangle, std::uint32_t vertex) {
    const Triangle& t = mesh.triangles[triangle];
    const int k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    const Vec3 u = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[vertex];
    const Vec3 v = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[vertex];
    return std::atan2(u.cross(v).norm(), u.dot(v));
}

// Angle-weighted normal of the feature that the group shares: its sign tells inside from outside at edges and corners
// too (Baerentzen & Aanaes, IEEE TVCG 11(3), 2005).
Vec3 pseudonormal(const Mesh& mesh, std::span<const SurfacePoint> group) {
    Vec3 sum = Vec3::Zero();
    for (const SurfacePoint& s : group) {
        const double weight = s.feature == Feature::vertex ? corner_angle(mesh, s.triangle, s.id) : 1.0;
        sum += weight * mesh.normals[s.triangle];
    }
    return sum;
}

// A point on an edge or corner is a local minimum of the distance only if every triangle around it says so.
bool is_local_minimum(const Mesh& mesh, std::span<const SurfacePoint> group) {
    const SurfacePoint& s = group.front();
    const std::size_t around = s.feature == Feature::face ? 1 : s.feature == Feature::edge ? 2 : mesh.valence[s.id];
    return group.size() == around;
}

// The smallest distance of any triangle: depth first, the nearer child first, and past boxes that are farther away.
double distance_to_mesh(const Mesh& mesh, const Vec3& p) {
    const auto& nodes = mesh.hierarchy.nodes;
    const auto gap = [&](std::uint32_t i) {
        return ((p - nodes[i].center.cast<double>()).cwiseAbs() - nodes[i].half.cast<double>()).cwiseMax(0.0).norm();
    };
    double nearest = infinity;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t i = stack[--depth];
        const HierarchyNode& node = nodes[i];
        if (gap(i) > nearest) continue;
        if (!node.is_leaf()) {
            const bool first_is_nearer = gap(node.first) <= gap(node.first + 1);
            stack[depth++] = node.first + (first_is_nearer ? 1 : 0);
            stack[depth++] = node.first + (first_is_nearer ? 0 : 1);
            continue;
        }
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
            nearest = std::min(nearest, nearest_on_triangle(mesh, mesh.hierarchy.order[k], p).distance);
    }
    return nearest;
}

// The candidates that share a feature stand side by side.
std::span<const SurfacePoint> group_at(std::span<const SurfacePoint> all, std::size_t begin) {
    std::size_t end = begin + 1;
    while (end < all.size() && all[end].feature == all[begin].feature && all[end].id == all[begin].id) ++end;
    return all.subspan(begin, end - begin);
}

}  // namespace

NearestPoint nearest_on_mesh(const Mesh& mesh, const Vec3& p, MeshScratch& scratch) {
    // All triangles that share the nearest feature; rounding may put them at distances that differ a little.
    const double distance = distance_to_mesh(mesh, p), reach = p.norm() + mesh.radius;
    collect_near(mesh, p, distance + 1e-14 * reach + std::numeric_limits<double>::min(), scratch.candidates);
    const std::span<const SurfacePoint> all = scratch.candidates;
    std::size_t best = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].distance < all[best].distance) best = i;
    while (best > 0 && all[best - 1].feature == all[best].feature && all[best - 1].id == all[best].id) --best;
    NearestPoint nearest{all[best], pseudonormal(mesh, group_at(all, best)).normalized(), distance};
    if (nearest.outward.dot(p - nearest.at.point) < 0) nearest.height = -distance;
    return nearest;
}

void mesh_sphere(const Mesh& mesh, const Vec3& center, double radius, MeshScratch& scratch,
                 std::vector<ContactRegion>& regions) {
    auto& all = scratch.candidates;
    collect_near(mesh, center, radius, all);
    if (all.empty()) return;
    const auto nearest =
        std::min_element(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.distance < y.distance; });
    std::size_t first_of_nearest = 0;
    for (std::size_t i = 0; i < all.size(); i += group_at(all, i).size())
        if (all[i].feature == nearest->feature && all[i].id == nearest->id) first_of_nearest = i;
    const Vec3 outward = pseudonormal(mesh, group_at(all, first_of_nearest));
    const double side = outward.dot(center - nearest->point);
    if (side <= 0) {
        const Vec3 normal =
            nearest->distance > 0 ? Vec3((nearest->point - center) / nearest->distance) : outward.normalized();
        regions.push_back(ContactRegion::single(normal, nearest->point, radius + nearest->distance));
        return;
    }
    for (std::size_t i = 0; i < all.size();) {
        const auto group = group_at(all, i);
        if (i == first_of_nearest || is_local_minimum(mesh, group)) {
            const Vec3 normal = (center - all[i].point) / all[i].distance;
            const double depth = radius - all[i].distance;
            regions.push_back(ContactRegion::single(normal, all[i].point - 0.5 * depth * normal, depth));
        }
        i += group.size();
    }
}

namespace {

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

constexpr std::uint32_t above = ~0u;  // marks a vertex that is not below the plane

// Afterwards parent[v] is the lowest vertex of v's connected part below the plane, or `above`. False if all are above.
bool label_submerged(const Mesh& mesh, const Vec3& normal, double offset, std::vector<std::uint32_t>& parent) {
    parent.resize(mesh.vertices.size());
    bool any = false;
    for (std::uint32_t v = 0; v < parent.size(); ++v) {
        const bool below = normal.dot(mesh.vertices[v]) < offset;
        parent[v] = below ? v : above;
        any = any || below;
    }
    if (!any) return false;
    for (const Edge& edge : mesh.edges) {
        if (parent[edge.v0] == above || parent[edge.v1] == above) continue;
        const auto [low, high] = std::minmax({find_root(parent, edge.v0), find_root(parent, edge.v1)});
        parent[high] = low;
    }
    for (std::uint32_t v = 0; v < parent.size(); ++v)
        if (parent[v] != above) parent[v] = find_root(parent, v);
    return true;
}

}  // namespace

void mesh_half_space(const Mesh& mesh, const Vec3& normal, double offset, MeshScratch& scratch,
                     std::vector<ContactRegion>& regions) {
    if (normal.dot(mesh.bounds.center()) - normal.cwiseAbs().dot(mesh.bounds.half_extents()) >= offset) return;
    if (!label_submerged(mesh, normal, offset, scratch.parent)) return;
    for (std::uint32_t root = 0; root < mesh.vertices.size(); ++root) {
        if (scratch.parent[root] != root) continue;
        scratch.points.clear();
        ContactRegion region;
        for (std::uint32_t v = root; v < mesh.vertices.size(); ++v)
            if (scratch.parent[v] == root) {
                scratch.points.push_back(mesh.vertices[v]);
                region.center += mesh.vertices[v];
                region.depth = std::max(region.depth, offset - normal.dot(mesh.vertices[v]));
            }
        region.normal = -normal;
        std::array<std::uint32_t, 4> chosen;
        for (const std::uint32_t i : spread_points(scratch.points, chosen)) {
            region.depths[region.count] = offset - normal.dot(scratch.points[i]);
            region.points[region.count++] = scratch.points[i];
        }
        region.center /= static_cast<double>(scratch.points.size());
        regions.push_back(region);
    }
}

}  // namespace kolize
