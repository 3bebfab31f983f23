// What timings allow to say: medians with intervals, and whether two rows differ.
#pragma once

#include <string>
#include <vector>

namespace kolize::cli {

struct Estimate {
    double value = 0;
    double low = 0, high = 0;  // 95 %
};

// The median, with a percentile bootstrap interval (Efron and Tibshirani 1993, 13.3; seeded, so that it can be
// repeated).
Estimate median_estimate(const std::vector<double>& samples);

// The median with an interval by order statistics (David and Nagaraja 2003, 7.1): whatever the distribution, it holds
// the true median with at least 95 % confidence. With fewer than six samples no such interval exists; then it is from 0
// to infinity.
Estimate ordered_estimate(std::vector<double> samples);

// The i-th of one by the i-th of the other, which were taken in the same round: what slows the machine down falls on
// both. Median of the ratios with its interval by order statistics.
Estimate paired_ratio(const std::vector<double>& times, const std::vector<double>& baseline);

// "1.8 times faster (1.7 to 1.9)", "1.2 times slower (1.1 to 1.3)" or "no difference shown (0.97 to 1.04)", of a ratio
// of times to those of the baseline.
std::string verdict(const Estimate& ratio);
inline bool differs(const Estimate& ratio) { return ratio.low > 1 || ratio.high < 1; }

// The slope of y over x by the median of the slopes of all pairs of points (Theil 1950, Sen 1968).
double theil_sen_slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace kolize::cli
