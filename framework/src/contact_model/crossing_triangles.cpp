#include "contact_model/crossing_triangles.h"

namespace kolize {

namespace {

// Crossing points rest on heights that must be right to about ten digits, or a nearly parallel face would be met
// anywhere on its plane.
constexpr double for_points = 1e10;

}  // namespace

Nudge::Nudge(const Vec3& towards_b) {
    int longest = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(towards_b[k]) > std::abs(towards_b[longest])) longest = k;
    const double side = towards_b[longest] < 0 ? -1 : 1;
    steps_[0] = towards_b[longest] != 0 ? towards_b : Vec3::Unit(longest);
    steps_[1] = side * Vec3::Unit((longest + 1) % 3);
    steps_[2] = side * Vec3::Unit((longest + 2) % 3);
}

Nudge Nudge::to_other_side() const {
    Nudge other = *this;
    for (const int k : {1, 2}) other.steps_[k] = -steps_[k];
    return other;
}

int Nudge::sign_of(const Span& u, const Span& v) {
    const Vec3 start = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
        if (const int s = sign(volume({start, steps_[k]}, u, v))) {
            went_sideways_ = went_sideways_ || k > 0;
            return s;
        }
    return 0;
}

namespace {

// A corner over the plane of the other triangle.
struct Height {
    double value = 0;    // m^3: scaled by twice the area
    bool above = false;  // after the nudge
};

class CrossingTriangles {
public:
    CrossingTriangles(const MeshPair& pair, Nudge& nudge, std::uint32_t triangle_a, std::uint32_t triangle_b)
        : pair_(pair), nudge_(nudge), triangle_a_(triangle_a), triangle_b_(triangle_b) {
        for (int k = 0; k < 3; ++k) {
            a_[k] = pair.a.vertices[pair.a.triangles[triangle_a][k]];
            b_[k] = pair.b_to_a * pair.b.vertices[pair.b.triangles[triangle_b][k]];
        }
    }

    std::optional<ContourSegment> find() {
        for (int k = 0; k < 3; ++k) height_a_[k] = height(a_[k], b_, 1);
        if (all_alike(height_a_)) return std::nullopt;
        for (int k = 0; k < 3; ++k) height_b_[k] = height(b_[k], a_, -1);
        if (all_alike(height_b_)) return std::nullopt;
        for (int k = 0; k < 3; ++k) {
            edge_a_[k] = edge_of(pair_.a, triangle_a_, k);
            edge_b_[k] = edge_of(pair_.b, triangle_b_, k);
        }
        ContourSegment segment;
        segment.triangle_a = triangle_a_;
        segment.triangle_b = triangle_b_;
        int count = 0;
        for (int k = 0; k < 3; ++k)
            for (const bool of_a : {true, false})
                if (goes_through(k, of_a)) {
                    (starts_segment(k, of_a) ? segment.from : segment.to) = crossing(k, of_a);
                    ++count;
                }
        return count == 2 ? std::optional(segment) : std::nullopt;
    }

private:
    struct OrderedEdge {
        std::uint32_t id = 0;
        int low = 0, high = 0;  // corners of the triangle, lower vertex id first
        bool flipped = false;   // the triangle runs from high to low
    };

    // `moves` is 1 if the nudge moves the point, -1 if it moves the plane.
    Height height(const Vec3& p, const Vec3 (&plane)[3], int moves) const {
        const Span u{plane[0], plane[1]}, v{plane[0], plane[2]};
        const double value = volume({plane[0], p}, u, v, for_points);
        return {value, value > 0 || (value == 0 && moves * nudge_.sign_of(u, v) > 0)};
    }

    static bool all_alike(const Height (&h)[3]) { return h[0].above == h[1].above && h[1].above == h[2].above; }

    static OrderedEdge edge_of(const Mesh& mesh, std::uint32_t triangle, int k) {
        const Triangle& t = mesh.triangles[triangle];
        const int next = (k + 1) % 3;
        const bool flipped = t[k] > t[next];
        return {mesh.triangle_edges[triangle][k], flipped ? next : k, flipped ? k : next, flipped};
    }

    // On which side edge j of B passes edge i of A. Parallel edges have no answer, and no use for one: the plane of a
    // triangle is not crossed by a parallel of its side.
    bool passes_left(int i, int j) {
        std::int8_t& known = left_[i][j];
        if (known == 0) {
            const OrderedEdge &ea = edge_a_[i], &eb = edge_b_[j];
            const Vec3 &p = a_[ea.low], &q = a_[ea.high], &r = b_[eb.low], &s = b_[eb.high];
            const int side = sign(volume({p, q}, {p, r}, {p, s}));
            known = side > 0 || (side == 0 && nudge_.sign_of({p, q}, {r, s}) > 0) ? 1 : -1;
        }
        return known > 0;
    }

    // An edge crosses a triangle when its ends lie on different sides of the plane and it passes all three sides alike.
    bool goes_through(int k, bool of_a) {
        const Height* heights = of_a ? height_a_ : height_b_;
        if (heights[k].above == heights[(k + 1) % 3].above) return false;
        bool left[3];
        for (int j = 0; j < 3; ++j)
            left[j] = (of_a ? passes_left(k, j) : passes_left(j, k)) != (of_a ? edge_b_[j] : edge_a_[j]).flipped;
        return left[0] == left[1] && left[1] == left[2];
    }

    // Run through counter-clockwise, a side of A that goes into B is where the segment ends: the part of A's triangle
    // that is inside lies on the segment's left. On B's triangle it lies on the right.
    bool starts_segment(int k, bool of_a) const {
        const bool goes_in = (of_a ? height_a_ : height_b_)[k].above;
        return goes_in != of_a;
    }

    Crossing crossing(int k, bool of_a) const {
        const OrderedEdge& edge = of_a ? edge_a_[k] : edge_b_[k];
        const Vec3* corners = of_a ? a_ : b_;
        const Height &low = (of_a ? height_a_ : height_b_)[edge.low], &high = (of_a ? height_a_ : height_b_)[edge.high];
        Crossing c;
        c.part = low.value / (low.value - high.value);
        c.point = corners[edge.low] + (corners[edge.high] - corners[edge.low]) * c.part;
        c.edge_of_a = of_a;
        c.edge = edge.id;
        c.goes_in = low.above;
        const Triangle& t = of_a ? pair_.a.triangles[triangle_a_] : pair_.b.triangles[triangle_b_];
        c.inner_vertex = t[low.above ? edge.high : edge.low];
        const std::uint64_t triangle = of_a ? triangle_b_ : triangle_a_;
        c.key = (std::uint64_t(of_a) << 63) | (std::uint64_t(edge.id) << 31) | triangle;
        return c;
    }

    const MeshPair& pair_;
    Nudge& nudge_;
    std::uint32_t triangle_a_, triangle_b_;
    Vec3 a_[3], b_[3];  // corners, frame of A
    Height height_a_[3], height_b_[3];
    OrderedEdge edge_a_[3], edge_b_[3];
    std::int8_t left_[3][3] = {};  // 0: not asked yet
};

}  // namespace

std::optional<ContourSegment> cross(const MeshPair& pair, Nudge& nudge, std::uint32_t triangle_a,
                                    std::uint32_t triangle_b) {
    return CrossingTriangles(pair, nudge, triangle_a, triangle_b).find();
}

}  // namespace kolize
