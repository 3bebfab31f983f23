#include "disagreement.h"

#include <algorithm>
#include <tuple>

namespace kolize::cli {
namespace {

Shape triangle_shape(const std::string& name, const Mesh& mesh, std::uint32_t triangle, const Transform& to_frame) {
    TriangleSoup soup;
    for (const std::uint32_t vertex : mesh.triangles[triangle])
        soup.vertices.push_back(to_frame * mesh.vertices[vertex]);
    soup.triangles = {{0, 1, 2}};
    Shape shape;
    shape.name = name;
    shape.kind = ShapeKind::mesh;
    shape.mesh = build_mesh(soup, false);
    shape.radius = shape.mesh->radius;
    shape.bounds = shape.mesh->bounds;
    shape.volume = 1;  // a capsule wants some; nothing here moves
    shape.moments = Vec3::Ones();
    return shape;
}

void add_surface(World& world, const std::string& name, const Shape& shape) {
    BodyDescription body;
    body.name = name;
    body.shape = static_cast<std::uint32_t>(world.shapes.size());
    body.is_static = true;
    world.shapes.push_back(shape);
    world.add(body);
}

// One that only one of the two lists has.
std::optional<TriangleHit> first_difference(const std::vector<TriangleHit>& x, const std::vector<TriangleHit>& y) {
    const auto before = [](const TriangleHit& i, const TriangleHit& j) {
        return std::tie(i.a, i.b) < std::tie(j.a, j.b);
    };
    std::vector<TriangleHit> difference;
    std::set_symmetric_difference(x.begin(), x.end(), y.begin(), y.end(), std::back_inserter(difference), before);
    if (difference.empty()) return std::nullopt;
    return difference.front();
}

bool still_differ(const World& world, const Witness& truth, const Witness& other, const PluginLibrary& library,
                  Host& host) {
    std::optional<bool> answers[2];
    const StageConfig* const configs[] = {&truth.config(), &other.config()};
    for (int i = 0; i < 2; ++i) {
        Witness again(*configs[i], library, host);
        again.prepare(world);
        answers[i] = again.surfaces_meet(world, {0, 1});
    }
    return answers[0] != answers[1];
}

}  // namespace

World two_bodies(const World& world, const Pair& pair) {
    World small;
    small.forces = world.forces;
    small.materials = world.materials;
    for (const std::uint32_t body : {pair.a, pair.b}) {
        const auto take = [&](auto& to, const auto& from) { to.push_back(from[body]); };
        take(small.position, world.position);
        take(small.orientation, world.orientation);
        take(small.velocity, world.velocity);
        take(small.angular_velocity, world.angular_velocity);
        take(small.inverse_mass, world.inverse_mass);
        take(small.inverse_inertia, world.inverse_inertia);
        take(small.constant_force, world.constant_force);
        take(small.constant_torque, world.constant_torque);
        take(small.material, world.material);
        take(small.is_static, world.is_static);
        take(small.removed, world.removed);
        take(small.asleep, world.asleep);
        take(small.is_reference, world.is_reference);
        take(small.name, world.name);
        small.kind.push_back(small.intern_kind(world.kinds[world.kind[body]]));
        small.shape.push_back(static_cast<std::uint32_t>(small.shapes.size()));
        small.shapes.push_back(world.shape_of(body));
    }
    return small;
}

std::optional<World> two_triangles(const World& world, const Pair& pair, Witness& truth, Witness& other,
                                   const PluginLibrary& library, Host& host) {
    const Shape &first = world.shape_of(pair.a), &second = world.shape_of(pair.b);
    if (!first.mesh || !second.mesh) return std::nullopt;
    if (first.kind == ShapeKind::box && second.kind == ShapeKind::box) return std::nullopt;  // not by triangles
    if (!truth.looks_at_triangles() || !other.looks_at_triangles()) return std::nullopt;
    const auto difference =
        first_difference(truth.meeting_triangles(world, pair), other.meeting_triangles(world, pair));
    if (!difference) return std::nullopt;
    const MeshPair meshes = mesh_pair(world, pair);
    World small;
    small.materials.push_back({});
    const std::string a = "triangle " + std::to_string(difference->a) + " of '" + world.shapes[meshes.shape_a].name;
    const std::string b = "triangle " + std::to_string(difference->b) + " of '" + world.shapes[meshes.shape_b].name;
    add_surface(small, a + "'", triangle_shape("a", meshes.a, difference->a, Transform{}));
    add_surface(small, b + "'", triangle_shape("b", meshes.b, difference->b, meshes.b_to_a));
    if (!still_differ(small, truth, other, library, host)) return std::nullopt;
    return small;
}

Scene smallest_scene(const World& world, const Pair& pair, Witness& truth, Witness& other, const PluginLibrary& library,
                     Host& host) {
    Scene scene;
    const std::optional<World> triangles = two_triangles(world, pair, truth, other, library, host);
    scene.world = triangles ? *triangles : two_bodies(world, pair);
    scene.pipeline.narrowphase = other.config();
    return scene;
}

}  // namespace kolize::cli
