// Cutting polygons into triangles.
#pragma once

#include <kolize/mesh.h>

#include <span>

namespace kolize::mesh_io {

// Cuts a polygon of three corners or more into triangles around its first corner.
void add_fan(std::vector<Triangle>& triangles, std::span<const std::uint32_t> corners);

// add_ears takes time that may grow with the square of the corners; so many take a second at most.
inline constexpr std::size_t max_ear_corners = 20'000;

// The same for a polygon that may be concave. `corners` index `points`; the polygon should be about flat. Whatever it
// is like, it becomes two triangles less than it has corners, and every side of it is the side of one of them: a closed
// surface stays closed. Those of a simple polygon do not overlap.
void add_ears(std::vector<Triangle>& triangles, std::span<const Vec3> points, std::span<const std::uint32_t> corners);

// A fan, or ears if the fan would fold over itself. Corners that are not among `points` yet make it a fan in any case.
void add_polygon(std::vector<Triangle>& triangles, std::span<const Vec3> points,
                 std::span<const std::uint32_t> corners);

}  // namespace kolize::mesh_io
