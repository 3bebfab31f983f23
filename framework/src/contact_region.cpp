#include "contact_region.h"

namespace kolize {

ContactRegion ContactRegion::single(const Vec3& normal, const Vec3& point, double depth) {
    ContactRegion region;
    region.normal = normal;
    region.center = region.points[0] = point;
    region.depth = region.depths[0] = depth;
    region.count = 1;
    return region;
}

ContactRegion swapped(const ContactRegion& region, const Vec3& b) {
    ContactRegion other = region;
    other.normal = -region.normal;
    other.center -= b;
    for (int i = 0; i < region.count; ++i) other.points[i] -= b;
    return other;
}

namespace {

template <class Score>
std::uint32_t best_index(std::size_t count, Score&& score) {
    std::uint32_t best = 0;
    double best_score = -infinity;
    for (std::uint32_t i = 0; i < count; ++i)
        if (const double s = score(i); s > best_score) {
            best = i;
            best_score = s;
        }
    return best;
}

}  // namespace

std::span<const std::uint32_t> spread_points(std::span<const Vec3> points, std::array<std::uint32_t, 4>& chosen) {
    if (points.size() <= 4) {
        for (std::uint32_t i = 0; i < points.size(); ++i) chosen[i] = i;
        return {chosen.data(), points.size()};
    }
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : points) mean += p;
    mean /= static_cast<double>(points.size());

    const auto n = points.size();
    chosen[0] = best_index(n, [&](auto i) { return (points[i] - mean).squaredNorm(); });
    const Vec3& p0 = points[chosen[0]];
    chosen[1] = best_index(n, [&](auto i) { return (points[i] - p0).squaredNorm(); });
    const Vec3 line = points[chosen[1]] - p0;
    const auto offset = [&](auto i) -> Vec3 {
        return line.cross(points[i] - p0);
    };  // grows with the distance from the line
    chosen[2] = best_index(n, [&](auto i) { return offset(i).squaredNorm(); });
    const Vec3 side = offset(chosen[2]);
    chosen[3] = best_index(n, [&](auto i) { return -side.dot(offset(i)); });
    const bool fourth_is_new = side.dot(offset(chosen[3])) < 0;
    return {chosen.data(), fourth_is_new ? 4u : 3u};
}

}  // namespace kolize
