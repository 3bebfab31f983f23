#include "contact_model/contact_model.h"

#include <algorithm>

namespace kolize {

namespace {

// Everything that decides how two triangles cross is the sign of a determinant of an edge and an edge, or a vertex and
// a triangle, always computed from the same operands in the same order. Neighbouring triangle pairs therefore see the
// same signs, and a closed mesh leaves closed curves. One rule for zero everywhere: > 0 against <= 0.
class CrossingTriangles {
public:
    CrossingTriangles(const MeshPair& pair, std::uint32_t triangle_a, std::uint32_t triangle_b)
        : pair_(pair), triangle_a_(triangle_a), triangle_b_(triangle_b) {
        for (int k = 0; k < 3; ++k) {
            a_[k] = pair.a.vertices[pair.a.triangles[triangle_a][k]];
            b_[k] = pair.b_to_a * pair.b.vertices[pair.b.triangles[triangle_b][k]];
        }
        for (int k = 0; k < 3; ++k) {
            height_a_[k] = height(a_[k], b_);
            height_b_[k] = height(b_[k], a_);
            edge_a_[k] = edge_of(pair.a, triangle_a, k);
            edge_b_[k] = edge_of(pair.b, triangle_b, k);
        }
    }

    // The ends of the common segment; false unless there are exactly two.
    bool find(ContourSegment& segment) const {
        Crossing found[6];
        int count = 0;
        for (int k = 0; k < 3; ++k) {
            if (edge_goes_through(k, true)) found[count++] = crossing(k, true);
            if (edge_goes_through(k, false)) found[count++] = crossing(k, false);
        }
        if (count != 2) return false;
        const Vec3 direction = normal(a_).cross(normal(b_));
        const bool forward = direction.dot(found[1].point - found[0].point) >= 0;
        segment.from = found[forward ? 0 : 1];
        segment.to = found[forward ? 1 : 0];
        segment.triangle_a = triangle_a_;
        segment.triangle_b = triangle_b_;
        return true;
    }

private:
    struct OrderedEdge {
        std::uint32_t id = 0;
        int low = 0, high = 0;  // corners of the triangle, lower vertex id first
        bool flipped = false;   // the triangle runs from high to low
    };

    static Vec3 normal(const Vec3 (&t)[3]) { return (t[1] - t[0]).cross(t[2] - t[0]); }
    static double height(const Vec3& p, const Vec3 (&t)[3]) { return normal(t).dot(p - t[0]); }

    static OrderedEdge edge_of(const Mesh& mesh, std::uint32_t triangle, int k) {
        const Triangle& t = mesh.triangles[triangle];
        const int next = (k + 1) % 3;
        const bool flipped = t[k] > t[next];
        return {mesh.triangle_edges[triangle][k], flipped ? next : k, flipped ? k : next, flipped};
    }

    bool passes_left(const OrderedEdge& ea, const OrderedEdge& eb) const {
        const Vec3 &p = a_[ea.low], &q = a_[ea.high], &r = b_[eb.low], &s = b_[eb.high];
        return (q - p).dot((r - p).cross(s - p)) > 0;
    }

    // An edge crosses a triangle when its ends lie on different sides of the plane and it passes all three sides alike.
    bool edge_goes_through(int k, bool of_a) const {
        const OrderedEdge& edge = of_a ? edge_a_[k] : edge_b_[k];
        const double* heights = of_a ? height_a_ : height_b_;
        if ((heights[edge.low] > 0) == (heights[edge.high] > 0)) return false;
        bool left[3];
        for (int j = 0; j < 3; ++j) {
            const OrderedEdge& side = of_a ? edge_b_[j] : edge_a_[j];
            left[j] = (of_a ? passes_left(edge, side) : passes_left(side, edge)) != side.flipped;
        }
        return left[0] == left[1] && left[1] == left[2];
    }

    Crossing crossing(int k, bool of_a) const {
        const OrderedEdge& edge = of_a ? edge_a_[k] : edge_b_[k];
        const Vec3* corners = of_a ? a_ : b_;
        const double low = (of_a ? height_a_ : height_b_)[edge.low], high = (of_a ? height_a_ : height_b_)[edge.high];
        Crossing c;
        c.point = corners[edge.low] + (corners[edge.high] - corners[edge.low]) * (low / (low - high));
        c.edge_of_a = of_a;
        c.edge = edge.id;
        const Triangle& t = of_a ? pair_.a.triangles[triangle_a_] : pair_.b.triangles[triangle_b_];
        c.inner_vertex = t[low > 0 ? edge.high : edge.low];
        const std::uint64_t triangle = of_a ? triangle_b_ : triangle_a_;
        c.key = (std::uint64_t(of_a) << 63) | (std::uint64_t(edge.id) << 31) | triangle;
        return c;
    }

