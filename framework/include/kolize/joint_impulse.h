// The impulses that stop several contacts together: Moreau's inelastic impact, and the direction along which
// generalized reflections reflect.
#pragma once

#include <kolize/impact_rows.h>

#include <algorithm>

namespace kolize {

// Of some rows: the impulses p >= 0 after which none of the rows approaches and those that part have p = 0. That is,
// the velocities u + M^-1 J^T p are the nearest to u, in the metric of kinetic energy, that have J u >= 0: Moreau,
// "Unilateral contact and dry friction in finite freedom dynamics", 1988. The velocities are unique; the impulses are
// where the rows are independent. A row that is allowed some approach counts as if it had that much less. Found by
// conjugate gradients among the rows that push: Dostal, Schoeberl, "Minimizing quadratic functions subject to bound
// constraints with the rate of convergence and finite termination", Computational Optimization and Applications 30,
// 2005. A step of it costs a few dozen operations a row.
//
// The search ends at rounding or after a number of steps, and is inexact then. factor() and energy() are
// exact for any p, so that no energy is lost or made by that.
class KOLIZE_API JointImpulse {
public:
    // Room for so many rows and bodies: solve() allocates nothing up to there.
    void reserve(std::size_t rows, std::size_t bodies);

    // `chosen`: indices into rows.rows(). Changes nothing in the world.
    void solve(const ImpactRows& rows, std::span<const std::uint32_t> chosen, const World& world);

    // p of the i-th chosen row, N s.
    double impulse(std::size_t i) const { return scale_ * x_[i] * weight_[i]; }
    // The impulses times factor() take the most kinetic energy away, energy() in J; times 2 factor() none. It is 1
    // unless the search was cut short; 0 or not a number where nothing approaches.
    double factor() const { return -approach_ / k_; }
    double energy() const { return scale_ * (scale_ * (approach_ * approach_ / (2 * k_) + factor() * allowed_)); }

private:
    struct Change {  // of a body's velocities
        Vec3 linear = Vec3::Zero();
        Vec3 angular = Vec3::Zero();
    };
    using Column = std::vector<double>;  // a number per chosen row

    void load(const World& world);
    std::size_t crowding() const;
    bool step();
    bool release();
    bool descend();
    void expand(double feasible);
    void advance(double length);
    void split_gradient();
    void apply_k(const Column& in, Column& out);

    const ImpactRow& row(std::size_t i) const { return rows_->rows()[chosen_[i]]; }
    Change& change(std::uint32_t moving) { return change_[std::min<std::size_t>(moving, change_.size() - 1)]; }

    const ImpactRows* rows_ = nullptr;
    std::span<const std::uint32_t> chosen_;
    std::vector<Change> change_;  // M^-1 J^T of something, per moving body; the last one is that of all static bodies
    // Rows are scaled to k = 1, and velocities so that the fastest approach is 1.
    Column weight_;          // 1 / sqrt(k)
    Column start_;           // J u before, plus what is allowed
    Column allowance_;       // what is allowed
    Column x_;               // impulse
    Column gradient_;        // J u after the impulses
    Column free_;            // gradient where x > 0
    Column chopped_;         // gradient where x = 0 and the row still approaches
    Column direction_;       // of search: x decreases along it
    Column image_;           // K direction
    double scale_ = 0;       // of the velocities, sqrt(J)
    double short_step_ = 0;  // along the gradient, overshoots nothing
    double approach_ = 0;    // x . start
    double allowed_ = 0;     // x . what is allowed
    double k_ = 0;           // x . K x
};

}  // namespace kolize
