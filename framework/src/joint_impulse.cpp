#include <kolize/joint_impulse.h>

namespace kolize {

namespace {

constexpr double tolerance = 1e-15;  // of the fastest approach
constexpr double noise = 1e-15;      // curvature below this is rounding: the rows depend on each other

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

void JointImpulse::reserve(std::size_t rows, std::size_t bodies) {
    change_.reserve(bodies + 1);
    for (Column* column : {&weight_, &start_, &allowance_, &x_, &gradient_, &free_, &chopped_, &direction_, &image_})
        column->reserve(rows);
}

void JointImpulse::solve(const ImpactRows& rows, std::span<const std::uint32_t> chosen, const World& world) {
    rows_ = &rows;
    chosen_ = chosen;
    load(world);
    for (std::size_t left = 50 + 4 * chosen_.size(); left > 0 && step(); --left) {
    }
    apply_k(x_, image_);
    approach_ = dot(x_, start_);
    allowed_ = dot(x_, allowance_);
    k_ = dot(x_, image_);
}

void JointImpulse::load(const World& world) {
    const std::size_t count = chosen_.size();
    for (Column* column : {&weight_, &start_, &allowance_, &x_, &free_, &chopped_, &direction_, &image_})
        column->assign(count, 0);
    change_.resize(rows_->moving_bodies() + 1);
    scale_ = 0;
    for (std::size_t i = 0; i < count; ++i) {
        weight_[i] = 1 / std::sqrt(row(i).k);
        allowance_[i] = row(i).allowed * weight_[i];
        start_[i] = row(i).normal_velocity(world) * weight_[i] + allowance_[i];
        scale_ = std::max(scale_, -start_[i]);
    }
    if (scale_ > 0)
        for (std::size_t i = 0; i < count; ++i) start_[i] /= scale_, allowance_[i] /= scale_;
    gradient_ = start_;
    short_step_ = 1 / static_cast<double>(crowding());
    split_gradient();
}

// The largest number of rows that one row shares bodies with, itself counted twice: a bound of the norm of K.
std::size_t JointImpulse::crowding() const {
    std::size_t most = 1;
    for (std::size_t i = 0; i < chosen_.size(); ++i)
        most = std::max(most, rows_->rows_of(row(i).moving_a).size() + rows_->rows_of(row(i).moving_b).size());
    return most;
}

// False where there is nothing left to gain.
bool JointImpulse::step() {
    const double free_square = dot(free_, free_), chopped_square = dot(chopped_, chopped_);
    if (free_square + chopped_square <= tolerance * tolerance * static_cast<double>(x_.size())) return false;
    return chopped_square > free_square ? release() : descend();
}

// Lets the rows push that approach and do not push yet.
bool JointImpulse::release() {
    direction_ = chopped_;
    apply_k(direction_, image_);
    const double curvature = dot(direction_, image_);
    if (!(curvature > noise * dot(direction_, direction_))) return false;
    advance(dot(gradient_, direction_) / curvature);
    split_gradient();
    direction_ = free_;
    return true;
}

// A step of conjugate gradients, as far as no impulse becomes negative.
bool JointImpulse::descend() {
    apply_k(direction_, image_);
    const double curvature = dot(direction_, image_);
    if (!(curvature > noise * dot(direction_, direction_))) return false;
    const double length = dot(gradient_, direction_) / curvature;
    double feasible = infinity;
    for (std::size_t i = 0; i < x_.size(); ++i)
        if (direction_[i] > 0) feasible = std::min(feasible, x_[i] / direction_[i]);
    if (length > feasible) {
        expand(feasible);
        return true;
    }
    advance(length);
    split_gradient();
    const double turn = dot(free_, image_) / curvature;
    for (std::size_t i = 0; i < x_.size(); ++i) direction_[i] = free_[i] - turn * direction_[i];
    return true;
}

// Goes to where the first row stops pushing, and on along the gradient, on which others may stop too.
void JointImpulse::expand(double feasible) {
    advance(feasible);
    split_gradient();
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = std::max(0.0, x_[i] - short_step_ * free_[i]);
    apply_k(x_, gradient_);
    for (std::size_t i = 0; i < x_.size(); ++i) gradient_[i] += start_[i];
    split_gradient();
    direction_ = free_;
}

void JointImpulse::advance(double length) {
    for (std::size_t i = 0; i < x_.size(); ++i) {
        x_[i] = std::max(0.0, x_[i] - length * direction_[i]);
        gradient_[i] -= length * image_[i];
    }
}

void JointImpulse::split_gradient() {
    for (std::size_t i = 0; i < x_.size(); ++i) {
        free_[i] = x_[i] > 0 ? gradient_[i] : 0;
        chopped_[i] = x_[i] > 0 ? 0 : std::min(0.0, gradient_[i]);
    }
}

// out = K in, with K = J M^-1 J^T of the scaled rows.
void JointImpulse::apply_k(const Column& in, Column& out) {
    for (std::size_t i = 0; i < chosen_.size(); ++i) change(row(i).moving_a) = change(row(i).moving_b) = Change{};
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
        const ImpactRow& r = row(i);
        const double impulse = in[i] * weight_[i];
        Change &a = change(r.moving_a), &b = change(r.moving_b);
        a.linear -= impulse * r.inverse_mass_a * r.contact->normal;
        b.linear += impulse * r.inverse_mass_b * r.contact->normal;
        a.angular -= impulse * r.turn_a;
        b.angular += impulse * r.turn_b;
    }
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
        const ImpactRow& r = row(i);
        const Change &a = change(r.moving_a), &b = change(r.moving_b);
        out[i] = weight_[i] *
                 (r.contact->normal.dot(b.linear - a.linear) + (r.moment_b.dot(b.angular) - r.moment_a.dot(a.angular)));
    }
}

}  // namespace kolize
