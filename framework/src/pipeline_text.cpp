#include <kolize/pipeline_file.h>

#include "toml_writer.h"

namespace kolize {
namespace {

void write_when(Writer& out, const std::vector<std::string>& kinds) {
    if (kinds.size() == 1) out.line("when = { kind = " + quoted(kinds[0]) + " }");
    if (kinds.size() == 2) out.line("when = { kinds = [" + quoted(kinds[0]) + ", " + quoted(kinds[1]) + "] }");
}

// Decimals are exact too: to_string gives the shortest that reads back as the same double.
void write_step(Writer& out, const StepConfig& step, const std::string& prefix) {
    out.table("[" + prefix + "step]");
    out.plain("dt", step.dt);
    out.plain("substeps", std::int64_t(step.substeps));
    out.plain("time", step.time);
    out.plain("mode", step.mode);
    out.plain("integrator", step.integrator);
    out.plain("tolerance", step.tolerance);
    out.plain("max_impacts", std::int64_t(step.max_impacts));
}

void write_model(Writer& out, const ModelConfig& model, const std::string& prefix) {
    out.table("[" + prefix + "model]");
    out.plain("detail", model.detail);
    out.plain("bounding_spheres", model.bounding_spheres);
}

void write_ledger(Writer& out, const LedgerConfig& ledger, const std::string& prefix) {
    out.table("[" + prefix + "ledger]");
    out.plain("check", ledger.check);
    out.plain("energy", ledger.energy);
    out.plain("momentum", ledger.momentum);
    out.plain("angular_momentum", ledger.angular_momentum);
    if (ledger.penetration < infinity) out.plain("penetration", ledger.penetration);
}

}  // namespace

void write_stage(Writer& out, const std::string& head, const StageConfig& stage) {
    out.table(head);
    out.plain("plugin", stage.plugin);
    for (const auto& [key, setting] : stage.settings) out.plain(key, setting.value);
}

void write_pipeline(Writer& out, const PipelineConfig& pipeline, const std::string& prefix) {
    write_step(out, pipeline.step, prefix);
    write_model(out, pipeline.model, prefix);
    write_ledger(out, pipeline.ledger, prefix);
    write_stage(out, "[" + prefix + "broadphase]", pipeline.broadphase);
    write_stage(out, "[" + prefix + "narrowphase]", pipeline.narrowphase);
    out.plain("walls", pipeline.walls);
    out.plain("cull", pipeline.cull);
    for (const ResponseRule& rule : pipeline.responses) {
        write_stage(out, "[[" + prefix + "response]]", rule.stage);
        write_when(out, rule.kinds);
    }
}

std::string pipeline_text(const PipelineConfig& pipeline) {
    Writer out;
    write_pipeline(out, pipeline, "");
    return out.text();
}

}  // namespace kolize
