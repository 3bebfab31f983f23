#include "parts.h"

#include <algorithm>
#include <stdexcept>

namespace kolize::config {
namespace {

const std::vector<std::string> state_keys = {"position", "orientation", "velocity", "angular_velocity"};
const std::vector<std::string> sides = {"-x", "+x", "-y", "+y", "-z", "+z"};

std::uint32_t read_material_name(TableReader& reader, const NameTable& materials) {
    const std::string name = reader.text("material", "");
    return name.empty() ? 0 : materials.find(name, reader.where("material"));
}

double read_mass(TableReader& reader, const BodyDescription& body, const World& world) {
    const double mass = reader.number("mass", 0, positive);
    const double density = reader.number("density", 0, positive);
    if (mass > 0 && density > 0) reader.refuse("density", "cannot stand beside mass; give one of them");
    return density > 0 && !body.is_static ? density * world.shapes[body.shape].volume : mass;
}

// All but the state.
BodyDescription read_constants(TableReader& reader, const NameTable& shapes, const NameTable& materials,
                               const World& world) {
    BodyDescription body;
    body.name = reader.text("name", "");
    if (!body.name.empty()) reader.set_title("body '" + body.name + "'");
    reader.require("shape");
    body.shape = shapes.find(reader.text("shape", ""), reader.where("shape"));
    body.material = read_material_name(reader, materials);
    body.kind = reader.text("kind", body.kind);
    body.is_static = reader.boolean("static", false);
    body.is_reference = reader.boolean("reference", false);
    body.mass = read_mass(reader, body, world);
    body.constant_force = reader.vector("force", Vec3::Zero());
    body.constant_torque = reader.vector("torque", Vec3::Zero());
    return body;
}

void read_state(TableReader& reader, BodyDescription& body) {
    body.position = reader.vector("position", Vec3::Zero());
    body.orientation = reader.orientation("orientation");
    body.velocity = reader.vector("velocity", Vec3::Zero());
    body.angular_velocity = reader.vector("angular_velocity", Vec3::Zero());
}

void add_body(World& world, const BodyDescription& body, const SourceLocation& where) {
    try {
        world.add(body);
    } catch (const std::invalid_argument& error) {
        throw Error(where, error.what());
    }
}

BodyDescription with_state(const BodyDescription& constants, const BodyDescription& row, std::size_t index) {
    BodyDescription body = constants;
    body.position = row.position;
    body.orientation = row.orientation;
    body.velocity = row.velocity;
    body.angular_velocity = row.angular_velocity;
    if (row.mass > 0) body.mass = row.mass;
    if (!body.name.empty()) body.name.append(1, '.').append(std::to_string(index));
    return body;
}

// One body for each row of the table that `from` names; body NAME becomes NAME.0, NAME.1, ...
void read_table(TableReader& reader, const BodyDescription& constants, World& world) {
    for (const std::string& key : state_keys)
        if (reader.has(key)) reader.refuse(key, "cannot stand beside from, whose table holds the states");
    const std::vector<BodyDescription> rows = read_states(reader.path("from"));
    for (std::size_t i = 0; i < rows.size(); ++i)
        add_body(world, with_state(constants, rows[i], i), reader.where("from"));
}

Room read_room(TableReader& reader, const NameTable& materials) {
    Room room;
    reader.require("min");
    reader.require("max");
    room.min = reader.vector("min", room.min);
    room.max = reader.vector("max", room.max);
    if (!(room.min.array() < room.max.array()).all()) reader.refuse("max", "must be greater than min on every axis");
    room.thickness = reader.number("thickness", room.thickness, positive);
    room.open = read_open_sides(reader);
    room.material = read_material_name(reader, materials);
    reader.finish();
    return room;
}

}  // namespace

std::array<bool, 6> read_open_sides(TableReader& reader) {
    std::array<bool, 6> open{};
    for (const std::string& side : reader.texts("open")) {
        const auto found = std::find(sides.begin(), sides.end(), side);
        if (found == sides.end())
            throw Error(reader.where("open"), "there is no side '" + side + "'; there are " + join(sides));
        open[static_cast<std::size_t>(found - sides.begin())] = true;
    }
    return open;
}

void read_bodies(const toml::table& config, const NameTable& shapes, const NameTable& materials, World& world) {
    NameTable names("body");
    for (const toml::table* table : tables(config, "body")) {
        TableReader reader(*table, "[[body]]");
        BodyDescription body = read_constants(reader, shapes, materials, world);
        if (!body.name.empty()) names.add(body.name, static_cast<std::uint32_t>(world.size()), reader.where("name"));
        if (reader.has("from")) {
            read_table(reader, body, world);
        } else {
            read_state(reader, body);
            add_body(world, body, location(*table));
        }
        reader.finish();
    }
}

std::vector<Room> read_rooms(const toml::table& config, const NameTable& materials) {
    std::vector<Room> rooms;
    for (const toml::table* table : tables(config, "room")) {
        TableReader reader(*table, "[[room]]");
        rooms.push_back(read_room(reader, materials));
    }
    return rooms;
}

}  // namespace kolize::config
