#include "capsule_contacts.h"

#include <algorithm>

namespace kolize {

namespace {

constexpr double flat = 0.1;          // sine: a core that is tilted by less lies on a face, and both its ends count
constexpr double same_normal = 1e-6;  // points with normals that are no farther apart belong to one region

struct Nearest {
    double s = 0, t = 0;  // along the segments, 0..1
};

// Ericson, Real-Time Collision Detection, 5.1.9; neither segment may be a point.
Nearest nearest_on_segments(const Segment& p, const Segment& q) {
    const Vec3 d = p.to - p.from, e = q.to - q.from, r = p.from - q.from;
    const double dd = d.squaredNorm(), ee = e.squaredNorm(), de = d.dot(e), dr = d.dot(r), er = e.dot(r);
    const double determinant = dd * ee - de * de;
    double s = determinant > 1e-14 * dd * ee ? std::clamp((de * er - dr * ee) / determinant, 0.0, 1.0) : 0;
    double t = (de * s + er) / ee;
    if (t < 0) s = std::clamp(-dr / dd, 0.0, 1.0);
    if (t > 1) s = std::clamp((de - dr) / dd, 0.0, 1.0);
    return {s, std::clamp(t, 0.0, 1.0)};
}

double nearest_on_segment(const Segment& core, const Vec3& p) {
    const Vec3 d = core.to - core.from;
    return std::clamp(d.dot(p - core.from) / d.squaredNorm(), 0.0, 1.0);
}

ContactRegion region_at(const Vec3& normal) {
    ContactRegion region;
    region.normal = normal;
    return region;
}

void add_point(ContactRegion& region, const Vec3& point, double depth) {
    region.points[region.count] = point;
    region.depths[region.count++] = depth;
    region.depth = std::max(region.depth, depth);
    region.center += (point - region.center) / region.count;
}

}  // namespace

Segment capsule_core(const Shape& shape, const Vec3& position, const Quat& orientation) {
    const Vec3 half = orientation * Vec3(0, shape.half_height, 0);
    return {position - half, position + half};
}

void sphere_capsule(double radius_a, const Segment& core_b, double radius_b, Regions& regions) {
    sphere_sphere(radius_a, radius_b, core_b.at(nearest_on_segment(core_b, Vec3::Zero())), regions);
}

void capsule_half_space(const Segment& core_a, double radius_a, const Vec3& normal_b, double offset_b,
                        Regions& regions) {
    ContactRegion region = region_at(-normal_b);
    for (const Vec3& end : {core_a.from, core_a.to})
        if (const double depth = radius_a - (normal_b.dot(end) - offset_b); depth > 0)
            add_point(region, end + (0.5 * depth - radius_a) * normal_b, depth);
    if (region.count > 0) regions.push_back(region);
}

void capsule_capsule(const Segment& core_a, double radius_a, const Segment& core_b, double radius_b, Regions& regions) {
    const Vec3 a = core_a.to - core_a.from, b = core_b.to - core_b.from;
    const Nearest nearest = nearest_on_segments(core_a, core_b);
    const Vec3 between = core_b.at(nearest.t) - core_a.at(nearest.s), across = a.cross(b);
    const double distance = between.norm(), radii = radius_a + radius_b, sine = across.norm() / (a.norm() * b.norm());
    if (!(distance < radii)) return;
    // Cores that cross say nothing of a direction but the one across both.
    const bool lost = distance < 1e-12 * radii;
    const Vec3 normal = !lost ? Vec3(between / distance) : sine > 1e-9 ? across.normalized() : a.unitOrthogonal();
    ContactRegion region = region_at(normal);
    const auto add = [&](const Vec3& on_a, const Vec3& on_b) {
        const double depth = radii - normal.dot(on_b - on_a);
        if (depth > 0) add_point(region, on_a + (radius_a - 0.5 * depth) * normal, depth);
    };
    // The stretch of A beside which B runs.
    double first = nearest_on_segment(core_a, core_b.from), last = nearest_on_segment(core_a, core_b.to);
    if (first > last) std::swap(first, last);
    if (sine < flat && last - first > 1e-9 && std::abs(normal.dot(a)) <= flat * a.norm()) {
        for (const double s : {first, last}) {
            const Vec3 on_a = core_a.at(s);
            add(on_a, core_b.at(nearest_on_segment(core_b, on_a)));
        }
    }
    if (region.depth < radii - distance) {  // neither end is the nearest point
        if (region.count == 2 && region.depths[0] < region.depths[1]) std::swap(region.points[0], region.points[1]);
        add(core_a.at(nearest.s), core_b.at(nearest.t));
    }
    regions.push_back(region);
}

namespace {

// Everything stands in the frame of the mesh.
class CoreOnMesh {
public:
    CoreOnMesh(const Mesh& mesh, const Segment& core, double radius, MeshScratch& scratch, Regions& regions)
        : mesh_(mesh), core_(core), radius_(radius), scratch_(scratch), regions_(regions), first_(regions.size()) {
        along_ = (core.to - core.from).normalized();
    }

