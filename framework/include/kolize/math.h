// Small linear algebra shared by every stage: Eigen types whose layout does not depend on compiler flags.
//
// Units are SI, axes right-handed. Quaternions are unit, Hamilton, body to world.
// Eigen::Vector3d and Matrix3d are never over-aligned; Quaterniond is (16 bytes, or 32 with AVX), so
// quaternions are stored unaligned: anything in this header may cross the plugin boundary.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace kolize {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

// A closed axis-aligned box: boxes that only touch do overlap.
struct Aabb {
    Vec3 min = Vec3::Constant(infinity);
    Vec3 max = Vec3::Constant(-infinity);

    void include(const Vec3& p) {
        min = min.cwiseMin(p);
        max = max.cwiseMax(p);
    }
    bool overlaps(const Aabb& o) const {
        return (min.array() <= o.max.array()).all() && (o.min.array() <= max.array()).all();
    }
    Vec3 center() const { return 0.5 * (min + max); }
    Vec3 half_extents() const { return 0.5 * (max - min); }
    bool finite() const { return min.allFinite() && max.allFinite(); }
};

// A rigid placement: maps a point p of the local frame to rotation * p + translation.
struct Transform {
    Mat3 rotation = Mat3::Identity();
    Vec3 translation = Vec3::Zero();

    Vec3 operator*(const Vec3& p) const { return rotation * p + translation; }
    Transform inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
};

}  // namespace kolize
