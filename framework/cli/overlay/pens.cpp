#include "overlay/pens.h"

#include <numbers>

namespace kolize::cli {

// The twelve edges; of a flat box the four of its rectangle.
void draw_box(const Aabb& box, const Rgba& colour, std::vector<Line>& lines) {
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (box.min[axis] == box.max[axis]) continue;
        for (int side = 0; side < 4; ++side) {
            const bool upper_u = side % 2, upper_v = side / 2;
            if ((upper_u && box.min[u] == box.max[u]) || (upper_v && box.min[v] == box.max[v])) continue;
            Vec3 from = box.min;
            from[u] = upper_u ? box.max[u] : box.min[u];
            from[v] = upper_v ? box.max[v] : box.min[v];
            Vec3 to = from;
            to[axis] = box.max[axis];
            lines.push_back({from, to, colour});
        }
    }
}

void draw_ball(const Vec3& center, double radius, const Rgba& colour, std::vector<Line>& lines) {
    constexpr int parts = 32;
    for (int axis = 0; axis < 3; ++axis) {
        const auto point = [&](int i) {
            const double angle = 2 * std::numbers::pi * i / parts;
            Vec3 p = center;
            p[(axis + 1) % 3] += radius * std::cos(angle);
            p[(axis + 2) % 3] += radius * std::sin(angle);
            return p;
        };
        for (int i = 0; i < parts; ++i) lines.push_back({point(i), point((i + 1) % parts), colour});
    }
}

void draw_point(const Vec3& point, double size, const Rgba& colour, std::vector<Line>& lines) {
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 arm = size * Vec3::Unit(axis);
        lines.push_back({point - arm, point + arm, colour});
    }
}

void draw_arrow(const Vec3& from, const Vec3& way, const Rgba& colour, std::vector<Line>& lines) {
    const Vec3 to = from + way;
    lines.push_back({from, to, colour});
    const Vec3 aside = 0.12 * way.norm() * way.unitOrthogonal(), other = way.normalized().cross(aside);
    for (const Vec3& barb : {aside, other, Vec3(-aside), Vec3(-other)})
        lines.push_back({to, to - 0.25 * way + barb, colour});
}

// Okabe and Ito, Color Universal Design (2008), without black.
Rgba colour_of(std::size_t number) {
    static constexpr Rgba colours[] = {{230, 159, 0, 255},  {86, 180, 233, 255}, {0, 158, 115, 255},
                                       {240, 228, 66, 255}, {0, 114, 178, 255},  {213, 94, 0, 255},
                                       {204, 121, 167, 255}};
    return colours[number % std::size(colours)];
}

}  // namespace kolize::cli
