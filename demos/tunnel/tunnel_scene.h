// A tunnel as a scene: walls, bodies, the fighter and its missiles.
//
// Sides of cubes are 40 m. The walls of a cell stand inside its own cube, so that the cubes are what the grid
// broadphase files bodies by when its cells are as large: only bodies of neighbouring cubes are tested against each
// other.
#pragma once

#include "flight.h"
#include "tunnel_file.h"

#include <kolize/scene.h>

#include <map>
#include <optional>

namespace kolize::tunnel {

inline constexpr double cube_side = 40;      // m
inline constexpr double wall_thickness = 1;  // m
inline constexpr double fighter_length = 9;  // m
inline constexpr std::uint32_t missiles_at_once = 12;

struct TunnelScene {
    Tunnel tunnel;
    Scene scene;
    std::uint32_t fighter = 0;
    std::vector<std::uint32_t> missiles;  // removed until they are fired
    Engines engines;
    std::map<std::uint32_t, SourceLocation> where;  // of the bodies that the file names
};

// `base` gives pipeline, forces and renderer; its world is otherwise empty. Kinds of bodies: fighter, missile, ball,
// body, static. Throws Error for body files that are missing or not closed, and for bodies that reach out of their
// cells.
TunnelScene make_tunnel_scene(const Tunnel& tunnel, const Scene& base, const std::filesystem::path& fighter_file);

// Throws Error for a dynamic body of the file, or the fighter, that overlaps something at the start.
void require_apart(const TunnelScene& scene, const PluginLibrary& plugins, Host& host);

// Centre of a cell, world frame, m.
inline Vec3 center_of(const Cell& cell) {
    return cube_side * cell.place.cast<double>() + Vec3::Constant(cube_side / 2);
}

// The number of the cell in whose cube the point is, counted in the order of flight; none outside all of them.
std::optional<std::size_t> cell_at(const Tunnel& tunnel, const Vec3& point);

// The pilot's axes of a body, to world: those of its model.
inline Quat axes_of(const World& world, std::uint32_t body) { return world.model_orientation(body); }

// State of a body whose model frame stands like this.
BodyState placed(const World& world, std::uint32_t body, const Vec3& position, const Quat& orientation,
                 const Vec3& velocity);

}  // namespace kolize::tunnel
