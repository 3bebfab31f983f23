#include "tunnel_bodies.h"

#include <kolize/mesh_io.h>

#include <algorithm>
#include <cmath>

namespace kolize::tunnel {
namespace {

constexpr double half_cube = cube_side / 2;
constexpr double ball_radius = 2;  // m

// World bounds are those of a box that turns with the body; these hold the body itself.
Aabb tight_bounds(const World& world, std::uint32_t body) {
    const Mesh* mesh = world.shape_of(body).mesh.get();
    if (!mesh) return world_bounds(world, body);
    Aabb box;
    const Transform pose = world.pose(body);
    for (const Vec3& vertex : mesh->vertices) box.include(pose * vertex);
    return box;
}

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
        const std::uint32_t made = guarded(placed, [&] { return world_.add(body); });
        where_[made] = placed.where;
        require_inside(cell, placed, made);
    }

private:
    std::uint32_t add(Shape shape) {
        world_.shapes.push_back(std::move(shape));
        return static_cast<std::uint32_t>(world_.shapes.size() - 1);
    }

    std::uint32_t shape_of(const PlacedBody& placed) {
        const auto [known, is_new] = shapes_.try_emplace(placed.file, static_cast<std::uint32_t>(world_.shapes.size()));
        if (!is_new) return known->second;
        if (placed.file == "ball") return add(make_sphere("ball", ball_radius));
        const std::filesystem::path file = folder_ / placed.file;
        std::error_code failure;
        if (!std::filesystem::is_regular_file(file, failure))
            throw Error(placed.where, "there is no mesh file " + file.string());
        return guarded(placed, [&] { return add(make_mesh(placed.file, read_mesh(file))); });
    }

    // What the framework refuses is told with the place in the tunnel's file.
    template <class Function>
    static std::uint32_t guarded(const PlacedBody& placed, Function&& function) {
        try {
            return function();
        } catch (const std::invalid_argument& failure) {
            throw Error(placed.where, "'" + placed.file + "': " + failure.what());
        }
    }

    void require_inside(const Cell& cell, const PlacedBody& placed, std::uint32_t body) const {
        constexpr double rounding = 1e-9;
        const Aabb box = tight_bounds(world_, body);
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

}  // namespace

void add_bodies(TunnelScene& tunnel) {
    BodyMaker bodies(tunnel);
    for (const Cell& cell : tunnel.tunnel.cells) {
        for (const PlacedBody& body : cell.statics) bodies.add(cell, body, true);
        for (const PlacedBody& body : cell.dynamics) bodies.add(cell, body, false);
    }
}

}  // namespace kolize::tunnel
