// A scene file (TOML): what there is, and how it is to be computed.
#pragma once

#include <kolize/plugin_library.h>
#include <kolize/world.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kolize {

// [[response]]: the first rule that fits a contact takes it.
struct ResponseRule {
    StageConfig stage;
    std::vector<std::string> kinds;  // empty: every contact; one: either body is of it; two: the pair is of these
};

struct StepConfig {
    double dt = 1.0 / 240;          // s
    int substeps = 1;               // each with a search and a response of its own
    std::string mode = "discrete";  // discrete | rollback | bisection | continuous
    std::string integrator = "pdmv4";
    double tolerance = 1e-3;  // bisection: the impact time is found to this share of dt
    int max_impacts = 64;  // bisection, continuous: impacts of one pair in one step; then a bisection leaves the pair
                           // alone until the step ends, and continuous stepping brings its bodies to rest
    double time = 10;      // s; how long `kolize run` goes on when not told
    SourceLocation where = {};  // of the mode
};

KOLIZE_API const std::vector<std::string>& stepping_names();

// [ledger]: what each stage may at most get wrong, see docs/ledger.md.
struct LedgerConfig {
    bool check = false;
    double energy = 1e-12;            // share of the energies at hand
    double momentum = 1e-12;          // share of the momenta at hand
    double angular_momentum = 1e-12;  // likewise
    double penetration = infinity;    // m
};

// [model]: what is left out because no rule needs it.
struct ModelConfig {
    std::string detail = "needed";  // of contacts: needed | most, that is all that the narrowphase can give
    bool bounding_spheres = true;  // bodies are balls to the narrowphase where all rules that take them ask for no more
};

struct PipelineConfig {
    StageConfig broadphase;
    StageConfig narrowphase;
    std::string walls = "auto";  // narrowphase.walls: auto | half_space | box | mesh
    std::string cull = "none";   // narrowphase.cull: none | sphere | aabb | obb | kdop18 | kdop26
    std::vector<ResponseRule> responses;
    StepConfig step;
    ModelConfig model;
    LedgerConfig ledger;
};

// Where [render] puts the camera; the rest of it follows from the scene.
struct CameraConfig {
    Vec3 eye = Vec3::UnitZ();    // m
    Vec3 target = Vec3::Zero();  // m
    Vec3 up = Vec3::UnitY();
    double field_of_view = 0.9;  // vertical, rad
};

// [[render.texture]]: the PNG file is read by whoever draws.
struct TextureConfig {
    std::uint32_t shape = 0;  // into World::shapes
    std::filesystem::path file;
    double side = 1;            // m
    SourceLocation where = {};  // of the file's name
};

// [render]: how the scene is shown, by whatever draws it.
struct RenderConfig {
    StageConfig stage;
    std::optional<CameraConfig> camera;  // none: chosen to show the whole scene
    std::vector<Light> lights;           // [[render.light]]; empty: chosen to light the whole scene
    std::vector<TextureConfig> textures;
};

// What a response remembers from one step to the next.
struct ResponseMemory {
    std::string plugin;
    std::vector<std::uint64_t> words;  // see Response::save
};

struct Scene {
    std::string file;  // as the user named it
    World world;       // bodies of [[body]]; rooms become bodies when a simulation is made
    std::vector<Room> rooms;
    PipelineConfig pipeline;
    std::optional<std::uint64_t> capsule_step;  // of a capsule: the step that comes next; walls are bodies already
    std::vector<ResponseMemory> memory;         // of a capsule: one for each rule, or none at all
    std::vector<std::string> warnings;  // what the files ask for and is not modelled or not read, a sentence each
    RenderConfig render;
};

// Names of plugins that are taken where neither scene nor pipeline names one.
struct PluginDefaults {
    std::string broadphase;
    std::string narrowphase;
    std::string response;
    std::string render = "";  // may stay out where nothing is drawn
};

struct SceneOptions {
    std::filesystem::path pipeline;  // its tables replace the scene's, whole table by whole table; "": none
    std::vector<std::pair<std::string, std::string>> set;  // dotted key, TOML value (bare words are text)
    PluginDefaults defaults;
};

// Reads scene, pipeline and meshes. Throws Error with file:line:column (or "--set key" as the file) for anything wrong:
// syntax, unknown keys (with the nearest name), wrong types, values out of range, missing or broken files, NaN,
// non-positive mass.
// Plugin parameters are checked later, by PluginLibrary::make, except that a key which --set left behind from a
// plugin that it replaced is dropped when the new plugin has no such parameter: `plugins` tells.
KOLIZE_API Scene load_scene(const std::filesystem::path& file, const SceneOptions& options,
                            const PluginLibrary& plugins);

// The rows of a CSV table of states: any of the columns x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,mass in any order, named by
// the first line. `columns` are taken where the first line is numbers already; if empty, it has to name them. What the
// table leaves out has the value of a default BodyDescription. Throws Error with line and column of the cell.
KOLIZE_API std::vector<BodyDescription> read_states(const std::filesystem::path& file,
                                                    const std::vector<std::string>& columns = {});

// Whole steps that come nearest to a time (s). Throws Error for more than a thousand million.
KOLIZE_API std::uint64_t steps_in(double time, double dt);

// One stage configured by `--set STAGE.KEY=VALUE` entries alone, for programs that run a stage without a scene.
// Throws Error for an entry that is not of this stage.
KOLIZE_API StageConfig stage_config(StageKind stage, const std::vector<std::pair<std::string, std::string>>& set,
                                    const std::string& default_plugin);

}  // namespace kolize
