#include <kolize/complementarity.h>

#include <algorithm>
#include <cmath>
#include <cstring>

// The same operations in the same order on vectors of two and of four numbers: the same bits on every machine.
#define KOLIZE_WIDE [[gnu::target_clones("avx2", "default")]]

namespace kolize {

namespace {

constexpr double regularisation = 1e-12;  // of the diagonal

using Four = double __attribute__((vector_size(32)));

[[gnu::always_inline]] inline double dot(const double* x, const double* y, std::size_t size) {
    Four sums{};
    std::size_t i = 0;
    for (; i + 4 <= size; i += 4) {
        Four a, b;
        std::memcpy(&a, x + i, sizeof a);
        std::memcpy(&b, y + i, sizeof b);
        sums += a * b;
    }
    double rest = 0;
    for (; i < size; ++i) rest += x[i] * y[i];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest;
}

}  // namespace

void ComplementarityProblem::reserve(std::size_t size) {
    for (auto* table : {&matrix_, &factor_}) table->reserve(size * size);
    for (auto* column : {&right_, &lambda_, &part_, &inverse_, &start_}) column->reserve(size);
    pushes_.reserve(size);
    barred_.reserve(size);
    kind_.reserve(size);
    for (auto* list : {&chosen_, &factorised_, &wrong_, &first_, &last_, &envelope_}) list->reserve(size);
}

void ComplementarityProblem::resize(std::size_t size) {
    size_ = size;
    matrix_.assign(size * size, 0);
    factorised_.clear();
    first_.resize(size);
    last_.resize(size);
    for (std::size_t i = 0; i < size; ++i) first_[i] = last_[i] = i;
    begin();
}

void ComplementarityProblem::begin() {
    right_.assign(size_, 0);
    lambda_.assign(size_, 0);
    start_.assign(size_, 0);
    pushes_.assign(size_, 0);
    kind_.assign(size_, Kind::pushes);
}

void ComplementarityProblem::start(std::size_t i, Kind kind, double lambda, double lack) {
    kind_[i] = kind;
    right_[i] += lack;
    if (kind == Kind::given) return;
    start_[i] = lambda;
    for (std::size_t j = first_[i]; lambda != 0 && j <= last_[i]; ++j) right_[j] += matrix_[j * size_ + i] * lambda;
    pushes_[i] = kind == Kind::holds || lambda > 0 || lack > 0;
}

// Exchanges all rows of the wrong sign at once as long as that makes them fewer.
bool ComplementarityProblem::solve() {
    constexpr int patience = 4;
    std::size_t fewest = size_ + 1;
    for (int left = patience; left > 0; --left) {
        solve_chosen();
        find_wrong();
        if (wrong_.empty()) return true;
        if (wrong_.size() < fewest) {
            fewest = wrong_.size();
            left = patience;
        }
        for (const std::size_t i : wrong_) pushes_[i] = !pushes_[i];
    }
    return descend();
}

// One row after the other, and the energy lambda K lambda / 2 - q lambda always less: slower, and sure to end. Lawson
// and Hanson, Solving Least Squares Problems (1974), chapter 23, from the impulses of start().
bool ComplementarityProblem::descend() {
    for (std::size_t i = 0; i < size_; ++i) pushes_[i] = kind_[i] == Kind::holds || start_[i] > 0;
    barred_.assign(size_, 0);
    for (std::size_t round = 0; round < 20 + size_; ++round) {
        solve_chosen();
        if (step_back()) continue;
        start_ = lambda_;
        find_wrong();
        const auto pull_of = [&](std::size_t i) { return barred_[i] ? 0 : pull(i) - right_[i]; };
        const auto worst = std::min_element(wrong_.begin(), wrong_.end(),
                                            [&](std::size_t i, std::size_t j) { return pull_of(i) < pull_of(j); });
        if (worst == wrong_.end() || barred_[*worst]) return true;
        pushes_[*worst] = 1;
    }
    return false;
}

// Goes from start_ towards lambda_ until a row does not push any more, and lets that one go; false if all still push.
bool ComplementarityProblem::step_back() {
    double share = 1;
    std::size_t first = size_;
    for (const std::size_t i : chosen_) {
        if (kind_[i] != Kind::pushes || lambda_[i] >= 0) continue;
        const double part = start_[i] / (start_[i] - lambda_[i]);
        if (part >= share) continue;
        share = part;
        first = i;
    }
    if (first == size_) return false;
    for (std::size_t i = 0; i < size_; ++i) start_[i] += share * (lambda_[i] - start_[i]);
    start_[first] = 0;
    pushes_[first] = 0;
    // What has only just come in and has to leave at once was out by rounding alone.
    if (share > 0) std::fill(barred_.begin(), barred_.end(), 0);
    barred_[first] = share == 0;
    return true;
}

// Row i of K lambda.
double ComplementarityProblem::pull(std::size_t i) const {
    return dot(&matrix_[i * size_ + first_[i]], &lambda_[first_[i]], last_[i] + 1 - first_[i]);
}

void ComplementarityProblem::find_wrong() {
    wrong_.clear();
    double largest = 0;
    for (std::size_t i = 0; i < size_; ++i) largest = std::max({largest, std::abs(right_[i]), std::abs(lambda_[i])});
    for (std::size_t i = 0; i < size_; ++i) {
        if (kind_[i] != Kind::pushes) continue;
        const double w = pull(i) - right_[i];
        if (pushes_[i] ? lambda_[i] < 0 : w < -1e-12 * largest) wrong_.push_back(i);
    }
}

// lambda of the rows that push, by Cholesky's method within the envelope: George and Liu, Computer Solution of Large
// Sparse Positive Definite Systems (1981), 4. Refined, because what makes K definite is not small next to it where one
// contact bears a million times what another does.
void ComplementarityProblem::solve_chosen() {
    constexpr int refinements = 3;
    chosen_.clear();
    for (std::size_t i = 0; i < size_; ++i)
        if (pushes_[i]) chosen_.push_back(i);
    if (chosen_ != factorised_) factorise();
    std::fill(lambda_.begin(), lambda_.end(), 0);
    for (double before = 0, left = 0, round = 0; round <= refinements; ++round, before = left) {
        left = 0;
        for (std::size_t i = 0; i < chosen_.size(); ++i) {
            const std::size_t row = chosen_[i];
            part_[i] = right_[row] - (round > 0 ? pull(row) : 0);
            left = std::max(left, std::abs(part_[i]));
        }
        if (left == 0 || (round > 0 && left > 0.25 * before)) return;
        substitute();
        for (std::size_t i = 0; i < chosen_.size(); ++i) lambda_[chosen_[i]] += part_[i];
    }
}

KOLIZE_WIDE void ComplementarityProblem::factorise() {
    const std::size_t n = chosen_.size();
    factor_.resize(n * n);
    part_.resize(n);
    inverse_.resize(n);
    envelope_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double* const row = &matrix_[chosen_[i] * size_];
        double* const out = &factor_[i * n];
        std::size_t j = 0;
        while (chosen_[j] < first_[chosen_[i]]) ++j;
        for (envelope_[i] = j; j < i; ++j) {
            const std::size_t m = std::max(envelope_[i], envelope_[j]);
            const double* const other = &factor_[j * n];
            out[j] = (row[chosen_[j]] - (m < j ? dot(out + m, other + m, j - m) : 0)) * inverse_[j];
        }
        const std::size_t m = envelope_[i];
        const double rest = row[chosen_[i]] + regularisation - dot(out + m, out + m, i - m);
        out[i] = std::sqrt(std::max(rest, 0.1 * regularisation));
        inverse_[i] = 1 / out[i];
    }
    factorised_ = chosen_;
}

// part = (L L^T)^-1 part.
KOLIZE_WIDE void ComplementarityProblem::substitute() {
    const std::size_t n = chosen_.size();
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t m = envelope_[i];
        part_[i] = (part_[i] - dot(&factor_[i * n + m], &part_[m], i - m)) * inverse_[i];
    }
    for (std::size_t i = n; i-- > 0;) {
        const double* const row = &factor_[i * n];
        part_[i] *= inverse_[i];
        for (std::size_t m = envelope_[i]; m < i; ++m) part_[m] -= row[m] * part_[i];
    }
}

}  // namespace kolize
