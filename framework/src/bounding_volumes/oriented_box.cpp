#include "bounding_volumes/box_search.h"
#include "bounding_volumes/local_points.h"

#include <kolize/bounding_volumes.h>
#include <kolize/mass_properties.h>

#include <algorithm>
#include <array>

namespace kolize {

namespace {

Mat3 principal_axes(const std::vector<Vec3>& points) {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    Mat3 covariance = Mat3::Zero();
    for (const Vec3& p : points) covariance += (p - mean) * (p - mean).transpose();
    return principal_frame(covariance).axes.toRotationMatrix();
}

// The same box with its longest axis first, and the largest component of the first two axes positive: what the search
// happened to come from does not show.
OrientedBox in_canonical_order(const OrientedBox& box) {
    std::array<int, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return box.half_extents[a] > box.half_extents[b]; });
    OrientedBox result = box;
    for (int i = 0; i < 3; ++i) {
        Vec3 axis = box.axes.col(order[i]);
        int largest = 0;
        axis.cwiseAbs().maxCoeff(&largest);
        if (axis[largest] < 0) axis = -axis;
        result.axes.col(i) = axis;
        result.half_extents[i] = box.half_extents[order[i]];
    }
    if (result.axes.determinant() < 0) result.axes.col(2) *= -1;
    return result;
}

// Measured from the centre as it is rounded to the frame of the points.
OrientedBox box_with_axes(const Mat3& axes, const LocalPoints& local, std::span<const Vec3> points) {
    Aabb box;
    for (const Vec3& p : local.points) box.include(axes.transpose() * p);
    OrientedBox result{local.origin + local.unit * (axes * box.center()), axes, Vec3::Zero()};
    for (const Vec3& p : points)
        result.half_extents = result.half_extents.cwiseMax((axes.transpose() * (p - result.center)).cwiseAbs());
    return result;
}

}  // namespace

OrientedBox principal_box(std::span<const Vec3> points) {
    const LocalPoints local = local_points(points);
    return box_with_axes(principal_axes(local.points), local, points);
}

OrientedBox oriented_box(std::span<const Vec3> points) {
    const LocalPoints local = local_points(points);
    const std::array<Mat3, 2> starts{Mat3::Identity(), principal_axes(local.points)};
    const BoxAxes found = search_box(starts, outermost(local.points));
    // The search has not seen all points: what it found is fitted to them before it is compared.
    BoxAxes best = measured(starts[0], local.points);
    for (const BoxAxes& box :
         {measured(starts[1], local.points), turned_about_axes(measured(found.axes, local.points), local.points)})
        if (box.smaller_than(best)) best = box;
    return in_canonical_order(box_with_axes(best.axes, local, points));
}

}  // namespace kolize