    void run() {
        collect();
        if (lead_out()) return;
        add_end(core_.from, along_);
        add_end(core_.to, -along_);
        for (const std::uint32_t edge : scratch_.edges) add_edge(mesh_.edges[edge]);
        for (const std::uint32_t vertex : scratch_.vertices) add_vertex(vertex);
    }

private:
    // Triangles, edges and vertices whose boxes come within the radius of the core's.
    void collect() {
        scratch_.triangles.clear();
        scratch_.edges.clear();
        scratch_.vertices.clear();
        const Aabb box{core_.from.cwiseMin(core_.to), core_.from.cwiseMax(core_.to)};
        const Vec3 center = box.center(), half = box.half_extents() + Vec3::Constant(radius_);
        std::array<std::uint32_t, 64> stack;
        std::size_t depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const HierarchyNode& node = mesh_.hierarchy.nodes[stack[--depth]];
            const Vec3 gap = (node.center.cast<double>() - center).cwiseAbs() - node.half.cast<double>() - half;
            if (gap.maxCoeff() > 0) continue;
            if (!node.is_leaf()) {
                stack[depth++] = node.first;
                stack[depth++] = node.first + 1;
                continue;
            }
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                scratch_.triangles.push_back(mesh_.hierarchy.order[i]);
        }
        std::sort(scratch_.triangles.begin(), scratch_.triangles.end());
        for (const std::uint32_t triangle : scratch_.triangles)
            for (int k = 0; k < 3; ++k) {
                scratch_.edges.push_back(mesh_.triangle_edges[triangle][k]);
                scratch_.vertices.push_back(mesh_.triangles[triangle][k]);
            }
        for (auto* list : {&scratch_.edges, &scratch_.vertices}) {
            std::sort(list->begin(), list->end());
            list->erase(std::unique(list->begin(), list->end()), list->end());
        }
    }

    // The two ends if they are inside, or else the middle of each stretch of the core that is.
    bool lead_out() {
        bool any = false;
        for (const Vec3& end : {core_.from, core_.to}) any |= lead_out_from(end);
        if (any) return true;
        auto& crossings = scratch_.crossings;
        crossings.clear();
        for (const std::uint32_t triangle : scratch_.triangles)
            if (const double s = crossing(triangle); s >= 0) crossings.push_back(s);
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t i = 0; i + 1 < crossings.size(); ++i)
            any |= lead_out_from(core_.at(0.5 * (crossings[i] + crossings[i + 1])));
        return any;
    }

    bool lead_out_from(const Vec3& p) {
        const NearestPoint nearest = nearest_on_mesh(mesh_, p, scratch_);
        if (nearest.height > 0) return false;
        const double below = -nearest.height;
        add(below > 0 ? Vec3((nearest.at.point - p) / below) : nearest.outward, nearest.at.point, radius_ + below);
        return true;
    }

    // Where the core goes through the triangle, 0..1, or -1.
    double crossing(std::uint32_t triangle) const {
        const Triangle& t = mesh_.triangles[triangle];
        const Vec3& n = mesh_.normals[triangle];
        const double from = n.dot(core_.from - mesh_.vertices[t[0]]), to = n.dot(core_.to - mesh_.vertices[t[0]]);
        if ((from > 0) == (to > 0)) return -1;
        const double s = from / (from - to);
        const Vec3 p = core_.at(s);
        for (int k = 0; k < 3; ++k) {
            const Vec3 &u = mesh_.vertices[t[k]], &v = mesh_.vertices[t[(k + 1) % 3]];
            if (n.dot((v - u).cross(p - u)) < 0) return -1;
        }
        return s;
    }

