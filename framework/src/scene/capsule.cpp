// [capsule]: the columns of a world as they were, bit for bit. Nothing here may round: no mass from a density, no frame
// changed, no quaternion normalised.
#include "exact_numbers.h"
#include "parts.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <stdexcept>

namespace kolize::config {
namespace {

constexpr Range share{0, 1};

Forces read_forces(const toml::table& capsule) {
    TableReader reader(table(capsule, "forces"), "[capsule.forces]");
    ExactNumbers exact(reader);
    const Forces forces{exact.vector("gravity"), exact.vector("wind"), exact.number("drag", non_negative)};
    reader.finish();
    return forces;
}

Material read_material(const toml::table& table) {
    TableReader reader(table, "[[capsule.material]]");
    ExactNumbers exact(reader);
    const Material material{reader.text("name", ""), exact.number("restitution", share),
                            exact.number("friction", non_negative), exact.number("density", positive)};
    reader.finish();
    return material;
}

Shape read_mesh(TableReader& reader, ExactNumbers& exact, const std::string& name) {
    TriangleSoup soup;
    soup.vertices = exact.vectors("vertices");
    soup.triangles = exact.triangles("triangles", soup.vertices.size());
    const bool closed = reader.boolean("closed", true);
    const MeshDefects defects = inspect(soup);
    if (defects.empty || (closed && (defects.open_edges || defects.non_manifold_edges || defects.misoriented_edges)))
        reader.refuse("triangles", "must be the closed surface of a solid, but " + defects.first);
    Shape shape;
    shape.name = name;
    shape.kind = ShapeKind::mesh;
    shape.mesh = build_mesh(soup, closed);
    shape.radius = shape.mesh->radius;
    shape.bounds = shape.mesh->bounds;
    return shape;
}

Shape read_half_space(TableReader& reader, ExactNumbers& exact, const std::string& name) {
    const Vec3 normal = exact.vector("normal");
    if (!(std::abs(normal.norm() - 1) <= 1e-3)) reader.refuse("normal", "must have the length 1");
    Shape shape = make_half_space(name, normal, 0);
    shape.normal = normal;
    return shape;
}

Shape read_geometry(TableReader& reader, ExactNumbers& exact) {
    const std::string name = reader.text("name", "");
    reader.require("kind");
    const std::string kind = reader.choice("kind", "", {"sphere", "box", "half_space", "capsule", "hull", "mesh"});
    if (kind == "sphere") return make_sphere(name, exact.number("radius", positive));
    if (kind == "box") return make_box(name, exact.vector("half_extents", positive));
    if (kind == "capsule") return make_capsule(name, exact.number("radius", positive), exact.number("half_height"));
    if (kind == "half_space") return read_half_space(reader, exact, name);
    Shape shape = read_mesh(reader, exact, name);
    if (kind == "hull") shape.kind = ShapeKind::hull;
    return shape;
}

Shape read_shape(const toml::table& table) {
    TableReader reader(table, "[[capsule.shape]]");
    ExactNumbers exact(reader);
    Shape shape = read_geometry(reader, exact);
    shape.center_in_model = exact.vector("center_in_model");
    shape.body_to_model = exact.unit_quaternion("body_to_model");
    if (shape.kind != ShapeKind::half_space) {
        shape.volume = exact.number("volume", positive);
        shape.moments = exact.vector("moments", positive);
    }
    reader.finish();
    return shape;
}

std::uint32_t read_index(TableReader& reader, const std::string& key, std::size_t count) {
    reader.require(key);
    const std::int64_t index = reader.integer(key, 0);
    if (index < 0 || index >= static_cast<std::int64_t>(count))
        reader.refuse(
            key, "must be a number below " + std::to_string(count) + ", counted from 0, is " + std::to_string(index));
    return static_cast<std::uint32_t>(index);
}

// A static body has no velocity, and as its inverse mass and inertia 0; of any other the inverses can be inverted.
void read_motion(TableReader& reader, World& world, bool is_static) {
    ExactNumbers exact(reader);
    const double least = 1 / std::numeric_limits<double>::max();
    const Range inertia = is_static ? Range{0, 0} : Range{least, infinity, true};
    const Range speed = is_static ? Range{0, 0} : Range{};
    world.inverse_mass.push_back(exact.number("inverse_mass", inertia));
    world.inverse_inertia.push_back(exact.vector("inverse_inertia", inertia));
    world.position.push_back(exact.vector("position"));
    world.orientation.push_back(exact.unit_quaternion("orientation"));
    world.velocity.push_back(exact.vector("velocity", speed));
    world.angular_velocity.push_back(exact.vector("angular_velocity", speed));
    world.constant_force.push_back(exact.vector("force"));
    world.constant_torque.push_back(exact.vector("torque"));
}

void read_body(const toml::table& table, World& world) {
    TableReader reader(table, "[[capsule.body]]");
    world.name.push_back(reader.text("name", ""));
    world.shape.push_back(read_index(reader, "shape", world.shapes.size()));
    world.material.push_back(read_index(reader, "material", world.materials.size()));
    world.kind.push_back(world.intern_kind(reader.text("kind", "")));
    const bool is_static = reader.boolean("static", false);
    if (!is_static && world.shapes[world.shape.back()].kind == ShapeKind::half_space)
        reader.refuse("shape", "is a half_space, which only a static body can have");
    world.is_static.push_back(is_static);
    world.removed.push_back(reader.boolean("removed", false));
    world.asleep.push_back(reader.boolean("asleep", false));
    world.is_reference.push_back(reader.boolean("reference", false));
    read_motion(reader, world, is_static);
    reader.finish();
}

// Where its walls are bodies already, what is left of it says who has escaped.
Room read_room(const toml::table& table, bool has_walls, const World& world) {
    TableReader reader(table, "[[capsule.room]]");
    ExactNumbers exact(reader);
    Room room;
    room.min = exact.vector("min");
    room.max = exact.vector("max");
    room.open = read_open_sides(reader);
    if (!has_walls) {
        room.thickness = exact.number("thickness", positive);
        room.material = read_index(reader, "material", world.materials.size());
    }
    if (!(room.min.array() < room.max.array()).all()) reader.refuse("max", "must be greater than min on every axis");
    reader.finish();
    return room;
}

ResponseMemory read_memory(const toml::table& table) {
    TableReader reader(table, "[[capsule.memory]]");
    ResponseMemory memory{reader.text("plugin", ""), {}};
    const std::string text = reader.text("words", "");
    const SourceLocation where = reader.where("words");
    reader.finish();
    std::istringstream stream(text);
    for (std::string word; stream >> word;) {
        const char* const end = word.data() + word.size();
        const auto [stop, error] = std::from_chars(word.data(), end, memory.words.emplace_back(), 16);
        if (error != std::errc() || stop != end)
            throw Error(where, "words must be hexadecimal numbers of 64 bits, one is '" + word + "'");
    }
    return memory;
}

void refuse_world(const toml::table& config) {
    for (const char* other : {"world", "material", "shape", "body", "room"})
        if (const toml::node* node = config.get(other))
            throw Error(location(*node),
                        std::string("a capsule has its world in [capsule], and no table '") + other + "'");
}

// Nothing for a scene that has not begun: its rooms are given walls yet.
std::optional<std::uint64_t> read_head(const toml::table& capsule) {
    TableReader reader(capsule, "[capsule]");
    reader.require("step");
    const bool has_walls = reader.boolean("walls", true);
    const std::int64_t step = reader.integer("step", 0, {0, has_walls ? 1e15 : 0});
    for (const char* told : {"scene", "reason"}) reader.text(told, "");
    for (const char* part : {"forces", "material", "shape", "body", "room", "memory"}) reader.has(part);
    reader.finish();
    if (!has_walls) return std::nullopt;
    return static_cast<std::uint64_t>(step);
}

}  // namespace

void read_capsule(const toml::table& config, Scene& scene) {
    refuse_world(config);
    const toml::table& capsule = table(config, "capsule");
    scene.capsule_step = read_head(capsule);
    World& world = scene.world;
    world.forces = read_forces(capsule);
    for (const toml::table* part : tables(capsule, "material")) world.materials.push_back(read_material(*part));
    for (const toml::table* part : tables(capsule, "shape")) world.shapes.push_back(read_shape(*part));
    for (const toml::table* part : tables(capsule, "body")) read_body(*part, world);
    for (const toml::table* part : tables(capsule, "room"))
        scene.rooms.push_back(read_room(*part, scene.capsule_step.has_value(), world));
    for (const toml::table* part : tables(capsule, "memory")) scene.memory.push_back(read_memory(*part));
}

}  // namespace kolize::config
