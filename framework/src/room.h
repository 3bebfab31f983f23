// [[room]]: static walls around a box-shaped space.
#pragma once

#include <kolize/scene.h>

namespace kolize {

// What the walls are made of: "half_space", "box" or "mesh". `wanted` is [narrowphase] walls; "auto" takes the first of
// these that the narrowphase handles; half-spaces only around a single room, since they fill all space outside it.
// Throws std::invalid_argument if it handles none, or not the wanted one.
ShapeKind wall_kind(const std::string& wanted, std::uint32_t shape_kinds, std::size_t rooms);

// Adds one static body of kind "wall" for each side that is not open. Box and mesh walls overlap at the corners.
void add_walls(World& world, const Room& room, ShapeKind kind, std::size_t room_number);

// An open side does not bound.
bool inside(const Room& room, const Vec3& p);

}  // namespace kolize
