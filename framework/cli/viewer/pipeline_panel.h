// The stages of a pipeline as items of a panel, and back.
#pragma once

#include <kolize/panel.h>
#include <kolize/plugin_library.h>
#include <kolize/scene.h>

#include <optional>

namespace kolize::cli {

// For each stage the plugins that were found, then the parameters of the one in force, as it declares them; then
// stepping and integrator. Ids are those of --set: "broadphase.plugin", "response.0.restitution", "step.mode".
void show_pipeline(const PipelineConfig& pipeline, const PluginLibrary& plugins, std::vector<PanelItem>& items);

// A pipeline in which one thing is different.
struct PipelineEdit {
    PipelineConfig pipeline;
    std::string what;  // "broadphase.plugin = bsp"
};

// Nothing if the item is none of show_pipeline's. A plugin that takes another one's place has its own defaults.
std::optional<PipelineEdit> edit_pipeline(const PipelineConfig& pipeline, const PanelItem& item);

}  // namespace kolize::cli
