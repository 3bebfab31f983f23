#include "bounding_volumes/box_search.h"

#include "bounding_volumes/smallest_rectangle.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace kolize {

namespace {

// Axes along a unit vector and, as far as possible, a second vector.
Mat3 axes_along(const Vec3& first, const Vec3& second) {
    Mat3 axes;
    axes.col(0) = first;
    axes.col(2) = first.cross(second).normalized();
    axes.col(1) = axes.col(2).cross(first).normalized();
    return axes;
}

// The smallest box with its first axis along a unit vector.
BoxAxes box_about(const Vec3& axis, std::span<const Vec3> points) {
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
    std::vector<Vec2> shadow;
    shadow.reserve(points.size());
    for (const Vec3& p : points) shadow.emplace_back(u.dot(p), v.dot(p));
    const Vec2 side = smallest_rectangle_side(shadow);
    return measured(axes_along(axis, side.x() * u + side.y() * v), points);
}

Mat3 next_axis_first(const Mat3& axes) {
    Mat3 cycled;
    cycled << axes.col(1), axes.col(2), axes.col(0);
    return cycled;
}

// Replaces the box by improve(box), with each of its axes first in turn, until no axis gives a smaller box. The number
// of turns is bounded, since the steps may become small without end: on a finely cut cylinder, thousands of them.
template <class Improve>
BoxAxes improved_in_turn(BoxAxes box, const Improve& improve) {
    constexpr int most_turns = 12;
    int in_vain = 0;
    for (int turn = 0; turn < most_turns && in_vain < 3; ++turn) {
        box.axes = next_axis_first(box.axes);
        const BoxAxes next = improve(box);
        in_vain = next.smaller_than(box) ? 0 : in_vain + 1;
        if (in_vain == 0) box = next;
    }
    return box;
}

// The smallest of the boxes whose first axis is tilted a little, eight ways.
BoxAxes best_tilt(const BoxAxes& box, double tilt, std::span<const Vec3> points) {
    BoxAxes best = box;
    for (int way = 0; way < 8; ++way) {
        const double angle = way * std::numbers::pi / 4;
        const Vec3 aside = std::cos(angle) * box.axes.col(1) + std::sin(angle) * box.axes.col(2);
        const BoxAxes tilted = box_about((box.axes.col(0) + tilt * aside).normalized(), points);
        if (tilted.smaller_than(best)) best = tilted;
    }
    return best;
}

// Compass search for the first axis (Kolda, Lewis & Torczon, SIAM Review 45(3), 2003): the volume has a kink wherever
// the hull's edges change places, so there is no gradient to follow.
BoxAxes tilted_first_axis(BoxAxes box, std::span<const Vec3> points) {
    constexpr int most_moves = 1000;  // 27 of them halve the tilt
    double tilt = 0.1;
    for (int moves = 0; tilt > 1e-9 && moves < most_moves; ++moves) {
        const BoxAxes next = best_tilt(box, tilt, points);
        if (next.smaller_than(box))
            box = next;
        else
            tilt /= 2;
    }
    return box;
}

// Directions spread evenly over half of the sphere, on a spiral by the golden angle (Gonzalez, Math. Geosciences 42,
// 2010).
std::vector<Vec3> spread_directions(int count) {
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
    std::vector<Vec3> directions;
    for (int i = 0; i < count; ++i) {
        const double z = (i + 0.5) / count, r = std::sqrt(1 - z * z);
        directions.emplace_back(r * std::cos(turn * i), r * std::sin(turn * i), z);
    }
    return directions;
}

// Two far points, the one farthest from their line, and the farthest on each side of the plane of these three: the
// ditetrahedron of Larsson & Kallberg, "Fast computation of tight-fitting oriented bounding boxes", Game Engine Gems 2,
// 2011.
std::array<Vec3, 5> ditetrahedron(std::span<const Vec3> points) {
    const auto farthest = [&](const auto& distance) {
        return *std::max_element(points.begin(), points.end(),
                                 [&](const Vec3& a, const Vec3& b) { return distance(a) < distance(b); });
    };
    const Vec3 a = farthest([&](const Vec3& p) { return (p - points[0]).squaredNorm(); });
    const Vec3 b = farthest([&](const Vec3& p) { return (p - a).squaredNorm(); });
    const Vec3 c = farthest([&](const Vec3& p) { return (p - a).cross(b - a).squaredNorm(); });
    const Vec3 normal = (b - a).cross(c - a);
    const Vec3 d = farthest([&](const Vec3& p) { return normal.dot(p); });
    const Vec3 e = farthest([&](const Vec3& p) { return -normal.dot(p); });
    return {a, b, c, d, e};
}

// Faces of a small box lie along edges of the hull, so normals to two long edges are likely axes. For a flat set they
// hold its normal, and the first edge is the line of a straight set.
std::vector<Vec3> edge_directions(std::span<const Vec3> points) {
    const std::array<Vec3, 5> corners = ditetrahedron(points);
    std::vector<Vec3> edges;
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = i + 1; j < corners.size(); ++j)
            if (const double length = (corners[j] - corners[i]).norm(); length > least_extent)
                edges.push_back((corners[j] - corners[i]) / length);
    std::vector<Vec3> directions(edges.begin(), edges.begin() + !edges.empty());
    for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t j = i + 1; j < edges.size(); ++j) {
            const Vec3 normal = edges[i].cross(edges[j]);
            if (const double length = normal.norm(); length > least_extent) directions.push_back(normal / length);
        }
    return directions;
}

}  // namespace

BoxAxes measured(const Mat3& axes, std::span<const Vec3> points) {
    Aabb box;
    for (const Vec3& p : points) box.include(axes.transpose() * p);
    return {axes, (box.max - box.min).cwiseMax(least_extent).prod()};
}

BoxAxes turned_about_axes(const BoxAxes& box, std::span<const Vec3> points) {
    return improved_in_turn(box, [&](const BoxAxes& b) { return box_about(b.axes.col(0), points); });
}

std::vector<Vec3> outermost(std::span<const Vec3> points) {
    constexpr int directions = 256;
    if (points.size() <= 2 * directions) return {points.begin(), points.end()};
    std::vector<Vec3> chosen;
    for (const Vec3& direction : spread_directions(directions)) {
        const auto nearer = [&](const Vec3& a, const Vec3& b) { return direction.dot(a) < direction.dot(b); };
        const auto [low, high] = std::minmax_element(points.begin(), points.end(), nearer);
        chosen.push_back(*low);
        chosen.push_back(*high);
    }
    return chosen;
}

BoxAxes search_box(std::span<const Mat3> starts, std::span<const Vec3> points) {
    BoxAxes best;
    const auto consider = [&](const BoxAxes& start) {
        const BoxAxes box = turned_about_axes(start, points);
        if (box.smaller_than(best)) best = box;
    };
    for (const Mat3& axes : starts) consider(measured(axes, points));
    for (const Vec3& direction : edge_directions(points)) consider(box_about(direction, points));
    for (const Vec3& direction : spread_directions(64)) consider(box_about(direction, points));
    return improved_in_turn(best, [&](const BoxAxes& box) { return tilted_first_axis(box, points); });
}

}  // namespace kolize
