// Exact sums and products of doubles, as expansions: unevaluated sums of doubles of which each is smaller than the last
// bit of the next. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates",
// DCG 18, 1997; the section or figure stands at each function.
//
// Exact as long as no intermediate result overflows or loses bits below the smallest double: see exact_volume.cpp.
#pragma once

#include <array>

namespace kolize {

// At most N terms, the smallest first, none of them zero.
template <int N>
struct Expansion {
    std::array<double, N> terms;
    int size = 0;

    void append(double term) {
        if (term != 0) terms[size++] = term;
    }
    // Has the sign of the exact sum and differs from it by rounding.
    double value() const {
        double sum = 0;
        for (int i = 0; i < size; ++i) sum += terms[i];
        return sum;
    }
};

struct Rounded {
    double value;
    double error;  // what rounding took away
};

// Theorem 7 (Knuth).
inline Rounded two_sum(double a, double b) {
    const double sum = a + b, b_virtual = sum - a, a_virtual = sum - b_virtual;
    return {sum, (a - a_virtual) + (b - b_virtual)};
}

// Theorem 17 (Dekker, Veltkamp): the upper 26 bits, and the rest.
inline Rounded split(double a) {
    const double c = 134217729 * a;  // 2^27 + 1
    const double high = c - (c - a);
    return {high, a - high};
}

// Theorem 18 (Dekker, Veltkamp).
inline Rounded two_product(double a, double b) {
    const double product = a * b;
    const Rounded x = split(a), y = split(b);
    const double rest = product - x.value * y.value - x.error * y.value - x.value * y.error;
    return {product, x.error * y.error - rest};
}

inline Expansion<2> difference(double a, double b) {
    const Rounded r = two_sum(a, -b);
    Expansion<2> result;
    result.append(r.error);
    result.append(r.value);
    return result;
}

// Figure 8, LINEAR-EXPANSION-SUM without the zeros: terms of both in the order of their magnitude.
template <int N, int M>
Expansion<N + M> operator+(const Expansion<N>& e, const Expansion<M>& f) {
    Expansion<N + M> result;
    double carry = 0;
    for (int i = 0, j = 0; i < e.size || j < f.size;) {
        const bool from_e = j == f.size || (i < e.size && (e.terms[i] < 0 ? -e.terms[i] : e.terms[i]) <
                                                              (f.terms[j] < 0 ? -f.terms[j] : f.terms[j]));
        const Rounded sum = two_sum(carry, from_e ? e.terms[i++] : f.terms[j++]);
        result.append(sum.error);
        carry = sum.value;
    }
    result.append(carry);
    return result;
}

template <int N>
Expansion<N> operator-(Expansion<N> e) {
    for (int i = 0; i < e.size; ++i) e.terms[i] = -e.terms[i];
    return e;
}

// Figure 13, SCALE-EXPANSION.
template <int N>
Expansion<2 * N> scaled(const Expansion<N>& e, double factor) {
    Expansion<2 * N> result;
    double carry = 0;
    for (int i = 0; i < e.size; ++i) {
        const Rounded product = two_product(e.terms[i], factor);
        const Rounded low = two_sum(carry, product.error), high = two_sum(product.value, low.value);
        result.append(low.error);
        result.append(high.error);
        carry = high.value;
    }
    result.append(carry);
    return result;
}

template <int N>
Expansion<4 * N> operator*(const Expansion<N>& e, const Expansion<2>& f) {
    Expansion<2 * N> low, high;
    if (f.size > 0) high = scaled(e, f.terms[f.size - 1]);
    if (f.size > 1) low = scaled(e, f.terms[0]);
    return low + high;
}

}  // namespace kolize
