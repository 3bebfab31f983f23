#include "mesh_io/vrml_spine.h"

#include <algorithm>

namespace kolize::mesh_io::vrml {

namespace {

constexpr double least_bend = 1e-6;  // rad

Vec3 direction(const Vec3& from, const Vec3& to) { return (to - from).stableNormalized(); }

// Where an axis is not defined it is that of the point before; before the first that is defined, that of the first.
void fill_gaps(std::vector<Vec3>& axes) {
    const auto first = std::find_if(axes.begin(), axes.end(), [](const Vec3& a) { return !a.isZero(0); });
    if (first == axes.end()) return;
    std::fill(axes.begin(), first, *first);
    for (auto axis = first + 1; axis != axes.end(); ++axis)
        if (axis->isZero(0)) *axis = *(axis - 1);
}

Mat3 turn_from_y(const Vec3& y) {
    if (y.isZero(0)) return Mat3::Identity();
    if (y.y() <= -1) return Vec3(-1, -1, 1).asDiagonal();  // half a turn, about z
    return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), y).toRotationMatrix();
}

Mat3 frame(const Vec3& y, const Vec3& z) {
    Vec3 x = y.cross(z).stableNormalized();
    if (x.isZero(0)) x = y.unitOrthogonal();
    Mat3 axes;
    axes << x, y, x.cross(y);
    return axes;
}

}  // namespace

std::vector<Mat3> spine_frames(const std::vector<Vec3>& spine) {
    const std::size_t n = spine.size();
    const bool closed = n > 2 && spine.front() == spine.back();
    std::vector<Vec3> along(n), normal(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3& before = i > 0 ? spine[i - 1] : closed ? spine[n - 2] : spine[0];
        const Vec3& after = i + 1 < n ? spine[i + 1] : closed ? spine[1] : spine[n - 1];
        along[i] = direction(before, after);
        const Vec3 bend = direction(spine[i], after).cross(direction(spine[i], before));
        normal[i] = bend.norm() > least_bend ? bend.normalized() : Vec3::Zero();
    }
    fill_gaps(along);
    fill_gaps(normal);
    if (normal[0].isZero(0)) return std::vector<Mat3>(n, turn_from_y(along[0]));
    std::vector<Mat3> frames;
    for (std::size_t i = 0; i < n; ++i) {
        if (i > 0 && normal[i].dot(normal[i - 1]) < 0) normal[i] = -normal[i];
        frames.push_back(frame(along[i], normal[i]));
    }
    return frames;
}

}  // namespace kolize::mesh_io::vrml
