#include "parts.h"

#include <algorithm>
#include <numbers>

namespace kolize::config {
namespace {

constexpr double radians = std::numbers::pi / 180;

const toml::table* camera_table(const toml::table& render) {
    const toml::node* node = render.get("camera");
    if (node && !node->is_table())
        throw Error(location(*node), "camera must be a table such as { eye = [0, 2, 9], target = [0, 0, 0] }");
    return node ? node->as_table() : nullptr;
}

CameraConfig read_camera(const toml::table& table) {
    TableReader reader(table, "camera");
    CameraConfig camera;
    reader.require("eye");
    camera.eye = reader.vector("eye", camera.eye);
    camera.target = reader.vector("target", camera.target);
    camera.up = reader.vector("up", camera.up);
    camera.field_of_view = radians * reader.number("fov_deg", camera.field_of_view / radians, {1, 170});
    reader.finish();
    const Vec3 sight = camera.target - camera.eye;
    if (!(sight.norm() > 0)) reader.refuse("eye", "must not be the target");
    if (!(sight.normalized().cross(camera.up.normalized()).norm() > 1e-6))
        reader.refuse("up", "must not be zero or along the line of sight from eye to target");
    return camera;
}

std::optional<std::uint32_t> read_carrier(TableReader& reader, const World& world) {
    const std::string name = reader.text("body", "");
    if (name.empty()) return std::nullopt;
    const auto found = std::find(world.name.begin(), world.name.end(), name);
    if (found == world.name.end())
        throw Error(reader.where("body"), "there is no body '" + name + "'" + hint(name, world.name));
    return static_cast<std::uint32_t>(found - world.name.begin());
}

void read_spot(TableReader& reader, Light& light) {
    reader.require("direction");
    light.kind = LightKind::spot;
    light.direction = reader.vector("direction", light.direction);
    if (!(light.direction.norm() > 0)) reader.refuse("direction", "must not be zero");
    light.cone = radians * reader.number("cone_deg", light.cone / radians, {1, 89});
}

Light read_light(const toml::table& table, const World& world) {
    TableReader reader(table, "[[render.light]]");
    Light light;
    reader.require("position");
    light.position = reader.vector("position", light.position);
    light.colour = reader.vector("colour", light.colour);
    if (!(light.colour.array() >= 0).all())
        reader.refuse("colour", "must be three numbers from 0, red, green and blue");
    light.range = reader.number("range", light.range, positive);
    light.body = read_carrier(reader, world);
    if (reader.choice("kind", "point", {"point", "spot"}) == "spot") read_spot(reader, light);
    reader.finish();
    return light;
}

std::uint32_t read_textured_shape(TableReader& reader, const World& world) {
    reader.require("shape");
    const std::string name = reader.text("shape", "");
    const auto found =
        std::find_if(world.shapes.begin(), world.shapes.end(), [&](const Shape& shape) { return shape.name == name; });
    if (found == world.shapes.end()) {
        std::vector<std::string> names;
        for (const Shape& shape : world.shapes) names.push_back(shape.name);
        throw Error(reader.where("shape"), "there is no shape '" + name + "'" + hint(name, names));
    }
    if (found->kind == ShapeKind::half_space)
        throw Error(reader.where("shape"), "shape '" + name + "' is a half-space, which takes no texture");
    return static_cast<std::uint32_t>(found - world.shapes.begin());
}

TextureConfig read_texture(const toml::table& table, const World& world) {
    TableReader reader(table, "[[render.texture]]");
    TextureConfig texture;
    texture.shape = read_textured_shape(reader, world);
    texture.file = reader.path("file");
    texture.side = reader.number("side", texture.side, positive);
    texture.where = reader.where("file");
    reader.finish();
    return texture;
}

std::vector<TextureConfig> read_textures(const toml::table& render, const World& world) {
    std::vector<TextureConfig> textures;
    for (const toml::table* table : tables(render, "texture")) {
        const TextureConfig texture = read_texture(*table, world);
        for (const TextureConfig& other : textures)
            if (other.shape == texture.shape)
                throw Error(location(*table), "shape '" + world.shapes[texture.shape].name +
                                                  "' has a texture already, at " + to_string(other.where));
        textures.push_back(texture);
    }
    return textures;
}

}  // namespace

RenderConfig read_render(const toml::table& config, const PluginDefaults& defaults, const World& world) {
    const toml::table& render = table(config, "render");
    RenderConfig result;
    result.stage = read_stage(render, "[render]", defaults.render, {"camera", "light", "texture"});
    if (const toml::table* camera = camera_table(render)) result.camera = read_camera(*camera);
    for (const toml::table* light : tables(render, "light")) result.lights.push_back(read_light(*light, world));
    result.textures = read_textures(render, world);
    return result;
}

}  // namespace kolize::config
