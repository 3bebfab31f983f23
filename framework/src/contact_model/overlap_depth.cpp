#include "contact_model/contact_model.h"

#include <algorithm>

namespace kolize {

namespace {

constexpr std::size_t most_vertices = 32;  // of each patch that are tried
constexpr std::size_t most_tests = 10000;  // of a vertex against a triangle: fewer vertices of large patches are tried
constexpr std::size_t most_edges = 96;     // of a patch; more are not crossed with the other patch's

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
        if (segment.parent != region) continue;
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

// The view along the normal: x and y across, z along it.
class View {
public:
    View(const MeshPair& pair, const Vec3& normal) : pair_(pair) {
        const Vec3 x = normal.unitOrthogonal();
        axes_ << x.transpose(), normal.cross(x).transpose(), normal.transpose();
    }
    Vec3 operator()(bool of_a, std::uint32_t vertex) const {
        return axes_ * (of_a ? pair_.a.vertices[vertex] : Vec3(pair_.b_to_a * pair_.b.vertices[vertex]));
    }

private:
    const MeshPair& pair_;
    Mat3 axes_;
};

double cross(const Vec3& u, const Vec3& v) { return u[0] * v[1] - u[1] * v[0]; }

// Height of the triangle at p, if p stands over it in the view.
bool height_at(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, double& height) {
    const double wa = cross(b - p, c - p), wb = cross(c - p, a - p), wc = cross(a - p, b - p), sum = wa + wb + wc;
    const bool inside = (wa >= 0 && wb >= 0 && wc >= 0) || (wa <= 0 && wb <= 0 && wc <= 0);
    if (!inside || sum == 0) return false;
    height = (wa * a[2] + wb * b[2] + wc * c[2]) / sum;
    return true;
}

// Chords that end at a vertex of one patch, up to a triangle of the other.
double vertex_chords(const MeshPair& pair, const View& view, bool of_a, InnerPatch& patch, const InnerPatch& other) {
    const double up = of_a ? 1 : -1;  // A's patch is the upper end of every chord
    auto& vertices = patch.vertices;
    const std::size_t affordable = most_tests / std::max<std::size_t>(1, other.triangles.size());
    const std::size_t tried = std::min(vertices.size(), std::clamp<std::size_t>(affordable, 1, most_vertices));
    if (tried < vertices.size())
        std::nth_element(vertices.begin(), vertices.begin() + tried, vertices.end(),
                         [&](auto u, auto v) { return up * view(of_a, u)[2] > up * view(of_a, v)[2]; });
    const Mesh& mesh = of_a ? pair.b : pair.a;
    double longest = 0;
    for (std::size_t i = 0; i < tried; ++i) {
        const Vec3 p = view(of_a, vertices[i]);
        for (const std::uint32_t t : other.triangles) {
            const auto [a, b, c] = mesh.triangles[t];
            double height = 0;
            if (height_at(p, view(!of_a, a), view(!of_a, b), view(!of_a, c), height))
                longest = std::max(longest, up * (p[2] - height));
        }
    }
    return longest;
}

// Chords between an edge of A and an edge of B that cross in the view.
double edge_chords(const MeshPair& pair, const View& view, const InnerPatch& a, const InnerPatch& b) {
    if (a.edges.size() > most_edges || b.edges.size() > most_edges) return 0;
    double longest = 0;
    for (const std::uint32_t ea : a.edges) {
        const Vec3 p = view(true, pair.a.edges[ea].v0), d = view(true, pair.a.edges[ea].v1) - p;
        for (const std::uint32_t eb : b.edges) {
            const Vec3 q = view(false, pair.b.edges[eb].v0), e = view(false, pair.b.edges[eb].v1) - q;
            const double determinant = cross(d, e);
            if (determinant == 0) continue;
            const double s = cross(q - p, e) / determinant, t = cross(q - p, d) / determinant;
            if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
                longest = std::max(longest, (p[2] + s * d[2]) - (q[2] + t * e[2]));
        }
    }
    return longest;
}

}  // namespace

double overlap_depth(const MeshPair& pair, std::uint32_t region, const Vec3& normal, ContourScratch& scratch) {
    collect(pair, true, region, scratch);
    collect(pair, false, region, scratch);
    const View view(pair, normal);
    const double longest = std::max({vertex_chords(pair, view, true, scratch.patch_a, scratch.patch_b),
                                     vertex_chords(pair, view, false, scratch.patch_b, scratch.patch_a),
                                     edge_chords(pair, view, scratch.patch_a, scratch.patch_b)});
    return std::max(longest, std::numeric_limits<double>::min());  // a touch below rounding is still a touch
}

}  // namespace kolize
