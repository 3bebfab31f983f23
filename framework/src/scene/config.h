// The TOML of a scene before it is understood: scene file, pipeline file and --set entries merged into one tree, in
// which every node still knows where it was written.
#pragma once

#include <kolize/scene.h>

#include <toml++/toml.h>

namespace kolize::config {

using Settings = std::vector<std::pair<std::string, std::string>>;  // dotted key, value

// Nodes that --set brought have "--set KEY" as their file and neither line nor column.
SourceLocation location(const toml::node& node);
SourceLocation location(const toml::key& key, const toml::node& value);
bool is_setting(const toml::node& node);

// Folder that relative paths in this node start from: that of its file; the working directory for --set.
std::filesystem::path folder_of(const toml::node& node);

// `what` names the kind of file in messages: "scene", "pipeline". Throws Error.
toml::table parse_file(const std::filesystem::path& file, const std::string& what);

// Replaces whole tables of the scene. Throws Error for a table that does not belong into a pipeline.
void merge_pipeline(toml::table& scene, toml::table&& pipeline);

// Throws Error for a key that leads nowhere.
void apply_settings(toml::table& config, const Settings& settings);

// As apply_settings; of a stage that gets another plugin, the keys that the file gave to the old one and the new one
// does not have are dropped.
void apply_settings(toml::table& config, const Settings& settings, const PluginDefaults& defaults,
                    const PluginLibrary& plugins);

}  // namespace kolize::config
