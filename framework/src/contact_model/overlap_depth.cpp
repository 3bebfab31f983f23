#include "contact_model/overlap_depth.h"

#include <algorithm>

namespace kolize {

namespace {

constexpr std::size_t most_vertices = 32;  // of each patch that are tried
constexpr std::size_t most_tests = 10000;  // of a column against a triangle: fewer vertices of large patches are tried
constexpr std::size_t most_edges = 96;     // of a patch; more are not crossed with the other patch's
constexpr double steep = 1e-9;             // sine of the angle below which a triangle counts as seen edge-on
constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();  // of heights, relative to the coordinates
constexpr double beside = 1e-9;  // share of a triangle's size by which a column may pass beside it

// Flood from the curve inward, over edges that nothing pierces.
void collect(const MeshPair& pair, bool of_a, std::uint32_t region, ContourScratch& s) {
    const Mesh& mesh = of_a ? pair.a : pair.b;
    const Marks &pierced = of_a ? s.pierced_a : s.pierced_b, &repeated = of_a ? s.repeated_a : s.repeated_b;
    InnerPatch& patch = of_a ? s.patch_a : s.patch_b;
    patch.triangles.clear();
    patch.vertices.clear();
    patch.edges.clear();
    s.vertices.reset(mesh.vertices.size());
    s.triangles.reset(mesh.triangles.size());
    s.edges.reset(mesh.edges.size());
    const auto add = [](Marks& seen, std::vector<std::uint32_t>& list, std::uint32_t id) {
        if (seen.test(id)) return;
        seen.set(id);
        list.push_back(id);
    };
    for (const ContourSegment& segment : s.segments) {
        if (segment.region != region) continue;
        add(s.triangles, patch.triangles, of_a ? segment.triangle_a : segment.triangle_b);
        for (const Crossing* c : {&segment.from, &segment.to})
            // An edge that goes in and out again has no end inside.
            if (c->edge_of_a == of_a && !repeated.test(c->edge)) add(s.vertices, patch.vertices, c->inner_vertex);
    }
    for (std::size_t i = 0; i < patch.triangles.size(); ++i)
        for (const std::uint32_t e : mesh.triangle_edges[patch.triangles[i]]) {
            const Edge& edge = mesh.edges[e];
            add(s.edges, patch.edges, e);
            if (pierced.test(e) || !(s.vertices.test(edge.v0) || s.vertices.test(edge.v1))) continue;
            add(s.vertices, patch.vertices, edge.v0);
            add(s.vertices, patch.vertices, edge.v1);
            add(s.triangles, patch.triangles, edge.t0);
            add(s.triangles, patch.triangles, edge.t1);
        }
}

double cross(const Vec3& u, const Vec3& v) { return u[0] * v[1] - u[1] * v[0]; }

// Height of the triangle at p, if p stands over it in the view.
bool height_at(const Vec3& p, const Vec3 (&t)[3], double& height) {
    const double wa = cross(t[1] - p, t[2] - p), wb = cross(t[2] - p, t[0] - p), wc = cross(t[0] - p, t[1] - p);
    const double sum = wa + wb + wc, slack = beside * std::abs(sum), side = sum < 0 ? -1 : 1;
    if (sum == 0 || side * wa < -slack || side * wb < -slack || side * wc < -slack) return false;
    height = (wa * t[0][2] + wb * t[1][2] + wc * t[2][2]) / sum;
    return true;
}

}  // namespace

OverlapDepth::OverlapDepth(const MeshPair& pair, std::uint32_t region, const Vec3& normal, ContourScratch& scratch)
    : pair_(pair), region_(region), scratch_(scratch) {
    const Vec3 x = normal.unitOrthogonal();
    axes_ << x.transpose(), normal.cross(x).transpose(), normal.transpose();
    collect(pair, true, region, scratch);
    collect(pair, false, region, scratch);
    scratch.view.clear();
    add_view(true);
    add_view(false);
}

Vec3 OverlapDepth::viewed(bool of_a, std::uint32_t vertex) const {
    return axes_ * (of_a ? pair_.a.vertices[vertex] : Vec3(pair_.b_to_a * pair_.b.vertices[vertex]));
}

void OverlapDepth::add_view(bool of_a) {
    const Mesh& mesh = of_a ? pair_.a : pair_.b;
    for (const std::uint32_t t : (of_a ? scratch_.patch_a : scratch_.patch_b).triangles) {
        const Vec3 normal = of_a ? mesh.normals[t] : Vec3(pair_.b_to_a.rotation * mesh.normals[t]);
        const double up = axes_.row(2).dot(normal);
        if (std::abs(up) < steep) continue;
        ViewedTriangle& viewed_triangle = scratch_.view.emplace_back();
        for (int k = 0; k < 3; ++k) {
            viewed_triangle.corners[k] = viewed(of_a, mesh.triangles[t][k]);
            tolerance_ = std::max(tolerance_, rounding * viewed_triangle.corners[k].cwiseAbs().maxCoeff());
        }
        viewed_triangle.of_a = of_a;
        viewed_triangle.leaves = up > 0;
    }
}

// The body's surface nearest above (up = 1) or below (up = -1) a point. A surface through the point itself counts if
// the way leads out there, and not if it leads in.
OverlapDepth::Hit OverlapDepth::first_hit(const Vec3& from, int up, bool of_a) const {
    Hit first;
    double height = 0;
    for (const ViewedTriangle& t : scratch_.view) {
        if (t.of_a != of_a || !height_at(from, t.corners, height)) continue;
        const double gap = up * (height - from[2]);
        const bool exits = t.leaves == (up > 0);
        if (std::abs(gap) <= tolerance_ && exits) return {0, true};
        if (gap > tolerance_ && gap < first.gap) first = {gap, exits};
    }
    return first;
}

double OverlapDepth::vertex_depth(bool of_a, const Vec3& p) const {
    const Hit hit = first_hit(p, of_a ? -1 : 1, !of_a);
    return hit.exits && hit.gap < infinity ? hit.gap : 0;
}

// Through a point of both surfaces: the way is in the overlap up to where either body is left.
OverlapDepth::Chord OverlapDepth::chord_at(const Vec3& p) const {
    Chord best;
    for (const int up : {1, -1}) {
        const Hit a = first_hit(p, up, true), b = first_hit(p, up, false);
        const double length = std::min(a.gap, b.gap);
        if (a.exits && b.exits && length < infinity && length > best.length) best = chord(p, length, up);
    }
    return best;
}

// Between two points of edges, one over the other: unless other parts of the bodies come between.
double OverlapDepth::edge_depth(const Vec3& on_a, const Vec3& on_b) const {
    if (!first_hit(on_a, 1, false).exits || !first_hit(on_b, -1, true).exits) return 0;
    return std::min(vertex_depth(true, on_a), vertex_depth(false, on_b));
}

OverlapDepth::Chord OverlapDepth::chord(const Vec3& end, double length, int up) const {
    return {length, axes_.transpose() * (end + Vec3(0, 0, 0.5 * up * length))};
}

double OverlapDepth::at(const Crossing& crossing) const {
    const Vec3 p = axes_ * crossing.point, v = viewed(crossing.edge_of_a, crossing.inner_vertex);
    const double on_curve = chord_at(p).length;
    const bool is_upright = (v - p).head<2>().norm() <= std::abs(v[2] - p[2]);
    const double of_vertex = is_upright ? vertex_depth(crossing.edge_of_a, v) : 0;
    return of_vertex > 0 ? of_vertex : on_curve;
}

OverlapDepth::Chord OverlapDepth::longest() {
    Chord best;
    try_vertices(true, best);
    try_vertices(false, best);
    try_curve(best);
    try_edges(best);
    return best;
}

void OverlapDepth::try_vertices(bool of_a, Chord& best) {
    const int up = of_a ? 1 : -1;  // A is below: its vertices are upper ends
    auto& vertices = (of_a ? scratch_.patch_a : scratch_.patch_b).vertices;
    const std::size_t affordable = most_tests / std::max<std::size_t>(1, scratch_.view.size());
    const std::size_t tried = std::min(vertices.size(), std::clamp<std::size_t>(affordable, 1, most_vertices));
    if (tried < vertices.size())
        std::nth_element(vertices.begin(), vertices.begin() + tried, vertices.end(),
                         [&](auto u, auto v) { return up * viewed(of_a, u)[2] > up * viewed(of_a, v)[2]; });
    for (std::size_t i = 0; i < tried; ++i) {
        const Vec3 p = viewed(of_a, vertices[i]);
        if (const double depth = vertex_depth(of_a, p); depth > best.length) best = chord(p, depth, -up);
    }
}

void OverlapDepth::try_curve(Chord& best) const {
    std::size_t left = most_tests / std::max<std::size_t>(1, scratch_.view.size());
    for (const ContourSegment& segment : scratch_.segments) {
        if (segment.region != region_) continue;
        if (left-- == 0) return;
        if (const Chord chord = chord_at(axes_ * segment.from.point); chord.length > best.length) best = chord;
    }
}

// Only what would be a record is looked at closely.
void OverlapDepth::try_edges(Chord& best) const {
    const auto &a = scratch_.patch_a.edges, &b = scratch_.patch_b.edges;
    if (a.size() > most_edges || b.size() > most_edges) return;
    for (const std::uint32_t ea : a) {
        const Vec3 p = viewed(true, pair_.a.edges[ea].v0), d = viewed(true, pair_.a.edges[ea].v1) - p;
        for (const std::uint32_t eb : b) {
            const Vec3 q = viewed(false, pair_.b.edges[eb].v0), e = viewed(false, pair_.b.edges[eb].v1) - q;
            const double determinant = cross(d, e);
            if (determinant == 0) continue;
            const double s = cross(q - p, e) / determinant, t = cross(q - p, d) / determinant;
            if (s < 0 || s > 1 || t < 0 || t > 1) continue;
            const Vec3 on_a = p + s * d, on_b = q + t * e;
            if (on_a[2] - on_b[2] <= best.length) continue;
            if (const double depth = edge_depth(on_a, on_b); depth > best.length) best = chord(on_a, depth, -1);
        }
    }
}

}  // namespace kolize
