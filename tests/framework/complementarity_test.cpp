#include <kolize/complementarity.h>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace kolize;

namespace {

using Kind = ComplementarityProblem::Kind;

// K = J J^T with unit rows; fewer columns than rows make them depend on each other.
std::vector<std::vector<double>> random_rows(std::mt19937_64& random, std::size_t rows, std::size_t columns) {
    std::normal_distribution<double> normal;
    std::vector<std::vector<double>> j(rows, std::vector<double>(columns));
    for (auto& row : j) {
        double square = 0;
        for (double& x : row) x = normal(random), square += x * x;
        for (double& x : row) x /= std::sqrt(square);
    }
    return j;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

TEST_CASE("What pushes does not approach, and what parts does not push", "[complementarity]") {
    for (unsigned seed = 1; seed <= 300; ++seed) {
        CAPTURE(seed);
        std::mt19937_64 random(seed);
        const std::size_t rows = 1 + random() % 20, columns = 6 + random() % 20;
        const auto j = random_rows(random, rows, columns);
        // q = -J u for a u: then there are velocities that part all rows.
        std::vector<double> u(columns), q(rows);
        for (double& x : u) x = std::normal_distribution<double>()(random);
        for (std::size_t i = 0; i < rows; ++i) q[i] = dot(j[i], u);
        std::vector<Kind> kind(rows, Kind::pushes);
        if (rows < 6)
            for (Kind& k : kind) k = random() % 4 ? Kind::pushes : Kind::holds;
        ComplementarityProblem problem;
        problem.resize(rows);
        for (std::size_t i = 0; i < rows; ++i)
            for (std::size_t k = 0; k <= i; ++k) problem.set(i, k, dot(j[i], j[k]));
        problem.begin();
        for (std::size_t i = 0; i < rows; ++i) problem.start(i, kind[i], 0, q[i]);
        REQUIRE(problem.solve());
        for (std::size_t i = 0; i < rows; ++i) {
            double w = -q[i];
            for (std::size_t k = 0; k < rows; ++k) w += dot(j[i], j[k]) * problem.solution(k);
            if (kind[i] == Kind::holds) {
                CHECK(std::abs(w) < 1e-8);
                continue;
            }
            CHECK(problem.solution(i) >= 0);
            CHECK(w > -1e-8);
            CHECK(std::abs(problem.solution(i) * w) < 1e-6);
        }
    }
}

// Many more rows than motions, and begun with impulses that have nothing to do with the answer: exchanging all wrong
// rows at once goes round in circles for some of these.
TEST_CASE("Long heaps of rows that depend on each other are answered, whatever they begin with", "[complementarity]") {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        CAPTURE(seed);
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        const std::size_t rows = 40 + random() % 60, columns = 3 + random() % 30;
        auto j = random_rows(random, rows, columns);
        std::vector<double> u(columns), q(rows), begin(rows);
        for (double& x : u) x = normal(random);
        for (std::size_t i = 0; i < rows; ++i) q[i] = dot(j[i], u) - (random() % 3 ? 0.0 : std::abs(normal(random)));
        for (double& x : begin) x = std::max(0.0, normal(random));
        ComplementarityProblem problem;
        problem.resize(rows);
        for (std::size_t i = 0; i < rows; ++i)
            for (std::size_t k = 0; k <= i; ++k) problem.set(i, k, dot(j[i], j[k]));
        problem.begin();
        for (std::size_t i = 0; i < rows; ++i) {
            double lack = q[i];
            for (std::size_t k = 0; k < rows; ++k) lack -= dot(j[i], j[k]) * begin[k];
            problem.start(i, Kind::pushes, begin[i], lack);
        }
        REQUIRE(problem.solve());
        for (std::size_t i = 0; i < rows; ++i) {
            double w = -q[i];
            for (std::size_t k = 0; k < rows; ++k) w += dot(j[i], j[k]) * problem.solution(k);
            CHECK(problem.solution(i) >= 0);
            CHECK(w > -1e-8);
            CHECK(std::abs(problem.solution(i) * w) < 1e-6);
        }
    }
}

TEST_CASE("Four corners that bear one box share its weight", "[complementarity]") {
    ComplementarityProblem problem;
    problem.resize(4);
    // Normals along one axis, corners (+-1, +-1): three independent motions for four rows, scaled to 1.
    const double corner[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k <= i; ++k)
            problem.set(i, k, (1 + corner[i][0] * corner[k][0] + corner[i][1] * corner[k][1]) / 3);
    problem.begin();
    for (std::size_t i = 0; i < 4; ++i) problem.start(i, Kind::pushes, 0, 1);
    REQUIRE(problem.solve());
    for (std::size_t i = 0; i < 4; ++i) CHECK(problem.solution(i) == Approx(0.75).epsilon(1e-3));
}
