// Triangle-triangle test by orientation predicates, several pairs at a time.
//
// Two triangles can only meet if each has corners on both sides of the other's plane. Then the planes' common line
// passes both, each in an interval that begins and ends on two sides of the triangle. With the corner that is alone on
// its side put first, and the triangles turned so that these corners lie above, the intervals overlap exactly where two
// determinants of four corners have the right sign: no interval is ever computed. Triangles in one plane are projected
// along the axis nearest to their normal; they are apart where a side of one has all of the other beyond it.
//
// Every lane of a vector is a pair of triangles. All go through the same operations in the same order, in registers as
// wide as the processor has them: every processor gives the same answers.
#include <kolize/error.h>
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin.h>

#include <algorithm>
#include <array>
#include <cstring>

// Functions that hand vectors over are always inlined: how such a call would be made does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace {

using namespace kolize;

template <class Real, int lanes>
struct VectorOf {
    using Type [[gnu::vector_size(lanes * sizeof(Real))]] = Real;
};
template <class Real, int lanes>
using Vector = typename VectorOf<Real, lanes>::Type;

template <class V>
using Mask = decltype(V{} > V{});

template <class V>
struct Point {
    V x{}, y{}, z{};
};
template <class V>
[[gnu::always_inline]] inline Point<V> operator-(const Point<V>& a, const Point<V>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
[[gnu::always_inline]] inline Point<V> cross(const Point<V>& a, const Point<V>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V>
[[gnu::always_inline]] inline V dot(const Point<V>& a, const Point<V>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
[[gnu::always_inline]] inline Point<V> select(const Mask<V>& mask, const Point<V>& yes, const Point<V>& no) {
    return {mask ? yes.x : no.x, mask ? yes.y : no.y, mask ? yes.z : no.z};
}

template <class V>
struct Corners {
    Point<V> p, q, r;
};

// Two neighbouring coordinates of as many pairs as there are lanes, side by side.
constexpr std::size_t stride = sizeof(TrianglePair) / sizeof(double);

[[gnu::always_inline]] inline void load_two(const double* first, Vector<double, 2>& one, Vector<double, 2>& other) {
    Vector<double, 2> of_pair[2];
    for (std::size_t i = 0; i < 2; ++i) std::memcpy(&of_pair[i], first + i * stride, sizeof of_pair[i]);
    one = __builtin_shufflevector(of_pair[0], of_pair[1], 0, 2);
    other = __builtin_shufflevector(of_pair[0], of_pair[1], 1, 3);
}

[[gnu::always_inline]] inline void load_two(const double* first, Vector<double, 4>& one, Vector<double, 4>& other) {
    Vector<double, 2> of_pair[4];
    for (std::size_t i = 0; i < 4; ++i) std::memcpy(&of_pair[i], first + i * stride, sizeof of_pair[i]);
    const Vector<double, 4> even = __builtin_shufflevector(of_pair[0], of_pair[2], 0, 1, 2, 3),
                            odd = __builtin_shufflevector(of_pair[1], of_pair[3], 0, 1, 2, 3);
    one = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    other = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
}

template <int lanes>
[[gnu::always_inline]] inline void load(const TrianglePair* pairs, Corners<Vector<double, lanes>>& a,
                                        Corners<Vector<double, lanes>>& b) {
    const double* first = pairs->a[0].data();
    load_two(first, a.p.x, a.p.y);
    load_two(first + 2, a.p.z, a.q.x);
    load_two(first + 4, a.q.y, a.q.z);
    load_two(first + 6, a.r.x, a.r.y);
    load_two(first + 8, a.r.z, b.p.x);
    load_two(first + 10, b.p.y, b.p.z);
    load_two(first + 12, b.q.x, b.q.y);
    load_two(first + 14, b.q.z, b.r.x);
    load_two(first + 16, b.r.y, b.r.z);
}

template <int lanes>
[[gnu::always_inline]] inline void narrow(const Point<Vector<double, lanes / 2>>& p,
                                          const Point<Vector<double, lanes / 2>>& q,
                                          Point<Vector<float, lanes>>& both) {
    using Half = Vector<float, lanes / 2>;
    const Half halves[3][2] = {{__builtin_convertvector(p.x, Half), __builtin_convertvector(q.x, Half)},
                               {__builtin_convertvector(p.y, Half), __builtin_convertvector(q.y, Half)},
                               {__builtin_convertvector(p.z, Half), __builtin_convertvector(q.z, Half)}};
    std::memcpy(&both, halves, sizeof both);
}

// Relative to the first corner: the difference is taken before it is narrowed.
template <int lanes>
[[gnu::always_inline]] inline void load(const TrianglePair* pairs, Corners<Vector<float, lanes>>& a,
                                        Corners<Vector<float, lanes>>& b) {
    constexpr int half = lanes / 2;
    Corners<Vector<double, half>> a0, b0, a1, b1;
    load<half>(pairs, a0, b0);
    load<half>(pairs + half, a1, b1);
    a.p = {};
    narrow<lanes>(a0.q - a0.p, a1.q - a1.p, a.q);
    narrow<lanes>(a0.r - a0.p, a1.r - a1.p, a.r);
    narrow<lanes>(b0.p - a0.p, b1.p - a1.p, b.p);
    narrow<lanes>(b0.q - a0.p, b1.q - a1.p, b.q);
    narrow<lanes>(b0.r - a0.p, b1.r - a1.p, b.r);
}

// On which side of another triangle's plane each corner lies.
template <class V>
struct Sides {
    Mask<V> p_above, q_above, r_above;  // and not in the plane
    Mask<V> p_not_below, q_not_below, r_not_below;
    [[gnu::always_inline]] Sides(const Corners<V>& t, const Corners<V>& plane) {
        const Point<V> normal = cross(plane.q - plane.p, plane.r - plane.p);
        const V p = dot(normal, t.p - plane.p), q = dot(normal, t.q - plane.p), r = dot(normal, t.r - plane.p);
        p_above = p > 0, q_above = q > 0, r_above = r > 0;
        p_not_below = p >= 0, q_not_below = q >= 0, r_not_below = r >= 0;
    }
    [[gnu::always_inline]] Mask<V> none_above() const { return ~(p_above | q_above | r_above); }
    [[gnu::always_inline]] Mask<V> on_one_side() const {
        return (p_above & q_above & r_above) | ~(p_not_below | q_not_below | r_not_below);
    }
    [[gnu::always_inline]] Mask<V> all_in_plane() const {
        return none_above() & p_not_below & q_not_below & r_not_below;
    }
};

// Turns the triangle until the corner that is alone on its side comes first, where corners in the plane count as on
// either side. Tells where that corner lies below.
template <class V>
[[gnu::always_inline]] inline Mask<V> put_lone_corner_first(Corners<V>& t, const Sides<V>& sides) {
    const Mask<V> zero_is_above = sides.none_above();
    const Mask<V> p = sides.p_above | (sides.p_not_below & zero_is_above),
                  q = sides.q_above | (sides.q_not_below & zero_is_above),
                  r = sides.r_above | (sides.r_not_below & zero_is_above);
    const Mask<V> q_first = (q ^ p) & (q ^ r), r_first = (r ^ p) & (r ^ q);
    t = {select(q_first, t.q, select(r_first, t.r, t.p)), select(q_first, t.r, select(r_first, t.p, t.q)),
         select(q_first, t.p, select(r_first, t.q, t.r))};
    return ~(p ^ q ^ r);
}

template <class V>
[[gnu::always_inline]] inline void turn_over(Corners<V>& t, const Mask<V>& where) {
    const Point<V> q = t.q;
    t.q = select(where, t.r, q);
    t.r = select(where, q, t.r);
}

// Six times the volume between a.p, b.p and two more corners: which of the two comes first on the common line.
template <class V>
[[gnu::always_inline]] inline V order(const Corners<V>& a, const Corners<V>& b, const Point<V>& p, const Point<V>& q) {
    return dot(b.p - a.p, cross(p - a.p, q - a.p));
}

// Does each interval begin before the other ends?
template <class V>
[[gnu::always_inline]] inline Mask<V> intervals_overlap(const Corners<V>& a, const Corners<V>& b) {
    return (order(a, b, a.q, b.q) >= 0) & (order(a, b, a.r, b.r) <= 0);
}

// What follows is done for one pair at a time.
template <class Real, class V>
Corners<Real> lane(const Corners<V>& t, int i) {
    return {{t.p.x[i], t.p.y[i], t.p.z[i]}, {t.q.x[i], t.q.y[i], t.q.z[i]}, {t.r.x[i], t.r.y[i], t.r.z[i]}};
}

template <class Real>
bool a_side_separates(const Corners<Real>& a, const Corners<Real>& b, const Point<Real>& view) {
    const Point<Real>* const corners[3] = {&a.p, &a.q, &a.r};
    for (int k = 0; k < 3; ++k) {
        const Point<Real>& p = *corners[k];
        const Point<Real> outward = cross(view, *corners[(k + 1) % 3] - p);
        const Real own = dot(outward, *corners[(k + 2) % 3] - p);
        const Real p_of_b = dot(outward, b.p - p), q_of_b = dot(outward, b.q - p), r_of_b = dot(outward, b.r - p);
        if (std::min({p_of_b, q_of_b, r_of_b}) > std::max(own, Real(0))) return true;
        if (std::max({p_of_b, q_of_b, r_of_b}) < std::min(own, Real(0))) return true;
    }
    return false;
}

template <class Real>
Real size(const Point<Real>& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

template <class Real>
bool overlap_in_one_plane(const Corners<Real>& a, const Corners<Real>& b) {
    const Point<Real> of_a = cross(a.q - a.p, a.r - a.p), of_b = cross(b.q - b.p, b.r - b.p);
    const Point<Real>& normal = size(of_a) > size(of_b) ? of_a : of_b;
    Point<Real> view;
    (size(normal) == std::abs(normal.x) ? view.x : size(normal) == std::abs(normal.y) ? view.y : view.z) = 1;
    return !a_side_separates(a, b, view) && !a_side_separates(b, a, view);
}

// Where a side crosses a plane. Heights that overflow give an end of the side.
template <class Real>
Vec3 cut(const Point<Real>& from, const Point<Real>& to, const Corners<Real>& plane) {
    const Point<Real> normal = cross(plane.q - plane.p, plane.r - plane.p);
    const Real height = dot(normal, from - plane.p), drop = height - dot(normal, to - plane.p);
    const Real share = height / drop, end = share > 0 ? std::min(share, Real(1)) : 0, begin = 1 - end;
    return {begin * from.x + end * to.x, begin * from.y + end * to.y, begin * from.z + end * to.z};
}

// Of two triangles whose intervals overlap: where the later of the two begins, and where the first ends.
template <class Real>
TriangleSegment common_segment(const Corners<Real>& a, const Corners<Real>& b) {
    return {order(a, b, a.r, b.q) > 0 ? cut(a.p, a.r, b) : cut(b.p, b.q, a),
            order(a, b, a.q, b.r) > 0 ? cut(b.p, b.r, a) : cut(a.p, a.q, b)};
}

template <class Real>
void finish(const Corners<Real>& a, const Corners<Real>& b, bool in_one_plane, const TrianglePair& pair,
            std::uint8_t& hit, TriangleSegment* segment) {
    if (in_one_plane) hit = overlap_in_one_plane(a, b);
    if (!hit || !segment) return;
    const Vec3& corner = pair.a[0];
    *segment = in_one_plane ? TriangleSegment{corner, corner} : common_segment(a, b);
    if (std::is_same_v<Real, float> && !in_one_plane) *segment = {corner + segment->p, corner + segment->q};
}

template <class M>
[[gnu::always_inline]] inline bool any(const M& mask) {
    std::uint64_t words[sizeof mask / 8], all = 0;
    std::memcpy(words, &mask, sizeof mask);
    for (const std::uint64_t word : words) all |= word;
    return all != 0;
}

template <class Real, int lanes>
[[gnu::always_inline]] inline void intersect(const TrianglePair* pairs, std::uint8_t* hit, TriangleSegment* segments) {
    using V = Vector<Real, lanes>;
    Corners<V> a, b;
    load<lanes>(pairs, a, b);
    const Sides<V> of_a(a, b), of_b(b, a);
    const Mask<V> below_a = put_lone_corner_first(a, of_a), below_b = put_lone_corner_first(b, of_b);
    turn_over(b, below_a);
    turn_over(a, below_b);
    const Mask<V> found = ~(of_a.on_one_side() | of_b.on_one_side()) & intervals_overlap(a, b);
    const Mask<V> in_one_plane = of_a.all_in_plane() | of_b.all_in_plane();
    for (int i = 0; i < lanes; ++i) hit[i] = found[i] & 1;
    if (segments || any(in_one_plane))
        for (int i = 0; i < lanes; ++i)
            finish(lane<Real>(a, i), lane<Real>(b, i), in_one_plane[i], pairs[i], hit[i],
                   segments ? &segments[i] : nullptr);
}

struct Batch {
    std::span<const TrianglePair> pairs;
    std::span<std::uint8_t> hit;
    std::span<TriangleSegment> segments;  // or empty
};

template <class Real, int lanes>
[[gnu::always_inline]] inline void intersect(const Batch& batch) {
    const std::size_t count = batch.pairs.size(), whole = count - count % lanes;
    const bool want_segments = !batch.segments.empty();
    for (std::size_t i = 0; i < whole; i += lanes)
        intersect<Real, lanes>(&batch.pairs[i], &batch.hit[i], want_segments ? &batch.segments[i] : nullptr);
    if (whole == count) return;
    std::array<TrianglePair, lanes> last;
    std::array<std::uint8_t, lanes> hit;
    std::array<TriangleSegment, lanes> segments;
    last.fill(batch.pairs.back());
    std::copy(batch.pairs.begin() + whole, batch.pairs.end(), last.begin());
    intersect<Real, lanes>(last.data(), hit.data(), want_segments ? segments.data() : nullptr);
    std::copy_n(hit.begin(), count - whole, batch.hit.begin() + whole);
    if (want_segments) std::copy_n(segments.begin(), count - whole, batch.segments.begin() + whole);
}

// The same for each instruction set. AVX-512 brings registers enough for four pairs; wider ones would only wait.
template <class Real>
void by_sse2(const Batch& batch) {
    intersect<Real, 16 / sizeof(Real)>(batch);
}
template <class Real>
[[gnu::target("avx2")]] void by_avx2(const Batch& batch) {
    intersect<Real, 32 / sizeof(Real)>(batch);
}
template <class Real>
[[gnu::target("avx2,avx512f,avx512vl,avx512dq")]] void by_avx512(const Batch& batch) {
    intersect<Real, 32 / sizeof(Real)>(batch);
}

class GuigueDevillers final : public TriangleNarrowphase {
public:
    static void parameters(Parameters<GuigueDevillers>& p) {
        mesh_parameters<GuigueDevillers>(p);
        p.add("precision", &GuigueDevillers::precision_)
            .choices({"double", "float"})
            .doc("Arithmetic of the test; float takes the corners relative to the first one of the pair.");
        p.add("instructions", &GuigueDevillers::instructions_)
            .choices({"best", "sse2", "avx2", "avx512"})
            .doc("What the processor is asked to use, to compare times; the answers are the same.");
    }

    void attach(Host& host) override {
        TriangleNarrowphase::attach(host);
        test_ = precision_ == "float" ? choose<float>() : choose<double>();
    }

private:
    using Test = void (*)(const Batch&);

    template <class Real>
    Test choose() const {
        const bool avx2 = __builtin_cpu_supports("avx2");
        const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                            __builtin_cpu_supports("avx512dq");
        if ((instructions_ == "avx2" && !avx2) || (instructions_ == "avx512" && !avx512))
            throw Error("narrowphase 'guigue_devillers': this processor has no instructions \"" + instructions_ +
                        "\"; \"best\" takes what there is");
        if (instructions_ == "avx512" || (instructions_ == "best" && avx512)) return by_avx512<Real>;
        return instructions_ == "avx2" || (instructions_ == "best" && avx2) ? by_avx2<Real> : by_sse2<Real>;
    }

    void intersect_triangles(std::span<const TrianglePair> pairs, std::span<std::uint8_t> hit,
                             std::span<TriangleSegment> segments) const override {
        test_({pairs, hit, segments});
    }

    std::string precision_ = "double", instructions_ = "best";
    Test test_ = nullptr;
};

}  // namespace

KOLIZE_PLUGIN(GuigueDevillers, .name = "guigue_devillers",
              .summary = "triangle-triangle test by orientation predicates in SIMD, the fastest",
              .source = "Guigue & Devillers, Journal of Graphics Tools 8(1), 2003",
              .cost =
                  "About forty processor cycles a pair with AVX2, hit or not: six heights and two determinants, four "
                  "pairs at a time, or eight in float.",
              .accuracy =
                  "Plain floating point decides: right in general position, wrong for some pairs that share an "
                  "edge or touch, or whose planes nearly coincide; docs/accuracy.md counts them. Triangles "
                  "without area are not told apart reliably.",
              .choose =
                  "For solids that cross in general position, when the triangle test is what takes the time. Take "
                  "exact where a wrong answer matters.",
              .capabilities = {
                  .shape_kinds = all_shape_kinds | bit(ShapeKind::capsule), .time_of_impact = true, .crossings = true})
