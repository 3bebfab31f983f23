#include <kolize/integrator.h>

#include "parts.h"

#include <algorithm>

namespace kolize::config {
namespace {

Value scalar(const std::string& key, const toml::node& node) {
    if (const auto* flag = node.as_boolean()) return flag->get();
    if (const auto* integer = node.as_integer()) return integer->get();
    if (const auto* text = node.as_string()) return text->get();
    const auto* number = node.as_floating_point();
    if (!number) throw Error(location(node), key + " must be true, false, a number or text, is " + describe(node));
    if (!std::isfinite(number->get())) throw Error(location(node), key + " must be finite, is " + describe(node));
    return number->get();
}

StepConfig read_step(const toml::table& config) {
    TableReader reader(table(config, "step"), "[step]");
    StepConfig step;
    step.dt = reader.number("dt", step.dt, positive);
    step.substeps = static_cast<int>(reader.integer("substeps", step.substeps, {1, 1e6}));
    step.mode = reader.choice("mode", step.mode, stepping_names());
    step.where = reader.where("mode");
    step.integrator = reader.choice("integrator", step.integrator, integrator_names());
    step.tolerance = reader.number("tolerance", step.tolerance, {0, 1, true});
    step.max_impacts = static_cast<int>(reader.integer("max_impacts", step.max_impacts, {1, 1e6}));
    step.time = reader.number("time", step.time, non_negative);
    reader.finish();
    return step;
}

ModelConfig read_model(const toml::table& config) {
    TableReader reader(table(config, "model"), "[model]");
    ModelConfig model;
    model.detail = reader.choice("detail", model.detail, {"needed", "most"});
    model.bounding_spheres = reader.boolean("bounding_spheres", model.bounding_spheres);
    reader.finish();
    return model;
}

LedgerConfig read_ledger(const toml::table& config) {
    TableReader reader(table(config, "ledger"), "[ledger]");
    LedgerConfig ledger;
    ledger.check = reader.boolean("check", ledger.check);
    ledger.energy = reader.number("energy", ledger.energy, non_negative);
    ledger.momentum = reader.number("momentum", ledger.momentum, non_negative);
    ledger.angular_momentum = reader.number("angular_momentum", ledger.angular_momentum, non_negative);
    ledger.penetration = reader.number("penetration", ledger.penetration, non_negative);
    reader.finish();
    return ledger;
}

std::vector<std::string> read_when(const toml::table& table) {
    const toml::node* node = table.get("when");
    if (!node) return {};
    if (!node->is_table()) throw Error(location(*node), "when must be a table such as { kind = \"ball\" }");
    TableReader reader(*node->as_table(), "when");
    const std::string kind = reader.text("kind", "");
    std::vector<std::string> kinds = reader.texts("kinds");
    reader.finish();
    if (kind.empty() == kinds.empty() || (kind.empty() && kinds.size() != 2))
        throw Error(location(*node), "when must say either kind = \"...\" or kinds = [\"...\", \"...\"]");
    return kind.empty() ? kinds : std::vector{kind};
}

std::vector<ResponseRule> read_responses(const toml::table& config, const std::string& default_plugin) {
    std::vector<ResponseRule> rules;
    for (const toml::table* table : tables(config, "response"))
        rules.push_back({read_stage(*table, "[[response]]", default_plugin, {"when"}), read_when(*table)});
    if (rules.empty()) rules.push_back({StageConfig{default_plugin, {}, {}}, {}});
    return rules;
}

}  // namespace

StageConfig read_stage(const toml::table& table, const std::string& title, const std::string& default_plugin,
                       const std::vector<std::string>& framework_keys) {
    TableReader reader(table, title);
    StageConfig stage;
    stage.plugin = reader.text("plugin", default_plugin);
    stage.where = reader.where("plugin");
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        if (name != "plugin" && std::find(framework_keys.begin(), framework_keys.end(), name) == framework_keys.end())
            stage.settings[name] = {scalar(name, node), location(key, node)};
    }
    return stage;
}

PipelineConfig read_pipeline(const toml::table& config, const PluginDefaults& defaults) {
    const toml::table& narrowphase = table(config, "narrowphase");
    PipelineConfig pipeline;
    pipeline.broadphase = read_stage(table(config, "broadphase"), "[broadphase]", defaults.broadphase, {});
    pipeline.narrowphase = read_stage(narrowphase, "[narrowphase]", defaults.narrowphase, {"walls", "cull"});
    TableReader reader(narrowphase, "[narrowphase]");
    pipeline.walls = reader.choice("walls", pipeline.walls, {"auto", "half_space", "box", "mesh"});
    pipeline.cull = reader.choice("cull", pipeline.cull, {"none", "auto", "sphere", "aabb", "obb", "kdop18", "kdop26"});
    pipeline.responses = read_responses(config, defaults.response);
    pipeline.step = read_step(config);
    pipeline.model = read_model(config);
    pipeline.ledger = read_ledger(config);
    return pipeline;
}

}  // namespace kolize::config

namespace kolize {

std::uint64_t steps_in(double time, double dt) {
    const double steps = std::round(time / dt);
    if (!(steps <= 1e9)) throw Error("a time of " + to_string(Value(time)) + " s takes more than 1e9 steps");
    return static_cast<std::uint64_t>(steps);
}

StageConfig stage_config(StageKind stage, const std::vector<std::pair<std::string, std::string>>& set,
                         const std::string& default_plugin) {
    const std::string name = to_string(stage);
    for (const auto& [key, value] : set)
        if (!key.starts_with(name + "."))
            throw Error(SourceLocation{"--set " + key}, "only " + name + ".* can be set here");
    toml::table config;
    config::apply_settings(config, set);
    const toml::node* node = config.get(name);
    if (!node) return {default_plugin, {}, {}};
    const toml::node* only = node->is_array() ? node->as_array()->get(0) : node;
    return config::read_stage(*only->as_table(), "[" + name + "]", default_plugin, {});
}

}  // namespace kolize
