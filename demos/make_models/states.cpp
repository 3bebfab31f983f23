#include "models.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace kolize::models {

StateWriter::StateWriter(double spacing, double jitter, double speed, double spin, std::uint64_t seed)
    : spacing_(spacing), jitter_(jitter), speed_(speed), spin_(spin), state_(seed) {
    for (int i = 0; i < 27; ++i) free_places_.emplace_back(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
}

// SplitMix64: Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014. The standard's
// distributions differ from one library to the next, and the tables must not.
double StateWriter::uniform() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

Vec3 StateWriter::in_ball(double radius) {
    Vec3 p;
    do
        for (double& x : p) x = 2 * uniform() - 1;
    while (p.squaredNorm() > 1 || p.squaredNorm() < 0.1);  // not at rest either
    return radius * p;
}

std::string StateWriter::row(const Vec3& center_of_mass) {
    if (free_places_.empty()) throw std::logic_error("the lattice has 27 places");
    const auto pick = static_cast<std::ptrdiff_t>(uniform() * static_cast<double>(free_places_.size()));
    const Vec3 center = spacing_ * free_places_[static_cast<std::size_t>(pick)] + in_ball(jitter_);
    free_places_.erase(free_places_.begin() + pick);
    const Quat q(Eigen::AngleAxisd(6 * uniform(), in_ball(1).normalized()));
    const Vec3 p = center - q * center_of_mass, v = in_ball(speed_), w = in_ball(spin_);
    char text[512];
    std::snprintf(text, sizeof text, "%.6f,%.6f,%.6f,%.9f,%.9f,%.9f,%.9f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n", p.x(), p.y(),
                  p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
    return text;
}

std::string StateWriter::table(int count, const Vec3& center_of_mass) {
    std::string text = "x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
    for (int i = 0; i < count; ++i) text += row(center_of_mass);
    return text;
}

}  // namespace kolize::models
