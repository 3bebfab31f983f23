#include <kolize/complementarity.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace kolize {

namespace {

constexpr double regularisation = 1e-12;  // of the diagonal

// Several sums side by side, in an order that does not depend on the machine.
double dot(const double* x, const double* y, std::size_t size) {
    using Vector = Eigen::Map<const Eigen::VectorXd>;
    return Vector(x, static_cast<Eigen::Index>(size)).dot(Vector(y, static_cast<Eigen::Index>(size)));
}

}  // namespace

void ComplementarityProblem::reserve(std::size_t size) {
    for (auto* table : {&matrix_, &factor_}) table->reserve(size * size);
    for (auto* column : {&right_, &lambda_, &part_, &inverse_}) column->reserve(size);
    pushes_.reserve(size);
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
    pushes_.assign(size_, 0);
    kind_.assign(size_, Kind::pushes);
}

void ComplementarityProblem::start(std::size_t i, Kind kind, double lambda, double lack) {
    kind_[i] = kind;
    right_[i] += lack;
    if (kind == Kind::given) return;
    for (std::size_t j = first_[i]; lambda != 0 && j <= last_[i]; ++j) right_[j] += matrix_[j * size_ + i] * lambda;
    pushes_[i] = kind == Kind::holds || lambda > 0 || lack > 0;
}

// Exchanges all rows of the wrong sign at once as long as that makes them fewer, then the last one alone.
bool ComplementarityProblem::solve() {
    constexpr int patience = 10;
    std::size_t fewest = size_ + 1;
    int left = patience;
    for (std::size_t round = 0; round < 20 + 4 * size_; ++round) {
        solve_chosen();
        find_wrong();
        if (wrong_.empty()) return true;
        if (wrong_.size() < fewest) {
            fewest = wrong_.size();
            left = patience;
        } else if (--left < 0) {
            wrong_.erase(wrong_.begin(), wrong_.end() - 1);
        }
        for (const std::size_t i : wrong_) pushes_[i] = !pushes_[i];
    }
    return false;
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

void ComplementarityProblem::factorise() {
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
void ComplementarityProblem::substitute() {
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
