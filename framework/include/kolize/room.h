// A room: static walls around a box-shaped space.
#pragma once

#include <kolize/world.h>

#include <array>

namespace kolize {

// Open sides have no wall.
struct Room {
    Vec3 min = Vec3::Zero();  // m
    Vec3 max = Vec3::Zero();
    double thickness = 1;  // m; used where walls are boxes
    std::uint32_t material = 0;
    std::array<bool, 6> open{};  // -x +x -y +y -z +z
};

// Whether the body is one of the walls that a simulation made of its rooms.
KOLIZE_API bool is_room_wall(const World& world, std::uint32_t body);

}  // namespace kolize
