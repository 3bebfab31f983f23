// Statistics of a long run that need no memory for each sample, and of counts.
#pragma once

#include <cstdint>
#include <map>

namespace kolize::cli {

// How values >= 0 are spread: their number, the largest one, and quantiles to within 0.4 %.
class Spread {
public:
    void add(double value);
    std::uint64_t count() const { return count_; }
    double largest() const { return largest_; }
    double quantile(double p) const;  // p in [0, 1]; 0 for no values

private:
    std::map<std::uint32_t, std::uint64_t> bins_;  // by sign, exponent and the first bits of the mantissa
    std::uint64_t count_ = 0;
    double largest_ = 0;
};

// The share of `count` in `of`, with the interval that holds the true rate with 95 % confidence: Wilson's (JASA 22,
// 1927), and for a count of 0 from 0 to 3 / of.
struct Rate {
    std::uint64_t count = 0;
    std::uint64_t of = 0;

    double value() const { return of ? static_cast<double>(count) / static_cast<double>(of) : 0; }
    double low() const;
    double high() const;
};

}  // namespace kolize::cli