    const MeshPair& pair_;
    std::uint32_t triangle_a_, triangle_b_;
    Vec3 a_[3], b_[3];                  // corners, frame of A
    double height_a_[3], height_b_[3];  // over the plane of the other triangle, scaled by twice its area
    OrderedEdge edge_a_[3], edge_b_[3];
};

std::uint32_t root(std::vector<ContourSegment>& segments, std::uint32_t i) {
    while (segments[i].parent != i) i = segments[i].parent = segments[segments[i].parent].parent;
    return i;
}

// Segments that share a crossing belong together; every region is named by its first segment.
void join_regions(ContourScratch& scratch) {
    auto& segments = scratch.segments;
    scratch.ends.clear();
    for (std::uint32_t i = 0; i < segments.size(); ++i) {
        segments[i].parent = i;
        scratch.ends.emplace_back(segments[i].from.key, i);
        scratch.ends.emplace_back(segments[i].to.key, i);
    }
    std::sort(scratch.ends.begin(), scratch.ends.end());
    for (std::size_t i = 1; i < scratch.ends.size(); ++i)
        if (scratch.ends[i].first == scratch.ends[i - 1].first) {
            const auto [low, high] =
                std::minmax({root(segments, scratch.ends[i].second), root(segments, scratch.ends[i - 1].second)});
            segments[high].parent = low;
        }
    for (std::uint32_t i = 0; i < segments.size(); ++i) segments[i].parent = root(segments, i);
}

// Needs scratch.ends sorted: crossings of one edge stand side by side.
void mark_edges(const MeshPair& pair, ContourScratch& scratch) {
    scratch.pierced_a.reset(pair.a.edges.size());
    scratch.pierced_b.reset(pair.b.edges.size());
    scratch.repeated_a.reset(pair.a.edges.size());
    scratch.repeated_b.reset(pair.b.edges.size());
    std::uint64_t last = ~std::uint64_t(0);  // no crossing has this key
    for (const auto& [key, segment] : scratch.ends) {
        if (key == last) continue;
        last = key;
        const bool of_a = key >> 63;
        const auto edge = static_cast<std::uint32_t>(key >> 31);
        Marks& pierced = of_a ? scratch.pierced_a : scratch.pierced_b;
        if (pierced.test(edge)) (of_a ? scratch.repeated_a : scratch.repeated_b).set(edge);
        pierced.set(edge);
    }
}

struct Curve {
    Vec3 center = Vec3::Zero();  // of the curve, weighted by length
    Vec3 normal = Vec3::Zero();
};

// False if the curve gives no direction at all.
bool measure_curve(const MeshPair& pair, std::span<const ContourSegment> segments, std::uint32_t region, Curve& curve) {
    double length = 0;
    Vec3 rim = Vec3::Zero(), mean = Vec3::Zero();
    std::size_t count = 0;
    for (const ContourSegment& s : segments) {
        if (s.parent != region) continue;
        const double l = (s.to.point - s.from.point).norm();
        length += l;
        curve.center += 0.5 * l * (s.from.point + s.to.point);
        mean += s.from.point;
        ++count;
        rim += l * (pair.a.normals[s.triangle_a] - pair.b_to_a.rotation * pair.b.normals[s.triangle_b]);
    }
    curve.center = length > 0 ? Vec3(curve.center / length) : Vec3(mean / static_cast<double>(count));
    Vec3 area = Vec3::Zero();
    for (const ContourSegment& s : segments)
        if (s.parent == region) area += 0.5 * (s.from.point - curve.center).cross(s.to.point - curve.center);
    // A curve that runs back on itself encloses nothing; the surfaces along it still tell the direction.
    const Vec3& direction = area.norm() > 1e-12 * length * length ? area : rim;
    const double norm = direction.norm();
    if (!(norm > 0)) return false;
    curve.normal = direction / norm;
    return true;
}

ContactRegion make_region(const MeshPair& pair, std::uint32_t region, const Curve& curve, ContourScratch& scratch) {
    ContactRegion result;
    result.normal = curve.normal;
    result.center = curve.center;
    result.depth = overlap_depth(pair, region, curve.normal, scratch);
    scratch.points.clear();
    for (const ContourSegment& s : scratch.segments)
        if (s.parent == region) scratch.points.push_back(s.from.point);
    std::array<std::uint32_t, 4> chosen;
    for (const std::uint32_t i : spread_points(scratch.points, chosen)) {
        result.depths[result.count] = result.depth;
        result.points[result.count++] = scratch.points[i];
    }
    return result;
}

}  // namespace

void ContourScratch::reserve(std::size_t most_vertices, std::size_t most_edges, std::size_t most_triangles) {
    constexpr std::size_t usual =
        512;  // triangle pairs of one mesh pair; more is possible, it only costs an allocation
    segments.reserve(usual);
    ends.reserve(2 * usual);
    points.reserve(2 * usual);
    vertices.reserve(most_vertices);
    triangles.reserve(most_triangles);
    for (Marks* marks : {&edges, &pierced_a, &pierced_b, &repeated_a, &repeated_b}) marks->reserve(most_edges);
    for (InnerPatch* patch : {&patch_a, &patch_b}) {
        patch->triangles.reserve(most_triangles);
        patch->vertices.reserve(most_vertices);
        patch->edges.reserve(most_edges);
    }
}

void contour_regions(const MeshPair& pair, std::span<const TriangleHit> hits, ContourScratch& scratch,
                     std::vector<ContactRegion>& regions) {
    scratch.segments.clear();
    for (const TriangleHit& hit : hits) {
        ContourSegment segment;
        if (CrossingTriangles(pair, hit.a, hit.b).find(segment)) scratch.segments.push_back(segment);
    }
    join_regions(scratch);
    mark_edges(pair, scratch);
    for (std::uint32_t i = 0; i < scratch.segments.size(); ++i) {
        Curve curve;
        if (scratch.segments[i].parent == i && measure_curve(pair, scratch.segments, i, curve))
            regions.push_back(make_region(pair, i, curve, scratch));
    }
}

}  // namespace kolize
