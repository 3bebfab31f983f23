#include "models.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace kolize::models {

// SplitMix64: Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014. The standard's
// distributions differ from one library to the next, and the tables must not.
double Random::uniform() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

Vec3 Random::in_ball(double radius) {
    Vec3 p;
    do
        for (double& x : p) x = 2 * uniform() - 1;
    while (p.squaredNorm() > 1 || p.squaredNorm() < 0.1);  // not at rest either
    return radius * p;
}

Quat Random::attitude() { return Quat(Eigen::AngleAxisd(6 * uniform(), in_ball(1).normalized())); }

std::string state_row(const BodyState& state) {
    const auto& [p, q, v, w] = state;
    char text[512];
    std::snprintf(text, sizeof text, "%.6f,%.6f,%.6f,%.9f,%.9f,%.9f,%.9f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n", p.x(), p.y(),
                  p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
    return text;
}

StateWriter::StateWriter(double spacing, double jitter, double speed, double spin, std::uint64_t seed)
    : spacing_(spacing), jitter_(jitter), speed_(speed), spin_(spin), random_(seed) {
    for (int i = 0; i < 27; ++i) free_places_.emplace_back(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
}

std::string StateWriter::row(const Vec3& center_of_mass) {
    if (free_places_.empty()) throw std::logic_error("the lattice has 27 places");
    const auto pick = static_cast<std::ptrdiff_t>(random_.uniform() * static_cast<double>(free_places_.size()));
    const Vec3 center = spacing_ * free_places_[static_cast<std::size_t>(pick)] + random_.in_ball(jitter_);
    free_places_.erase(free_places_.begin() + pick);
    const Quat q = random_.attitude();
    const Vec3 v = random_.in_ball(speed_), w = random_.in_ball(spin_);
    return state_row({center - q * center_of_mass, q, v, w});
}

std::string StateWriter::table(int count, const Vec3& center_of_mass) {
    std::string text = state_header;
    for (int i = 0; i < count; ++i) text += row(center_of_mass);
    return text;
}

}  // namespace kolize::models
