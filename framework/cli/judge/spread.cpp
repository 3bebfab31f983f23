#include "spread.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kolize::cli {
namespace {

constexpr int dropped_bits = 52 - 7;  // of the mantissa: a bin is 1/128 of its value wide

std::uint32_t bin_of(double value) {
    return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(value) >> dropped_bits);
}

double middle_of(std::uint32_t bin) {
    const std::uint64_t half = std::uint64_t(1) << (dropped_bits - 1);
    return bin ? std::bit_cast<double>((std::uint64_t(bin) << dropped_bits) + half) : 0;
}

struct Interval {
    double low, high;
};

Interval wilson(const Rate& rate) {
    constexpr double z = 1.959963984540054;  // of the normal distribution, for 95 %
    const double n = static_cast<double>(rate.of), p = rate.value();
    const double middle = p + z * z / (2 * n), scale = 1 + z * z / n;
    const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
    return {std::max(0.0, (middle - half) / scale), std::min(1.0, (middle + half) / scale)};
}

}  // namespace

void Spread::add(double value) {
    ++bins_[bin_of(value)];
    ++count_;
    largest_ = std::max(largest_, value);
}

double Spread::quantile(double p) const {
    const double rank = p * static_cast<double>(count_);
    std::uint64_t below = 0;
    for (const auto& [bin, count] : bins_) {
        below += count;
        if (static_cast<double>(below) >= rank) return std::min(middle_of(bin), largest_);
    }
    return largest_;
}

double Rate::low() const { return count == 0 ? 0 : wilson(*this).low; }

double Rate::high() const {
    if (of == 0) return 1;
    return count == 0 ? std::min(1.0, 3 / static_cast<double>(of)) : wilson(*this).high;
}

}  // namespace kolize::cli
