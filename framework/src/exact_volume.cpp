#include "exact_volume.h"

#include "expansion.h"

#include <boost/multiprecision/cpp_int.hpp>

namespace kolize {

namespace {

// With every coordinate zero or within these limits the product of three differences has all its bits, and so has the
// determinant: the last bit of a coordinate is 2^-52 of it or more, and 3 (300 + 52) < 1074.
constexpr double least = 0x1p-300, most = 0x1p300;

bool within_limits(const Vec3& p) {
    const auto fine = [](double x) { return x == 0 || (std::abs(x) >= least && std::abs(x) <= most); };
    return fine(p[0]) && fine(p[1]) && fine(p[2]);
}

double by_expansions(const Span& u, const Span& v, const Span& w) {
    const auto part = [](const Span& s, int axis) { return difference(s.to[axis], s.from[axis]); };
    const auto term = [&](int i, int j, int k) {
        return (part(v, j) * part(w, k) + -(part(v, k) * part(w, j))) * part(u, i);
    };
    return (term(0, 1, 2) + term(1, 2, 0) + term(2, 0, 1)).value();
}

// Wide enough for the determinant of all finite doubles in units of the smallest double; no allocation.
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    8192, 8192, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked, void>>;
constexpr int unit_exponent = -1074;

Integer in_units(double x) {
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    const Integer digits = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
    const int shift = exponent - 53 - unit_exponent;
    return shift < 0 ? Integer(digits / (Integer(1) << -shift)) : Integer(digits << shift);
}

double to_double(const Integer& cubic_units) {
    if (cubic_units == 0) return 0;
    const Integer magnitude = abs(cubic_units);
    const int bits = static_cast<int>(msb(magnitude)) + 1, shift = std::max(0, bits - 53);
    const double leading = static_cast<Integer>(magnitude >> shift).convert_to<double>();
    const double value = std::ldexp(leading, shift + 3 * unit_exponent);
    const double normal = std::clamp(value, std::numeric_limits<double>::min(), std::numeric_limits<double>::max() / 4);
    return cubic_units > 0 ? normal : -normal;
}

double by_integers(const Span& u, const Span& v, const Span& w) {
    const auto part = [](const Span& s, int axis) -> Integer { return in_units(s.to[axis]) - in_units(s.from[axis]); };
    Integer sum = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const Integer minor = part(v, j) * part(w, k) - part(v, k) * part(w, j);
        sum += part(u, i) * minor;
    }
    return to_double(sum);
}

}  // namespace

double exact_volume(const Span& u, const Span& v, const Span& w) {
    bool usual = true;
    for (const Span* s : {&u, &v, &w}) usual = usual && within_limits(s->from) && within_limits(s->to);
    return usual ? by_expansions(u, v, w) : by_integers(u, v, w);
}

}  // namespace kolize
