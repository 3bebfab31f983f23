// Linear complementarity problems of contact: which contacts push, and how hard.
#pragma once

#include <kolize/export.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kolize {

// Find lambda >= 0 with w = K lambda - q >= 0 and lambda . w = 0, for a symmetric, positive semidefinite K with ones on
// its diagonal. Rows of K may depend on each other (a box on four corners): K is made definite by a share of 1e-12, and
// of all solutions that of least norm comes out, nearly. Block principal pivoting: Judice and Pires, "A block principal
// pivoting algorithm for large-scale strictly monotone linear complementarity problems", Computers & Operations
// Research 21, 1994. Costs the cube of the rows that push, a few times over.
// A row may also hold (w = 0, with a lambda of any sign) or be given (its lambda is part of q already).
class KOLIZE_API ComplementarityProblem {
public:
    enum class Kind : std::uint8_t { pushes, holds, given };

    // Problems up to this size allocate nothing.
    void reserve(std::size_t size);

    // Forgets everything: K, q and lambda are 0. Entries of K are set before the first solve().
    void resize(std::size_t size);
    // K(i, j) and K(j, i), j <= i. Rows whose entries stand near the diagonal cost less.
    void set(std::size_t i, std::size_t j, double value) {
        matrix_[i * size_ + j] = matrix_[j * size_ + i] = value;
        if (j < first_[i]) first_[i] = j;
        if (i > last_[j]) last_[j] = i;
    }
    // Forgets q and lambda, and keeps K.
    void begin();
    // Once K is set, for each row: a lambda to begin with, and what w lacks to 0 if all rows have theirs. Adds up to q.
    void start(std::size_t i, Kind kind, double lambda, double lack);

    // False if no answer was found.
    bool solve();
    double solution(std::size_t i) const { return kind_[i] == Kind::holds || lambda_[i] > 0 ? lambda_[i] : 0; }

private:
    bool descend();
    bool step_back();
    void solve_chosen();
    void factorise();
    void substitute();
    void find_wrong();
    double pull(std::size_t i) const;

    std::size_t size_ = 0;
    std::vector<double> matrix_, factor_;    // row by row
    std::vector<std::size_t> first_, last_;  // columns of a row between which it is not 0
    std::vector<std::size_t> envelope_;      // likewise of the factor, the first one
    std::vector<double> right_, lambda_, part_, start_;
    std::vector<double> inverse_;  // of the factor's diagonal
    std::vector<Kind> kind_;
    std::vector<std::uint8_t> pushes_;         // or holds
    std::vector<std::uint8_t> barred_;         // rows that are not to push again at once
    std::vector<std::size_t> chosen_, wrong_;  // rows that push; rows whose lambda or w has the wrong sign
    std::vector<std::size_t> factorised_;      // rows of the factor
};

}  // namespace kolize
