#include "tunnel_scene.h"

#include "tunnel_bodies.h"
#include "tunnel_path.h"

#include <kolize/mesh_io.h>
#include <kolize/simulation.h>

namespace kolize::tunnel {
namespace {

constexpr double half_cube = cube_side / 2;
constexpr double post_side = 2.4;                // m
constexpr double fighter_mass = 1000;            // kg
constexpr double missile_mass = 20;              // kg
const Vec3 acceleration(20, 15, 15);             // m/s^2, of the fighter at full thrust along the pilot's axes
const Vec3 angular_acceleration(3.0, 2.0, 2.0);  // rad/s^2

void add_materials(World& world) { world.materials = {{"hull", 0.4, 0, 1000}, {"loose", 0.8, 0, 3}}; }

std::uint32_t add_shape(World& world, Shape shape) {
    world.shapes.push_back(std::move(shape));
    return static_cast<std::uint32_t>(world.shapes.size() - 1);
}

// --- The fighter and its missiles ----------------------------------------------------------------------------------

TriangleSoup scaled_fighter(const std::filesystem::path& file) {
    TriangleSoup soup = read_mesh(file);
    Aabb box;
    for (const Vec3& vertex : soup.vertices) box.include(vertex);
    const double scale = fighter_length / (box.max.x() - box.min.x());
    for (Vec3& vertex : soup.vertices) vertex *= scale;
    return soup;
}

// 1.2 m long, nose towards +x.
TriangleSoup dart() {
    TriangleSoup soup;
    soup.vertices = {{0.8, 0, 0}, {-0.4, 0, 0}, {-0.2, 0.18, 0}, {-0.2, 0, 0.18}, {-0.2, -0.18, 0}, {-0.2, 0, -0.18}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t a = 2 + i, b = 2 + (i + 1) % 4;
        soup.triangles.push_back({0, a, b});
        soup.triangles.push_back({1, b, a});
    }
    return soup;
}

Engines engines_of(const World& world, std::uint32_t fighter) {
    const Shape& shape = world.shape_of(fighter);
    const Mat3 turn = shape.body_to_model.toRotationMatrix();
    Engines engines;
    engines.mass = 1 / world.inverse_mass[fighter];
    engines.inertia = engines.mass * (turn * shape.moments.asDiagonal() * turn.transpose()).diagonal();
    engines.max_force = engines.mass * acceleration;
    engines.max_torque = engines.inertia.cwiseProduct(angular_acceleration);
    return engines;
}

Quat start_orientation(const Cell& cell) {
    const Vec3 forward = cell.ahead.cast<double>();
    const Vec3 up = cell.ahead.y() == 0 ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitZ());
    Mat3 axes;
    axes << forward, up, forward.cross(up);
    return Quat(axes);
}

void add_fighter(TunnelScene& tunnel, const std::filesystem::path& file) {
    World& world = tunnel.scene.world;
    BodyDescription body;
    body.name = body.kind = "fighter";
    body.shape = add_shape(world, make_mesh("fighter", scaled_fighter(file)));
    body.material = hull;
    body.mass = fighter_mass;
    body.position = center_of(tunnel.tunnel.cells.front());
    body.orientation = start_orientation(tunnel.tunnel.cells.front());
    tunnel.fighter = world.add(body);
    tunnel.engines = engines_of(world, tunnel.fighter);
}

void add_missiles(TunnelScene& tunnel) {
    World& world = tunnel.scene.world;
    BodyDescription body;
    body.kind = "missile";
    body.shape = add_shape(world, make_mesh("missile", dart()));
    body.material = hull;
    body.mass = missile_mass;
    body.position = center_of(tunnel.tunnel.cells.front());
    for (std::uint32_t i = 0; i < missiles_at_once; ++i) {
        body.name = "missile." + std::to_string(i);
        tunnel.missiles.push_back(world.add(body));
        world.removed[tunnel.missiles.back()] = 1;
    }
}

// --- Walls ---------------------------------------------------------------------------------------------------------

Room room_of(const Cell& cell) {
    Room room;
    room.min = center_of(cell) - Vec3::Constant(half_cube);
    room.max = center_of(cell) + Vec3::Constant(half_cube);
    room.thickness = wall_thickness;
    room.material = hull;
    for (const Place& direction : openings(cell))
        for (int axis = 0; axis < 3; ++axis)
            if (direction[axis] != 0) room.open[2 * axis + (direction[axis] > 0)] = true;
    for (int axis = 0; axis < 3; ++axis) {
        if (!room.open[2 * axis]) room.min[axis] += wall_thickness;
        if (!room.open[2 * axis + 1]) room.max[axis] -= wall_thickness;
    }
    return room;
}

// At the inner corner of a turn the walls of the two neighbours meet in an edge only: a post stands there.
void add_post(const Cell& cell, World& world) {
    if (cell.type != CellType::left && cell.type != CellType::right) return;
    const std::vector<Place> open = openings(cell);
    const Vec3 corner = (open[0] + open[1]).cast<double>();
    BodyDescription body;
    body.name = "post of line " + std::to_string(cell.where.line);
    body.kind = "static";
    body.is_static = true;
    body.material = hull;
    body.position = center_of(cell) + half_cube * corner;
    Vec3 half = Vec3::Constant(half_cube);
    for (int axis = 0; axis < 3; ++axis)
        if (corner[axis] != 0) half[axis] = post_side / 2;
    body.shape = add_shape(world, make_box("post", half));
    world.add(body);
}

std::string described(const TunnelScene& tunnel, std::uint32_t body) {
    if (body == tunnel.fighter) return "the fighter";
    const auto found = tunnel.where.find(body);
    if (found == tunnel.where.end()) return "a wall";
    return "the body of line " + std::to_string(found->second.line) + ", column " +
           std::to_string(found->second.column);
}

}  // namespace

