#include "judge/spread.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>
#include <vector>

using namespace kolize::cli;

TEST_CASE("quantiles of a spread are those of its values within half a per cent", "[cli][judge]") {
    const unsigned seed = GENERATE(1u, 2u, 3u);
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::lognormal_distribution<double> value(0, 8);
    Spread spread;
    std::vector<double> values;
    for (int i = 0; i < 10001; ++i) spread.add(values.emplace_back(value(random)));
    std::sort(values.begin(), values.end());
    for (const std::size_t i : {500u, 5000u, 9500u})
        CHECK(spread.quantile(double(i) / 10000) == Approx(values[i]).epsilon(0.02));
    CHECK(spread.quantile(1) == Approx(values.back()).epsilon(0.005));
    CHECK(spread.largest() == values.back());
    CHECK(spread.count() == values.size());
    CHECK(Spread().quantile(0.5) == 0);
    Spread zeros;
    zeros.add(0);
    CHECK(zeros.quantile(0.5) == 0);
}

TEST_CASE("the interval of a rate is Wilson's, and of no case the rule of three", "[cli][judge]") {
    // Newcombe, Statistics in Medicine 17, 1998, table I, method 3.
    CHECK(Rate{81, 263}.low() == Approx(0.2553).margin(1e-4));
    CHECK(Rate{81, 263}.high() == Approx(0.3662).margin(1e-4));
    CHECK(Rate{15, 148}.low() == Approx(0.0624).margin(1e-4));
    CHECK(Rate{15, 148}.high() == Approx(0.1605).margin(1e-4));
    CHECK(Rate{29, 29}.low() == Approx(0.8830).margin(1e-4));
    CHECK(Rate{29, 29}.high() == 1);
    CHECK(Rate{0, 1000}.low() == 0);
    CHECK(Rate{0, 1000}.high() == 0.003);
    CHECK(Rate{0, 2}.high() == 1);
    CHECK(Rate{0, 0}.high() == 1);
}
