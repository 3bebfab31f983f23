// Intervals and verdicts of kolize compare, against known distributions.
#include "compare/statistics.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace kolize::cli;

namespace {

// As timings are: never below a floor, with a long tail, and slower for whole stretches while something else runs.
class Machine {
public:
    explicit Machine(unsigned seed) : random_(seed) {}
    double time(double least) {
        busy_ = 0.9 * busy_ + 0.1 * std::abs(normal_(random_));
        return least * (1 + busy_ + 0.02 * std::exp(normal_(random_)));
    }

private:
    std::mt19937 random_;
    std::normal_distribution<double> normal_;
    double busy_ = 0;
};

std::pair<std::vector<double>, std::vector<double>> rounds(Machine& machine, std::mt19937& coin, int count,
                                                           double ratio) {
    std::pair<std::vector<double>, std::vector<double>> times;
    for (int i = 0; i < count; ++i) {
        const bool first = coin() % 2;
        const double a = machine.time(first ? 1 : ratio), b = machine.time(first ? ratio : 1);
        times.first.push_back(first ? a : b);
        times.second.push_back(first ? b : a);
    }
    return times;
}

}  // namespace

TEST_CASE("A row that is the same as the baseline is called different in at most 5 % of trials", "[compare]") {
    const unsigned seed = 20261126;
    CAPTURE(seed);
    Machine machine(seed);
    std::mt19937 coin(seed);
    for (const int count : {7, 12, 31}) {
        int wrong = 0;
        constexpr int trials = 2000;
        for (int trial = 0; trial < trials; ++trial) {
            const auto [base, again] = rounds(machine, coin, count, 1);
            wrong += differs(paired_ratio(again, base));
        }
        CAPTURE(count, wrong);
        CHECK(wrong <= 0.05 * trials + 3 * std::sqrt(0.05 * 0.95 * trials));
    }
}

TEST_CASE("A row that is twice as slow is told so, however busy the machine is", "[compare]") {
    const unsigned seed = 20261127;
    CAPTURE(seed);
    Machine machine(seed);
    std::mt19937 coin(seed);
    int right = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const auto [base, slow] = rounds(machine, coin, 9, 2);
        const Estimate ratio = paired_ratio(slow, base);
        right += ratio.low > 1;
        CHECK(verdict(ratio).find(ratio.low > 1 ? "slower" : "difference") != std::string::npos);
    }
    CHECK(right > 190);
}

TEST_CASE("The interval of a median by order statistics is that of the sign test", "[compare]") {
    const std::vector<double> nine{9, 1, 8, 2, 7, 3, 6, 4, 5};
    const Estimate of_nine = ordered_estimate(nine);  // 96.1 %: the second of each end
    CHECK(of_nine.value == 5);
    CHECK(of_nine.low == 2);
    CHECK(of_nine.high == 8);
    const Estimate of_five = ordered_estimate({1, 2, 3, 4, 5});  // 93.8 % at most
    CHECK(of_five.value == 3);
    CHECK(std::isinf(of_five.high));
    CHECK(verdict(of_five) == "too few repeats to tell");
    CHECK(ordered_estimate({1, 2, 3, 4, 5, 6}).low == 1);
}

TEST_CASE("The bootstrap interval of a median holds it, and narrows as samples come", "[compare]") {
    const unsigned seed = 20261128;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::exponential_distribution<double> waiting;
    const double truth = std::log(2);
    int held = 0;
    double wide = 0, narrow = 0;
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> samples;
        for (int i = 0; i < 31; ++i) samples.push_back(waiting(random));
        const Estimate many = median_estimate(samples);
        held += many.low <= truth && truth <= many.high;
        narrow += many.high - many.low;
        samples.resize(8);
        const Estimate few = median_estimate(samples);
        wide += few.high - few.low;
    }
    CHECK(held > 200 * 0.88);
    CHECK(narrow < 0.7 * wide);
}

TEST_CASE("Theil and Sen's slope is not moved by outliers", "[compare]") {
    std::vector<double> x, y;
    for (int i = 0; i < 40; ++i) {
        x.push_back(i);
        y.push_back(i % 10 == 0 ? 1e6 : 3 * i + 1);
    }
    CHECK(theil_sen_slope(x, y) == Approx(3));
    CHECK(theil_sen_slope({1}, {1}) == 0);
}
