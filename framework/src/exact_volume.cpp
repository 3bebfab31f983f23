#include "exact_volume.h"

#include "expansion.h"

#include <boost/multiprecision/cpp_int.hpp>

namespace kolize {

namespace {

// With every coordinate zero or from 1/most to most, the product of n coordinates or differences has all its bits, and
// so has a determinant: the last bit of a coordinate is 2^-52 of it or more, and n (log2(most) + 52) < 1074.
constexpr double most_of_three = 0x1p300, most_of_four = 0x1p210;

bool within_limits(const Vec3& p, double most) {
    const auto fine = [&](double x) { return x == 0 || (std::abs(x) >= 1 / most && std::abs(x) <= most); };
    return fine(p[0]) && fine(p[1]) && fine(p[2]);
}

Expansion<192> by_expansions(const Span& u, const Span& v, const Span& w) {
    const auto part = [](const Span& s, int axis) { return difference(s.to[axis], s.from[axis]); };
    const auto term = [&](int i, int j, int k) {
        return (part(v, j) * part(w, k) + -(part(v, k) * part(w, j))) * part(u, i);
    };
    return term(0, 1, 2) + term(1, 2, 0) + term(2, 0, 1);
}

// Wide enough for the determinant of all finite doubles in units of the smallest double, times one more; no allocation.
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    8704, 8704, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked, void>>;
constexpr int unit_exponent = -1074;

Integer in_units(double x) {
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    const Integer digits = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
    const int shift = exponent - 53 - unit_exponent;
    return shift < 0 ? Integer(digits / (Integer(1) << -shift)) : Integer(digits << shift);
}

// The leading bits of a number of `units`.
double to_double(const Integer& magnitude, int exponent_of_unit) {
    const int shift = std::max(0, static_cast<int>(msb(magnitude)) - 52);
    return std::ldexp(static_cast<Integer>(magnitude >> shift).convert_to<double>(), shift + exponent_of_unit);
}

Integer by_integers(const Span& u, const Span& v, const Span& w) {
    const auto part = [](const Span& s, int axis) -> Integer { return in_units(s.to[axis]) - in_units(s.from[axis]); };
    Integer sum = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const Integer minor = part(v, j) * part(w, k) - part(v, k) * part(w, j);
        sum += part(u, i) * minor;
    }
    return sum;
}

// A normal double with the sign of the exact volume.
double rounded(const Integer& cubic_units) {
    if (cubic_units == 0) return 0;
    const double value = std::clamp(to_double(abs(cubic_units), 3 * unit_exponent), std::numeric_limits<double>::min(),
                                    std::numeric_limits<double>::max() / 4);
    return cubic_units > 0 ? value : -value;
}

double quotient(const Integer& dividend, const Integer& divisor) {
    if (dividend == 0) return 0;
    const Integer n = abs(dividend), d = abs(divisor);
    const int shift = std::max(0, 64 + static_cast<int>(msb(d)) - static_cast<int>(msb(n)));
    const double value = to_double(static_cast<Integer>((n << shift) / d), unit_exponent - shift);
    return (dividend > 0) == (divisor > 0) ? value : -value;
}

}  // namespace

double exact_volume(const Span& u, const Span& v, const Span& w) {
    if (u.to == v.to || v.to == w.to || w.to == u.to) {
        const bool from_one_corner = u.from == v.from && v.from == w.from;
        if (from_one_corner) return 0;  // triangles that share a corner or a side: the most frequent doubt
    }
    bool usual = true;
    for (const Span* s : {&u, &v, &w})
        usual = usual && within_limits(s->from, most_of_three) && within_limits(s->to, most_of_three);
    return usual ? by_expansions(u, v, w).value() : rounded(by_integers(u, v, w));
}

// The mean of p and q, weighted by the height of the other one.
Vec3 exact_crossing(const Vec3& p, const Vec3& q, const Vec3 (&t)[3]) {
    const Span u{t[0], t[1]}, v{t[0], t[2]}, to_p{t[0], p}, to_q{t[0], q};
    bool usual = true;
    for (const Vec3* corner : {&p, &q, &t[0], &t[1], &t[2]}) usual = usual && within_limits(*corner, most_of_four);
    Vec3 point;
    if (usual) {
        const Expansion<192> over_p = by_expansions(u, v, to_p), over_q = by_expansions(u, v, to_q);
        const double drop = (over_p + -over_q).value();
        for (int i = 0; i < 3; ++i) point[i] = (scaled(over_p, q[i]) + -scaled(over_q, p[i])).value() / drop;
    } else {
        const Integer over_p = by_integers(u, v, to_p), over_q = by_integers(u, v, to_q), drop = over_p - over_q;
        for (int i = 0; i < 3; ++i)
            point[i] = quotient(static_cast<Integer>(in_units(q[i]) * over_p - in_units(p[i]) * over_q), drop);
    }
    return point;
}

}  // namespace kolize
