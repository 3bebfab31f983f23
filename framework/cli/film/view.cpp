#include "view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kolize::cli {
namespace {

void include(Aabb& box, const Aabb& other) {
    if (!other.finite()) return;
    box.include(other.min);
    box.include(other.max);
}

// What there is to be seen: the rooms, or, where there is none, the bodies.
Aabb extent(const Scene& scene, const World& world) {
    Aabb box;
    for (const Room& room : scene.rooms) include(box, {room.min, room.max});
    for (std::uint32_t i = 0; scene.rooms.empty() && i < world.size(); ++i)
        if (!world.removed[i]) include(box, world_bounds(world, i));
    return box.finite() ? box : Aabb{Vec3::Constant(-1), Vec3::Constant(1)};
}

// Unit axes of whoever looks at the scene: x to the right, y up, z out of it.
Mat3 onlooker_axes(const World& world) {
    const Vec3& gravity = world.forces.gravity;
    const Vec3 up = gravity.norm() > 0 ? Vec3(-gravity.normalized()) : Vec3(Vec3::UnitY());
    const Vec3 towards = std::abs(up.z()) < 0.9 ? Vec3::UnitZ() : Vec3(-Vec3::UnitY());
    Mat3 axes;
    axes.col(1) = up;
    axes.col(2) = (towards - towards.dot(up) * up).normalized();
    axes.col(0) = axes.col(1).cross(axes.col(2));
    return axes;
}

// The place nearest to the box, in the onlooker's axes, from which a picture with these tangents of half its fields of
// view holds the whole box. With the eye at e, a corner p is between the left and the right border where
// |p.x - e.x| <= t (e.z - p.z): so e.z has to be (a + b) / 2 t at least, for a and b the largest of t p.z + p.x and
// t p.z - p.x, and is so at e.x = (a - b) / 2. Likewise for y.
Vec3 nearest_eye(const Vec3& half, const Mat3& axes, const std::array<double, 2>& tangents) {
    Vec3 eye(0, 0, -infinity);
    for (int side = 0; side < 2; ++side) {
        const double t = tangents[side];
        const double a = (axes.transpose().row(2) * t + axes.transpose().row(side)).cwiseAbs().dot(half);
        const double b = (axes.transpose().row(2) * t - axes.transpose().row(side)).cwiseAbs().dot(half);
        eye[side] = (a - b) / 2;
        eye.z() = std::max(eye.z(), (a + b) / (2 * t));
    }
    return eye;
}

// Looking down a little, from the right.
CameraConfig chosen_camera(const Aabb& box, const World& world, double aspect) {
    const Mat3 onlooker = onlooker_axes(world);
    Mat3 axes;
    axes.col(2) = (onlooker * Vec3(0.3, 0.34, 1)).normalized();
    axes.col(0) = onlooker.col(1).cross(axes.col(2)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    CameraConfig camera;
    camera.field_of_view = 0.8;
    camera.up = onlooker.col(1);
    const double tangent = std::tan(0.5 * camera.field_of_view) / 1.05;  // a narrow border stays free
    const Vec3 eye = nearest_eye(box.half_extents(), axes, {tangent * aspect, tangent});
    camera.eye = box.center() + axes * eye;
    camera.target = camera.eye - eye.z() * axes.col(2);
    return camera;
}

}  // namespace

Camera camera_of(const Scene& scene, const World& world, double aspect) {
    const Aabb box = extent(scene, world);
    const CameraConfig config = scene.render.camera ? *scene.render.camera : chosen_camera(box, world, aspect);
    const double reach = (config.eye - box.center()).norm() + box.half_extents().norm();
    return {config.eye, config.target, config.up, config.field_of_view, 5e-4 * reach, 20 * reach};
}

std::vector<Light> lights_of(const Scene& scene, const World& world) {
    if (!scene.render.lights.empty()) return scene.render.lights;
    const Aabb box = extent(scene, world);
    const double size = box.half_extents().norm();
    const Mat3 axes = onlooker_axes(world);
    Light key, fill;
    key.position = box.center() + size * (axes * Vec3(0.35, 0.5, 0.45));
    key.colour = {1.0, 0.95, 0.86};
    fill.position = box.center() + size * (axes * Vec3(-0.5, 0.3, 0.2));
    fill.colour = {0.38, 0.44, 0.55};
    key.range = fill.range = 2.6 * size;
    return {key, fill};
}

void take_explosions(const Simulation& simulation, double time, std::vector<Explosion>& explosions) {
    for (const Event& event : simulation.events())
        if (event.kind == EventKind::explosion)
            explosions.push_back({event.position, simulation.world().shape_of(event.body).radius, time});
}

}  // namespace kolize::cli
