#include "bounding_volumes/local_points.h"

#include <kolize/bounding_volumes.h>
#include <kolize/error.h>

#include <algorithm>

namespace kolize {

void require_points(std::span<const Vec3> points) {
    if (points.empty()) throw Error("a bounding volume needs one point at least, there are none");
    constexpr double largest = 1e100;
    const auto usable = [&](const Vec3& p) { return (p.array().abs() <= largest).all(); };
    const auto bad = std::find_if_not(points.begin(), points.end(), usable);
    if (bad == points.end()) return;
    throw Error("the points of a bounding volume must be finite, from -1e100 to 1e100; point " +
                std::to_string(bad - points.begin()) + " is not");
}

LocalPoints local_points(std::span<const Vec3> points) {
    const Aabb box = bounding_box(points);
    LocalPoints local;
    local.origin = box.center();
    int exponent = 0;
    std::frexp((box.max - local.origin).cwiseMax(local.origin - box.min).maxCoeff(), &exponent);
    local.unit = std::ldexp(1.0, exponent);
    local.points.reserve(points.size());
    for (const Vec3& p : points) local.points.push_back((p - local.origin) / local.unit);
    return local;
}

}  // namespace kolize
