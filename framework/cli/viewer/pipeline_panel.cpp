#include "viewer/pipeline_panel.h"

#include <kolize/integrator.h>

namespace kolize::cli {
namespace {

PanelItemKind kind_of(const Parameter& parameter) {
    constexpr PanelItemKind kinds[] = {PanelItemKind::toggle, PanelItemKind::integer, PanelItemKind::number,
                                       PanelItemKind::word};
    return parameter.choices.empty() ? kinds[parameter.default_value.index()] : PanelItemKind::choice;
}

PanelItem item_of(const Parameter& parameter, const std::string& prefix, const StageConfig& stage) {
    PanelItem item{kind_of(parameter), prefix + parameter.name, parameter.name, parameter.unit, parameter.doc};
    const auto set = stage.settings.find(parameter.name);
    item.value = set == stage.settings.end() ? parameter.default_value : parameter.coerce(set->second.value);
    item.options = parameter.choices;
    item.min = parameter.min;
    item.max = parameter.max;
    return item;
}

void show_stage(StageKind kind, const StageConfig& stage, const std::string& prefix, const std::string& title,
                const PluginLibrary& plugins, std::vector<PanelItem>& items) {
    items.push_back({PanelItemKind::heading, prefix, title});
    PanelItem choice{PanelItemKind::choice, prefix + "plugin", "plugin"};
    choice.options = plugins.names(kind);
    choice.value = stage.plugin;
    const LoadedPlugin* plugin = plugins.find(kind, stage.plugin);
    if (plugin) choice.help = plugin->descriptor->summary;
    items.push_back(choice);
    if (!plugin) return;
    for (const Parameter& parameter : plugin->parameters.items) items.push_back(item_of(parameter, prefix, stage));
}

std::string title_of(const ResponseRule& rule) {
    std::string kinds;
    for (const std::string& kind : rule.kinds) kinds += (kinds.empty() ? " of " : " and ") + kind;
    return "response" + kinds;
}

std::string response_prefix(std::size_t rule) { return "response." + std::to_string(rule) + "."; }

bool edit_stage(StageConfig& stage, const std::string& prefix, const PanelItem& item) {
    if (!item.id.starts_with(prefix)) return false;
    const std::string key = item.id.substr(prefix.size());
    if (key == "plugin") {
        stage.plugin = std::get<std::string>(item.value);
        stage.settings.clear();
    } else {
        stage.settings[key] = {item.value, {item.id}};
    }
    return true;
}

bool edit_step(StepConfig& step, const PanelItem& item) {
    if (item.id == "step.mode") step.mode = std::get<std::string>(item.value);
    if (item.id == "step.integrator") step.integrator = std::get<std::string>(item.value);
    return item.id.starts_with("step.");
}

}  // namespace

void show_pipeline(const PipelineConfig& pipeline, const PluginLibrary& plugins, std::vector<PanelItem>& items) {
    show_stage(StageKind::broadphase, pipeline.broadphase, "broadphase.", "broadphase", plugins, items);
    show_stage(StageKind::narrowphase, pipeline.narrowphase, "narrowphase.", "narrowphase", plugins, items);
    for (std::size_t i = 0; i < pipeline.responses.size(); ++i)
        show_stage(StageKind::response, pipeline.responses[i].stage, response_prefix(i),
                   title_of(pipeline.responses[i]), plugins, items);
    items.push_back({PanelItemKind::heading, "step.", "stepping"});
    const auto choice = [&](const char* id, const char* label, const std::string& value,
                            const std::vector<std::string>& options) {
        items.push_back({PanelItemKind::choice, id, label, "", "", Value(value), options});
    };
    choice("step.mode", "mode", pipeline.step.mode, stepping_names());
    choice("step.integrator", "integrator", pipeline.step.integrator, integrator_names());
}

std::optional<PipelineEdit> edit_pipeline(const PipelineConfig& pipeline, const PanelItem& item) {
    PipelineEdit edit{pipeline, item.id + " = " + to_string(item.value)};
    if (const auto* text = std::get_if<std::string>(&item.value)) edit.what = item.id + " = " + *text;
    bool found = edit_stage(edit.pipeline.broadphase, "broadphase.", item) ||
                 edit_stage(edit.pipeline.narrowphase, "narrowphase.", item) || edit_step(edit.pipeline.step, item);
    for (std::size_t i = 0; i < pipeline.responses.size(); ++i)
        found = found || edit_stage(edit.pipeline.responses[i].stage, response_prefix(i), item);
    if (!found) return std::nullopt;
    return edit;
}

}  // namespace kolize::cli
