// Solids, marks and arrows made of lines.
#pragma once

#include <kolize/renderer.h>

#include <vector>

namespace kolize::cli {

void draw_box(const Aabb& box, const Rgba& colour, std::vector<Line>& lines);
// Three circles about the axes.
void draw_ball(const Vec3& center, double radius, const Rgba& colour, std::vector<Line>& lines);
// A cross of this half size.
void draw_point(const Vec3& point, double size, const Rgba& colour, std::vector<Line>& lines);
void draw_arrow(const Vec3& from, const Vec3& way, const Rgba& colour, std::vector<Line>& lines);

// The colours of levels, loops and the like: number after number, told apart easily.
Rgba colour_of(std::size_t number);

}  // namespace kolize::cli
