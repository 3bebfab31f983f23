#include "parts.h"

#include <algorithm>

namespace kolize {
namespace {

using namespace config;

const std::vector<std::string> scene_tables = {"schema", "world",  "step",       "material",    "shape",
                                               "body",   "room",   "broadphase", "narrowphase", "response",
                                               "model",  "ledger", "render",     "capsule",     "recording"};

void require_known_tables(const toml::table& config) {
    for (const auto& [key, node] : config) {
        const std::string name(key.str());
        if (std::find(scene_tables.begin(), scene_tables.end(), name) == scene_tables.end())
            throw Error(location(key, node), "a scene has no table '" + name + "'" + hint(name, scene_tables));
    }
}

void require_schema(const toml::table& file) {
    const toml::node* schema = file.get("schema");
    if (schema && schema->value<std::int64_t>() != 1)
        throw Error(location(*schema), "schema " + describe(*schema) + " is not known; this program reads schema = 1");
}

Forces read_forces(const toml::table& config) {
    TableReader reader(table(config, "world"), "[world]");
    Forces forces;
    forces.gravity = reader.vector("gravity", forces.gravity);
    forces.wind = reader.vector("wind", forces.wind);
    forces.drag = reader.number("drag", forces.drag, non_negative);
    reader.finish();
    return forces;
}

void read_world(const toml::table& config, Scene& scene) {
    scene.world.forces = read_forces(config);
    const NameTable materials = read_materials(config, scene.world);
    const NameTable shapes = read_shapes(config, scene.world, scene.warnings);
    read_bodies(config, shapes, materials, scene.world);
    scene.rooms = read_rooms(config, materials);
}

toml::table merged_config(const std::filesystem::path& file, const SceneOptions& options,
                          const PluginLibrary& plugins) {
    toml::table config = parse_file(file, "scene");
    require_schema(config);
    if (!options.pipeline.empty()) {
        toml::table pipeline = parse_file(options.pipeline, "pipeline");
        require_schema(pipeline);
        merge_pipeline(config, std::move(pipeline));
    }
    apply_settings(config, options.set, options.defaults, plugins);
    require_known_tables(config);
    return config;
}

// Friction is accepted in every scene, so that one scene serves many pipelines; silence would make a result look
// frictional.
std::vector<std::string> frictionless_materials(const Scene& scene, const PluginLibrary& plugins) {
    const auto& rules = scene.pipeline.responses;
    const bool modelled = std::any_of(rules.begin(), rules.end(), [&](const ResponseRule& rule) {
        const LoadedPlugin* plugin = plugins.find(StageKind::response, rule.stage.plugin);
        return plugin && plugin->descriptor->capabilities.friction;
    });
    std::vector<std::string> warnings;
    for (const Material& material : scene.world.materials)
        if (material.friction > 0 && !modelled)
            warnings.push_back("friction of material '" + material.name +
                               "' has no effect: no response of this pipeline models friction");
    return warnings;
}

}  // namespace

namespace {

Scene read_scene(const toml::table& config, const std::filesystem::path& file, const SceneOptions& options,
                 const PluginLibrary& plugins) {
    Scene scene;
    scene.file = file.string();
    scene.pipeline = read_pipeline(config, options.defaults);
    config.contains("capsule") ? read_capsule(config, scene) : read_world(config, scene);
    scene.render = read_render(config, options.defaults, scene.world);
    for (std::string& warning : frictionless_materials(scene, plugins)) scene.warnings.push_back(std::move(warning));
    return scene;
}

}  // namespace

Scene load_scene(const std::filesystem::path& file, const SceneOptions& options, const PluginLibrary& plugins) {
    const toml::table config = merged_config(file, options, plugins);
    if (const toml::node* recording = config.get("recording"))
        throw Error(location(*recording), "this is a recording, which is played with --replay");
    return read_scene(config, file, options, plugins);
}

Recording load_recording(const std::filesystem::path& file, const SceneOptions& options, const PluginLibrary& plugins) {
    const toml::table config = merged_config(file, options, plugins);
    if (!config.contains("recording") || !config.contains("capsule"))
        throw Error(SourceLocation{file.string()},
                    "this is no recording: it has no tables [capsule] and [recording]; kolize run --record makes one");
    Recording recording;
    recording.start = read_scene(config, file, options, plugins);
    read_recording(config, options.defaults, recording);
    return recording;
}

}  // namespace kolize
