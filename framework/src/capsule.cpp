#include <kolize/capsule.h>

#include <charconv>

namespace kolize {
namespace {

// C99's %a with as many digits as the bits need, in any locale.
std::string hex(double value) {
    char digits[32];
    const std::string text(digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::hex).ptr);
    return text[0] == '-' ? "-0x" + text.substr(1) : "0x" + text;
}

std::string hex(const Vec3& v) { return hex(v.x()) + " " + hex(v.y()) + " " + hex(v.z()); }
std::string hex(const Quat& q) { return hex(q.w()) + " " + hex(q.x()) + " " + hex(q.y()) + " " + hex(q.z()); }
std::string quoted(const std::string& text) { return to_string(Value(text)); }

// TOML, line by line.
class Writer {
public:
    void line(const std::string& text) { text_ += text + "\n"; }
    void table(const std::string& head) { line("\n" + head); }
    void plain(const std::string& key, const Value& value) { line(key + " = " + to_string(value)); }
    template <class T>
    void exact(const std::string& key, const T& value) {
        line(key + " = \"" + hex(value) + "\"");
    }
    void flag(const std::string& key, bool value) {
        if (value) plain(key, true);
    }
    void name(const std::string& key, const std::string& value) {
        if (!value.empty()) plain(key, value);
    }
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

void write_stage(Writer& out, const std::string& head, const StageConfig& stage) {
    out.table(head);
    out.plain("plugin", stage.plugin);
    for (const auto& [key, setting] : stage.settings) out.plain(key, setting.value);
}

void write_when(Writer& out, const std::vector<std::string>& kinds) {
    if (kinds.size() == 1) out.line("when = { kind = " + quoted(kinds[0]) + " }");
    if (kinds.size() == 2) out.line("when = { kinds = [" + quoted(kinds[0]) + ", " + quoted(kinds[1]) + "] }");
}

// Decimals are exact too: to_string gives the shortest that reads back as the same double.
void write_step(Writer& out, const StepConfig& step) {
    out.table("[step]");
    out.plain("dt", step.dt);
    out.plain("time", step.dt);  // `kolize run` takes this one step, if not told otherwise
    out.plain("mode", step.mode);
    out.plain("integrator", step.integrator);
    out.plain("tolerance", step.tolerance);
    out.plain("max_impacts", std::int64_t(step.max_impacts));
}

void write_ledger(Writer& out, const LedgerConfig& ledger) {
    out.table("[ledger]");
    out.plain("check", ledger.check);
    out.plain("energy", ledger.energy);
    out.plain("momentum", ledger.momentum);
    out.plain("angular_momentum", ledger.angular_momentum);
    if (ledger.penetration < infinity) out.plain("penetration", ledger.penetration);
}

void write_pipeline(Writer& out, const PipelineConfig& pipeline) {
    write_step(out, pipeline.step);
    write_ledger(out, pipeline.ledger);
    write_stage(out, "[broadphase]", pipeline.broadphase);
    write_stage(out, "[narrowphase]", pipeline.narrowphase);
    out.plain("walls", pipeline.walls);
    for (const ResponseRule& rule : pipeline.responses) {
        write_stage(out, "[[response]]", rule.stage);
        write_when(out, rule.kinds);
    }
}

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
    if (shape.kind == ShapeKind::mesh) write_mesh(out, *shape.mesh);
}

void write_body(Writer& out, const World& world, std::uint32_t body) {
    out.table("[[capsule.body]]");
    out.name("name", world.name[body]);
    out.plain("shape", std::int64_t(world.shape[body]));
    out.plain("material", std::int64_t(world.material[body]));
    out.name("kind", world.kinds[world.kind[body]]);
    out.flag("static", world.is_static[body]);
    out.flag("removed", world.removed[body]);
    out.exact("position", world.position[body]);
    out.exact("orientation", world.orientation[body]);
    out.exact("velocity", world.velocity[body]);
    out.exact("angular_velocity", world.angular_velocity[body]);
    out.exact("inverse_mass", world.inverse_mass[body]);
    out.exact("inverse_inertia", world.inverse_inertia[body]);
    out.exact("force", world.constant_force[body]);
    out.exact("torque", world.constant_torque[body]);
}

void write_room(Writer& out, const Room& room) {
    constexpr const char* sides[] = {"-x", "+x", "-y", "+y", "-z", "+z"};
    out.table("[[capsule.room]]");
    out.exact("min", room.min);
    out.exact("max", room.max);
    std::string open;
    for (std::size_t side = 0; side < room.open.size(); ++side)
        if (room.open[side]) open += (open.empty() ? "" : ", ") + quoted(sides[side]);
    out.line("open = [" + open + "]");
}

}  // namespace

std::string capsule_text(const Scene& scene, const std::string& reason) {
    const std::uint64_t step = scene.capsule_step.value_or(0);
    Writer out;
    out.line("# The step goes on from here to the same bits: kolize run THIS_FILE [--steps N]");
    out.plain("schema", std::int64_t(1));
    write_pipeline(out, scene.pipeline);
    out.table("[capsule]");
    out.plain("step", static_cast<std::int64_t>(step));
    out.name("scene", scene.file);
    out.name("reason", reason);
    write_forces(out, scene.world.forces);
    for (const Material& material : scene.world.materials) write_material(out, material);
    for (const Shape& shape : scene.world.shapes) write_shape(out, shape);
    for (std::uint32_t body = 0; body < scene.world.size(); ++body) write_body(out, scene.world, body);
    for (const Room& room : scene.rooms) write_room(out, room);
    return out.text();
}

}  // namespace kolize
