// The parts of a scene, each read by a file of its own.
#pragma once

#include "table_reader.h"

#include <kolize/recording.h>

#include <map>

namespace kolize::config {

// [step], [broadphase], [narrowphase], [[response]].
PipelineConfig read_pipeline(const toml::table& config, const PluginDefaults& defaults);
StageConfig read_stage(const toml::table& table, const std::string& title, const std::string& default_plugin,
                       const std::vector<std::string>& framework_keys);

// Names to indices, with the place where each was given, so that a second one can point at the first.
class NameTable {
public:
    explicit NameTable(std::string what) : what_(std::move(what)) {}

    void add(const std::string& name, std::uint32_t index, const SourceLocation& where);
    std::uint32_t find(const std::string& name, const SourceLocation& where) const;

private:
    struct Entry {
        std::uint32_t index;
        SourceLocation where;
    };
    std::string what_;  // "shape"
    std::map<std::string, Entry> entries_;
};

// [[material]] and [[shape]], into world.materials and world.shapes. Material 0 is the default one.
NameTable read_materials(const toml::table& config, World& world);
// `warnings` takes what a mesh file holds and is not used.
NameTable read_shapes(const toml::table& config, World& world, std::vector<std::string>& warnings);

// [[body]], with the rows of `from` tables.
void read_bodies(const toml::table& config, const NameTable& shapes, const NameTable& materials, World& world);
std::vector<Room> read_rooms(const toml::table& config, const NameTable& materials);
std::array<bool, 6> read_open_sides(TableReader& reader);

// [capsule], which stands in the place of all of these: world, rooms and the number of the step.
void read_capsule(const toml::table& config, Scene& scene);

// [recording], without the scene that it begins with.
void read_recording(const toml::table& config, const PluginDefaults& defaults, Recording& recording);

// [render]; lights may name bodies of the world.
RenderConfig read_render(const toml::table& config, const PluginDefaults& defaults, const World& world);

}  // namespace kolize::config
