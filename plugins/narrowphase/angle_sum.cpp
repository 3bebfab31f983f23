// Triangle-triangle test by angle sums, as the source thesis did it.
//
// Every edge of one triangle is cut with the plane of the other. The cut lies inside that triangle if the three angles
// under which it sees the sides add up to a full turn, within epsilon. Then the triangles change roles. All points are
// relative to the first corner of the pair: the difference is taken before it is narrowed to float.
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin.h>

#include <algorithm>
#include <numbers>

namespace {

using namespace kolize;

template <class Real>
using Point = Eigen::Matrix<Real, 3, 1>;

// A corner counts as inside: the angle at it is not defined.
template <class Real>
bool inside(const Point<Real>& p, const Point<Real> (&t)[3], Real epsilon) {
    Point<Real> direction[3];
    for (int k = 0; k < 3; ++k) {
        const Point<Real> v = t[k] - p;
        const Real length = v.norm();
        if (length == 0) return true;
        direction[k] = v / length;
    }
    Real sum = 0;
    for (int k = 0; k < 3; ++k)
        sum += std::acos(std::clamp(direction[k].dot(direction[(k + 1) % 3]), Real(-1), Real(1)));
    return std::abs(sum - 2 * std::numbers::pi_v<Real>) <= epsilon;
}

// The points found so far: the first two different ones make the segment.
template <class Real>
struct Cuts {
    int count = 0;
    Point<Real> points[2];
    void add(const Point<Real>& p) {
        if (count == 0 || (count == 1 && p != points[0])) points[count++] = p;
    }
};

template <class Real>
void cut_edges(const Point<Real> (&edges)[3], const Point<Real> (&face)[3], Real epsilon, Cuts<Real>& cuts) {
    const Point<Real> normal = (face[1] - face[0]).cross(face[2] - face[0]);
    for (int k = 0; k < 3; ++k) {
        const Point<Real>&p = edges[k], &q = edges[(k + 1) % 3];
        const Real hp = normal.dot(p - face[0]), hq = normal.dot(q - face[0]);
        if ((hp > 0 && hq > 0) || (hp < 0 && hq < 0) || hp == hq) continue;
        const Point<Real> cut = p + (q - p) * (hp / (hp - hq));
        if (inside(cut, face, epsilon)) cuts.add(cut);
    }
}

template <class Real>
bool intersect(const TrianglePair& pair, double epsilon, TriangleSegment* segment) {
    const Vec3& origin = pair.a[0];
    Point<Real> a[3], b[3];
    for (int k = 0; k < 3; ++k) {
        a[k] = (pair.a[k] - origin).template cast<Real>();
        b[k] = (pair.b[k] - origin).template cast<Real>();
    }
    Cuts<Real> cuts;
    cut_edges(a, b, Real(epsilon), cuts);
    if (cuts.count == 0 || segment) cut_edges(b, a, Real(epsilon), cuts);
    if (segment && cuts.count)
        *segment = {origin + cuts.points[0].template cast<double>(),
                    origin + cuts.points[cuts.count - 1].template cast<double>()};
    return cuts.count > 0;
}

class AngleSum final : public TriangleNarrowphase {
public:
    static void parameters(Parameters<AngleSum>& p) {
        mesh_parameters<AngleSum>(p);
        p.add("epsilon", &AngleSum::epsilon_)
            .unit("rad")
            .range(0, 1)
            .doc("How far the angles may be from a full turn.");
        p.add("precision", &AngleSum::precision_).choices({"float", "double"}).doc("Arithmetic of the test.");
    }

    void attach(Host& host) override {
        TriangleNarrowphase::attach(host);
        in_float_ = precision_ == "float";
    }

private:
    void intersect_triangles(std::span<const TrianglePair> pairs, std::span<std::uint8_t> hit,
                             std::span<TriangleSegment> segments) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            TriangleSegment* segment = segments.empty() ? nullptr : &segments[i];
            hit[i] = in_float_ ? intersect<float>(pairs[i], epsilon_, segment)
                               : intersect<double>(pairs[i], epsilon_, segment);
        }
    }

    double epsilon_ = 1e-3;
    std::string precision_ = "double";
    bool in_float_ = false;
};

}  // namespace

KOLIZE_PLUGIN(AngleSum, .name = "angle_sum", .summary = "triangle-triangle test by angle sums, the source thesis' own",
              .source = "Haines, Point in polygon strategies, Graphics Gems IV, 1994",
              .cost = "Up to six cuts with three square roots and three arc cosines each.",
              .accuracy =
                  "The arc cosine loses half the digits near a full turn, so epsilon fattens the triangle by an "
                  "amount that depends on its shape; coplanar triangles are never found. Float, as in the "
                  "thesis, errs more often than double (docs/accuracy.md).",
              .choose = "To see what the thesis' pipeline gives, as a baseline; not for new work.",
              .capabilities = {
                  .shape_kinds = all_shape_kinds | bit(ShapeKind::capsule), .time_of_impact = true, .crossings = true})
