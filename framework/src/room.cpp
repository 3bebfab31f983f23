#include "room.h"

#include <stdexcept>

namespace kolize {

ShapeKind wall_kind(const std::string& wanted, std::uint32_t shape_kinds, std::size_t rooms) {
    for (const ShapeKind kind : {ShapeKind::half_space, ShapeKind::box, ShapeKind::mesh}) {
        const bool fits_all_rooms = kind != ShapeKind::half_space || rooms < 2;
        if ((shape_kinds & bit(kind)) && ((wanted == "auto" && fits_all_rooms) || wanted == to_string(kind)))
            return kind;
    }
    throw std::invalid_argument("takes no walls made of " + (wanted == "auto" ? "half_space, box or mesh" : wanted));
}

namespace {

constexpr const char* side_names[6] = {"-x", "+x", "-y", "+y", "-z", "+z"};

// The solid behind one side, in world coordinates. It covers the corners towards other walls, and ends where a side is
// open: what is beyond belongs to somebody else.
struct Slab {
    Vec3 center;
    Vec3 half;
    Vec3 inward;
};

Slab slab_of(const Room& room, int side) {
    const int axis = side / 2;
    const bool upper = side % 2;
    const double t = room.thickness;
    Slab slab{0.5 * (room.min + room.max), 0.5 * (room.max - room.min) + Vec3::Constant(t), Vec3::Zero()};
    for (int other = 0; other < 6; ++other) {
        if (!room.open[other]) continue;
        slab.half[other / 2] -= 0.5 * t;
        slab.center[other / 2] += other % 2 ? -0.5 * t : 0.5 * t;
    }
    slab.center[axis] = upper ? room.max[axis] + 0.5 * t : room.min[axis] - 0.5 * t;
    slab.half[axis] = 0.5 * t;
    slab.inward[axis] = upper ? -1 : 1;
    return slab;
}

Shape wall_shape(const std::string& name, const Slab& slab, ShapeKind kind) {
    switch (kind) {
    case ShapeKind::half_space: return make_half_space(name, slab.inward, 0);
    case ShapeKind::box: return make_box(name, slab.half);
    default: return make_mesh(name, box_soup(slab.half));
    }
}

constexpr const char* wall_word = "wall";
constexpr const char* name_prefix = "room ";

}  // namespace

void add_walls(World& world, const Room& room, ShapeKind kind, std::size_t room_number) {
    for (int side = 0; side < 6; ++side) {
        if (room.open[side]) continue;
        const Slab slab = slab_of(room, side);
        BodyDescription wall;
        wall.name = name_prefix + std::to_string(room_number) + " " + side_names[side];
        wall.kind = wall_word;
        wall.is_static = true;
        wall.material = room.material;
        wall.shape = static_cast<std::uint32_t>(world.shapes.size());
        world.shapes.push_back(wall_shape(wall.name, slab, kind));
        const double to_surface = slab.half.cwiseProduct(slab.inward).sum() * slab.inward.sum();
        wall.position = kind == ShapeKind::half_space ? Vec3(slab.center + to_surface * slab.inward) : slab.center;
        world.add(wall);
    }
}

bool is_room_wall(const World& world, std::uint32_t body) {
    return world.is_static[body] && world.kinds[world.kind[body]] == wall_word &&
           world.name[body].starts_with(name_prefix);
}

bool inside(const Room& room, const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
        const bool low = room.open[2 * axis] || p[axis] >= room.min[axis];
        const bool high = room.open[2 * axis + 1] || p[axis] <= room.max[axis];
        if (!low || !high) return false;
    }
    return true;
}

}  // namespace kolize
