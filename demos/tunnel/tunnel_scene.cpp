#include "tunnel_scene.h"

#include "tunnel_path.h"

#include <kolize/mesh_io.h>
#include <kolize/simulation.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace kolize::tunnel {
namespace {

constexpr double half_cube = cube_side / 2;
constexpr double post_side = 2.4;                // m
constexpr double ball_radius = 2;                // m
constexpr double fighter_mass = 1000;            // kg
constexpr double missile_mass = 20;              // kg
const Vec3 acceleration(20, 15, 15);             // m/s^2, of the fighter at full thrust along the pilot's axes
const Vec3 angular_acceleration(3.0, 2.0, 2.0);  // rad/s^2

enum MaterialId : std::uint32_t { hull, loose };

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

// --- Bodies --------------------------------------------------------------------------------------------------------

class BodyMaker {
public:
    explicit BodyMaker(TunnelScene& tunnel)
        : folder_(tunnel.tunnel.file.parent_path()), world_(tunnel.scene.world), where_(tunnel.where) {}

    void add(const Cell& cell, const PlacedBody& placed, bool is_static) {
        BodyDescription body;
        body.shape = shape_of(placed);
        const bool is_ball = world_.shapes[body.shape].kind == ShapeKind::sphere;
        body.name = placed.file + "." + std::to_string(where_.size());
        body.kind = is_static ? "static" : is_ball ? "ball" : "body";
        body.is_static = is_static;
        body.material = is_static ? hull : loose;
        body.position = center_of(cell) + half_cube * (cell.rotation * placed.position);
        body.orientation = Quat(cell.rotation) * placed.orientation;
        if (!is_static) body.angular_velocity = first_spin();
        const std::uint32_t made = world_.add(body);
        where_[made] = placed.where;
        require_inside(cell, placed, made);
    }

private:
    std::uint32_t shape_of(const PlacedBody& placed) {
        const auto [known, is_new] = shapes_.try_emplace(placed.file, static_cast<std::uint32_t>(world_.shapes.size()));
        if (!is_new) return known->second;
        if (placed.file == "ball") return add_shape(world_, make_sphere("ball", ball_radius));
        const std::filesystem::path file = folder_ / placed.file;
        std::error_code failure;
        if (!std::filesystem::is_regular_file(file, failure))
            throw Error(placed.where, "there is no mesh file " + file.string());
        try {
            return add_shape(world_, make_mesh(placed.file, read_mesh(file)));
        } catch (const std::invalid_argument& failure) {
            throw Error(placed.where, "'" + placed.file + "': " + failure.what());
        }
    }

    void require_inside(const Cell& cell, const PlacedBody& placed, std::uint32_t body) const {
        constexpr double rounding = 1e-9;
        const Aabb box = world_bounds(world_, body);
        const Vec3 center = center_of(cell);
        const double reach = std::max((box.max - center).maxCoeff(), (center - box.min).maxCoeff());
        if (!(reach <= half_cube * (1 + rounding)))
            throw Error(placed.where, "'" + placed.file + "' reaches out of its cell, " + std::to_string(reach) +
                                          " m from its centre; half a cube is " + std::to_string(half_cube) + " m");
    }

    // Slow tumbling about an axis of its own, the same in every flight: directions by the golden angle.
    Vec3 first_spin() {
        constexpr double golden_angle = 2.399963229728653, speed = 0.6;
        const double number = ++dynamics_;
        const double height = std::remainder(number * 0.754877666, 1.0) * 2, angle = number * golden_angle;
        const double radius = std::sqrt(std::max(0.0, 1 - height * height));
        return speed * Vec3(radius * std::cos(angle), height, radius * std::sin(angle));
    }

    std::filesystem::path folder_;
    World& world_;
    std::map<std::uint32_t, SourceLocation>& where_;
    std::map<std::string, std::uint32_t> shapes_;
    int dynamics_ = 0;
};

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
    BodyMaker bodies(made);
    for (const Cell& cell : tunnel.cells) {
        made.scene.rooms.push_back(room_of(cell));
        add_post(cell, world);
        for (const PlacedBody& body : cell.statics) bodies.add(cell, body, true);
        for (const PlacedBody& body : cell.dynamics) bodies.add(cell, body, false);
    }
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
