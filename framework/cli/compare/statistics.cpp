#include "compare/statistics.h"

#include "common.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace kolize::cli {

namespace {

constexpr unsigned bootstrap_seed = 20261123;
constexpr int resamples = 2000;
constexpr double tail = 0.025;

}  // namespace

Estimate median_estimate(const std::vector<double>& samples) {
    if (samples.empty()) return {};
    std::mt19937 random(bootstrap_seed);
    std::uniform_int_distribution<std::size_t> any(0, samples.size() - 1);
    std::vector<double> medians, drawn(samples.size());
    for (int i = 0; i < resamples; ++i) {
        for (double& value : drawn) value = samples[any(random)];
        medians.push_back(median(drawn));
    }
    return {median(samples), quantile(medians, tail), quantile(medians, 1 - tail)};
}

Estimate ordered_estimate(std::vector<double> samples) {
    if (samples.empty()) return {};
    std::sort(samples.begin(), samples.end());
    const std::size_t n = samples.size();
    // The largest k such that fewer than k heads in n throws of a coin have a probability of at most `tail`.
    double term = std::pow(0.5, static_cast<double>(n)), sum = term;
    std::size_t k = 0;
    while (sum <= tail) {
        term *= static_cast<double>(n - k) / static_cast<double>(k + 1);
        sum += term;
        ++k;
    }
    Estimate estimate{median(samples), 0, std::numeric_limits<double>::infinity()};
    if (k > 0) estimate.low = samples[k - 1], estimate.high = samples[n - k];
    return estimate;
}

Estimate paired_ratio(const std::vector<double>& times, const std::vector<double>& baseline) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(times.size(), baseline.size()); ++i)
        if (baseline[i] > 0) ratios.push_back(times[i] / baseline[i]);
    return ordered_estimate(std::move(ratios));
}

std::string verdict(const Estimate& ratio) {
    const auto between = [](double low, double high) { return " (" + number(low) + " to " + number(high) + ")"; };
    if (std::isinf(ratio.high)) return "too few repeats to tell";
    if (ratio.high < 1) return number(1 / ratio.value) + " times faster" + between(1 / ratio.high, 1 / ratio.low);
    if (ratio.low > 1) return number(ratio.value) + " times slower" + between(ratio.low, ratio.high);
    return "no difference shown" + between(ratio.low, ratio.high);
}

double theil_sen_slope(const std::vector<double>& x, const std::vector<double>& y) {
    std::vector<double> slopes;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = i + 1; j < x.size(); ++j)
            if (x[j] != x[i]) slopes.push_back((y[j] - y[i]) / (x[j] - x[i]));
    return median(std::move(slopes));
}

}  // namespace kolize::cli