    // A ball at the end, as far as the rest of the core is no nearer.
    void add_end(const Vec3& end, const Vec3& inward) {
        Regions& found = scratch_.regions;
        found.clear();
        mesh_sphere(mesh_, end, radius_, scratch_, found);
        for (const ContactRegion& region : found) {
            const double slope = region.normal.dot(inward);
            const bool on_face = is_face_normal(region.normal);
            if (slope >= (on_face ? -flat : -1e-9)) add(region.normal, region.center, region.depth);
        }
    }

    bool is_face_normal(const Vec3& normal) const {
        return std::any_of(scratch_.triangles.begin(), scratch_.triangles.end(), [&](std::uint32_t triangle) {
            return (mesh_.normals[triangle] - normal).squaredNorm() < same_normal * same_normal;
        });
    }

    // The inner part of the core over the inner part of a convex edge.
    void add_edge(const Edge& edge) {
        const Vec3 &v0 = mesh_.vertices[edge.v0], &v1 = mesh_.vertices[edge.v1];
        const Vec3 &n0 = mesh_.normals[edge.t0], &n1 = mesh_.normals[edge.t1];
        const Vec3 e = (v1 - v0).normalized();
        const Vec3 into0 = n0.cross(e), into1 = -n1.cross(e);
        if (!(into1.dot(n0) < -same_normal)) return;       // flat or hollow
        if (e.cross(along_).norm() < same_normal) return;  // its corners stand for it
        const Nearest at = nearest_on_segments(core_, {v0, v1});
        if (!(at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1)) return;
        const Vec3 on_edge = v0 + at.t * (v1 - v0), out = core_.at(at.s) - on_edge;
        const double distance = out.norm();
        if (!(distance < radius_)) return;
        const Vec3 normal = distance > 1e-12 * radius_ ? Vec3(out / distance) : (n0 + n1).normalized();
        const double lean = std::max(normal.dot(into0), normal.dot(into1)), depth = radius_ - distance;
        if (!(lean <= flat && normal.dot(n0 + n1) > 0)) return;
        // Where it leans over a face, what lies below the edge is outside.
        add(normal, lean > 0 ? on_edge : Vec3(on_edge - 0.5 * depth * normal), depth);
    }

    void add_vertex(std::uint32_t vertex) {
        const Vec3& corner = mesh_.vertices[vertex];
        const double s = nearest_on_segment(core_, corner);
        const Vec3 out = core_.at(s) - corner;
        const double distance = out.norm();
        if (!(s > 0 && s < 1 && distance < radius_ && distance > 1e-12 * radius_)) return;
        const Vec3 normal = out / distance;
        for (const std::uint32_t id : scratch_.edges) {
            const Edge& edge = mesh_.edges[id];
            if (edge.v0 != vertex && edge.v1 != vertex) continue;
            const Vec3 away = mesh_.vertices[edge.v0 == vertex ? edge.v1 : edge.v0] - corner;
            if (normal.dot(away) > 1e-9 * away.norm()) return;
        }
        add(normal, corner - 0.5 * (radius_ - distance) * normal, radius_ - distance);
    }

    // To the region with that normal, or as a new one.
    void add(const Vec3& normal, const Vec3& point, double depth) {
        for (std::size_t i = first_; i < regions_.size(); ++i) {
            ContactRegion& region = regions_[i];
            if ((region.normal - normal).squaredNorm() > same_normal * same_normal) continue;
            for (int k = 0; k < region.count; ++k)
                if ((region.points[k] - point).norm() < same_normal * radius_) return;
            if (region.count < 4) add_point(region, point, depth);
            return;
        }
        ContactRegion region = region_at(normal);
        add_point(region, point, depth);
        regions_.push_back(region);
    }

    const Mesh& mesh_;
    Segment core_;
    double radius_;
    Vec3 along_ = Vec3::Zero();
    MeshScratch& scratch_;
    Regions& regions_;
    std::size_t first_;
};

}  // namespace

void mesh_capsule(const Mesh& mesh, const Segment& core, double radius, MeshScratch& scratch, Regions& regions) {
    if (!mesh.hierarchy.nodes.empty()) CoreOnMesh(mesh, core, radius, scratch, regions).run();
}

}  // namespace kolize
