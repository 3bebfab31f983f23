#include <kolize/capsule.h>

#include "toml_writer.h"

#include <numbers>

namespace kolize {
namespace {

void write_forces(Writer& out, const Forces& forces) {
    out.table("[capsule.forces]");
    out.exact("gravity", forces.gravity);
    out.exact("wind", forces.wind);
    out.exact("drag", forces.drag);
}

void write_material(Writer& out, const Material& material) {
    out.table("[[capsule.material]]");
    out.name("name", material.name);
    out.exact("restitution", material.restitution);
    out.exact("friction", material.friction);
    out.exact("density", material.density);
}

void write_mesh(Writer& out, const Mesh& mesh) {
    out.plain("closed", mesh.closed);
    out.line("vertices = \"\"\"");
    for (const Vec3& vertex : mesh.vertices) out.line(hex(vertex));
    out.line("\"\"\"\ntriangles = \"\"\"");
    for (const auto& [a, b, c] : mesh.triangles)
        out.line(std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c));
    out.line("\"\"\"");
}

// What the reader makes from the rest is left out: bounds, hierarchy, the twelve triangles of a box.
void write_shape(Writer& out, const Shape& shape) {
    out.table("[[capsule.shape]]");
    out.name("name", shape.name);
    out.plain("kind", std::string(to_string(shape.kind)));
    out.exact("center_in_model", shape.center_in_model);
    out.exact("body_to_model", shape.body_to_model);
    if (shape.kind == ShapeKind::half_space) return out.exact("normal", shape.normal);
    out.exact("volume", shape.volume);
    out.exact("moments", shape.moments);
    if (shape.kind == ShapeKind::sphere) out.exact("radius", shape.radius);
    if (shape.kind == ShapeKind::box) out.exact("half_extents", shape.half_extents);
    if (shape.kind == ShapeKind::mesh || shape.kind == ShapeKind::hull) write_mesh(out, *shape.mesh);
    if (shape.kind == ShapeKind::capsule) {
        out.exact("radius", shape.cap_radius);
        out.exact("half_height", shape.half_height);
    }
}

void write_body(Writer& out, const World& world, std::uint32_t body) {
    out.table("[[capsule.body]]");
    out.name("name", world.name[body]);
    out.plain("shape", std::int64_t(world.shape[body]));
    out.plain("material", std::int64_t(world.material[body]));
    out.name("kind", world.kinds[world.kind[body]]);
    out.flag("static", world.is_static[body]);
    out.flag("removed", world.removed[body]);
    out.flag("asleep", world.asleep[body]);
    out.flag("reference", world.is_reference[body]);
    out.exact("position", world.position[body]);
    out.exact("orientation", world.orientation[body]);
    out.exact("velocity", world.velocity[body]);
    out.exact("angular_velocity", world.angular_velocity[body]);
    out.exact("inverse_mass", world.inverse_mass[body]);
    out.exact("inverse_inertia", world.inverse_inertia[body]);
    out.exact("force", world.constant_force[body]);
    out.exact("torque", world.constant_torque[body]);
}

void write_room(Writer& out, const Room& room, bool has_walls) {
    constexpr const char* sides[] = {"-x", "+x", "-y", "+y", "-z", "+z"};
    out.table("[[capsule.room]]");
    out.exact("min", room.min);
    out.exact("max", room.max);
    std::string open;
    for (std::size_t side = 0; side < room.open.size(); ++side)
        if (room.open[side]) open += (open.empty() ? "" : ", ") + quoted(sides[side]);
    out.line("open = [" + open + "]");
    if (has_walls) return;
    out.exact("thickness", room.thickness);
    out.plain("material", std::int64_t(room.material));
}

// Of a response, as hexadecimal words.
void write_memory(Writer& out, const ResponseMemory& memory) {
    out.table("[[capsule.memory]]");
    out.name("plugin", memory.plugin);
    if (memory.words.empty()) return;
    out.line("words = \"\"\"");
    char digits[16];
    for (const std::uint64_t word : memory.words)
        out.line(std::string(digits, std::to_chars(digits, digits + sizeof digits, word, 16).ptr));
    out.line("\"\"\"");
}

void write_camera(Writer& out, const CameraConfig& camera) {
    out.line("camera = { eye = " + list(camera.eye) + ", target = " + list(camera.target) + ", up = " +
             list(camera.up) + ", fov_deg = " + to_string(Value(camera.field_of_view * 180 / std::numbers::pi)) + " }");
}

void write_light(Writer& out, const Light& light, const World& world) {
    out.table("[[render.light]]");
    out.line("position = " + list(light.position));
    out.line("colour = " + list(light.colour));
    out.plain("range", light.range);
    if (light.body) out.plain("body", world.name[*light.body]);
    if (light.kind == LightKind::point) return;
    out.plain("kind", std::string("spot"));
    out.line("direction = " + list(light.direction));
    out.plain("cone_deg", light.cone * 180 / std::numbers::pi);
}

void write_texture(Writer& out, const TextureConfig& texture, const World& world) {
    out.table("[[render.texture]]");
    out.plain("shape", world.shapes[texture.shape].name);
    out.plain("file", std::filesystem::absolute(texture.file).string());
    out.plain("side", texture.side);
}

}  // namespace

void write_render(Writer& out, const RenderConfig& render, const World& world) {
    if (render.stage.plugin.empty()) return;
    write_stage(out, "[render]", render.stage);
    if (render.camera) write_camera(out, *render.camera);
    for (const Light& light : render.lights) write_light(out, light, world);
    for (const TextureConfig& texture : render.textures) write_texture(out, texture, world);
}

void write_world(Writer& out, const Scene& scene, const std::string& reason) {
    const bool has_walls = scene.capsule_step.has_value();
    out.table("[capsule]");
    out.plain("step", static_cast<std::int64_t>(scene.capsule_step.value_or(0)));
    if (!has_walls) out.plain("walls", false);
    out.name("scene", scene.file);
    out.name("reason", reason);
    write_forces(out, scene.world.forces);
    for (const Material& material : scene.world.materials) write_material(out, material);
    for (const Shape& shape : scene.world.shapes) write_shape(out, shape);
    for (std::uint32_t body = 0; body < scene.world.size(); ++body) write_body(out, scene.world, body);
    for (const Room& room : scene.rooms) write_room(out, room, has_walls);
    bool any_memory = false;
    for (const ResponseMemory& memory : scene.memory)
        if (!memory.words.empty()) any_memory = true;
    for (const ResponseMemory& memory : scene.memory)
        if (any_memory) write_memory(out, memory);
}

std::string capsule_text(const Scene& scene, const std::string& reason) {
    PipelineConfig pipeline = scene.pipeline;
    pipeline.step.time = pipeline.step.dt;  // `kolize run` takes this one step, if not told otherwise
    Writer out;
    out.line("# The step goes on from here to the same bits: kolize run THIS_FILE [--steps N]");
    out.plain("schema", std::int64_t(1));
    write_pipeline(out, pipeline, "");
    write_render(out, scene.render, scene.world);
    write_world(out, scene, reason);
    return out.text();
}

}  // namespace kolize