TunnelScene make_tunnel_scene(const Tunnel& tunnel, const Scene& base, const std::filesystem::path& fighter_file) {
    TunnelScene made;
    made.tunnel = tunnel;
    made.scene = base;
    made.scene.file = tunnel.file.string();
    World& world = made.scene.world;
    add_materials(world);
    add_fighter(made, fighter_file);
    add_missiles(made);
    for (const Cell& cell : tunnel.cells) {
        made.scene.rooms.push_back(room_of(cell));
        add_post(cell, world);
    }
    add_bodies(made);
    return made;
}

void require_apart(const TunnelScene& tunnel, const PluginLibrary& plugins, Host& host) {
    Scene still = tunnel.scene;
    still.pipeline.step.mode = "discrete";
    still.pipeline.step.dt = 1e-9;  // a step in which nothing moves to speak of: its contacts are those of the start
    still.pipeline.ledger.check = false;
    Simulation simulation(still, plugins, host, 1);
    simulation.step();
    if (simulation.contacts().rows.empty()) return;
    const Contact& first = simulation.contacts().rows.front();
    const auto found_a = tunnel.where.find(first.a), found_b = tunnel.where.find(first.b);
    const bool a_is_named = found_a != tunnel.where.end() && !tunnel.scene.world.is_static[first.a];
    const std::uint32_t here = a_is_named || found_b == tunnel.where.end() ? first.a : first.b;
    const auto where = tunnel.where.find(here);
    throw Error(where == tunnel.where.end() ? SourceLocation{tunnel.tunnel.file.string()} : where->second,
                described(tunnel, here) + " overlaps " + described(tunnel, here == first.a ? first.b : first.a) +
                    " at the start; only static bodies may overlap each other");
}

std::optional<std::size_t> cell_at(const Tunnel& tunnel, const Vec3& point) {
    if (!point.allFinite()) return {};
    for (std::size_t i = 0; i < tunnel.cells.size(); ++i)
        if ((point - center_of(tunnel.cells[i])).cwiseAbs().maxCoeff() <= half_cube) return i;
    return {};
}

BodyState placed(const World& world, std::uint32_t body, const Vec3& position, const Quat& orientation,
                 const Vec3& velocity) {
    const Shape& shape = world.shape_of(body);
    return {position + orientation * shape.center_in_model, (orientation * shape.body_to_model).normalized(), velocity,
            Vec3::Zero()};
}

}  // namespace kolize::tunnel
