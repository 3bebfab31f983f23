// Before step 0: do the stages of a pipeline fit together, and what is the least that each has to do?
#include "pipeline.h"

namespace kolize {

namespace {

bool fits(const std::vector<std::string>& wanted, const std::string& a, const std::string& b) {
    if (wanted.empty()) return true;
    if (wanted.size() == 1) return a == wanted[0] || b == wanted[0];
    return (a == wanted[0] && b == wanted[1]) || (a == wanted[1] && b == wanted[0]);
}

std::string names_that(const PluginLibrary& plugins, StageKind stage,
                       bool (*would_do)(const Capabilities&, std::uint32_t), std::uint32_t argument) {
    std::string names;
    for (const LoadedPlugin& plugin : plugins.plugins())
        if (plugin.descriptor->stage == stage && would_do(plugin.descriptor->capabilities, argument))
            names += (names.empty() ? "" : ", ") + std::string(plugin.descriptor->name);
    return names.empty() ? "no plugin found does" : "these would do: " + names;
}

}  // namespace

void Pipeline::negotiate(const PipelineConfig& config, const PluginLibrary& plugins) {
    const Capabilities& narrow = narrowphase_plugin->descriptor->capabilities;
    const std::string who = "narrowphase '" + config.narrowphase.plugin + "'";
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        const ShapeKind kind = world.shape_of(body).kind;
        if (!(narrow.shape_kinds & bit(kind)))
            throw Error(
                config.narrowphase.where,
                who + " does not take shapes of kind " + to_string(kind) + " (body '" + world.name[body] + "'); " +
                    names_that(
                        plugins, StageKind::narrowphase,
                        [](const Capabilities& c, std::uint32_t wanted) { return (c.shape_kinds & wanted) != 0; },
                        bit(kind)));
    }
    for (std::uint32_t body = 0; body < world.size(); ++body)
        if (const Mesh* mesh = world.shape_of(body).mesh.get();
            config.step.mode != "continuous" && mesh && !mesh->closed)
            throw Error(config.step.where, "stepping '" + config.step.mode +
                                               "' tells inside from outside, and the surface of body '" +
                                               world.name[body] + "' is open; take mode = \"continuous\"");
    if (config.step.mode == "continuous" && !narrow.time_of_impact)
        throw Error(config.narrowphase.where,
                    who + " does not find times of impact, which stepping 'continuous' needs; " +
                        names_that(
                            plugins, StageKind::narrowphase,
                            [](const Capabilities& c, std::uint32_t) { return c.time_of_impact; }, 0));
    for (std::size_t i = 0; i < rules.size(); ++i) {
        const Capabilities& response = rules[i].plugin->descriptor->capabilities;
        const Detail given = narrowphase->gives();
        if (given < response.needs)
            throw Error(config.responses[i].stage.where,
                        "response '" + config.responses[i].stage.plugin + "' needs " + to_string(response.needs) +
                            ", but " + who + " as configured gives only " + to_string(given) + "; " +
                            names_that(
                                plugins, StageKind::narrowphase,
                                [](const Capabilities& c, std::uint32_t needed) { return c.gives >= Detail(needed); },
                                static_cast<std::uint32_t>(response.needs)));
        rules[i].detail = config.model.detail == "most" ? given : std::min(given, response.uses);
    }
    const std::size_t kinds = world.kinds.size();
    rule_of_kinds_.assign(kinds * kinds, no_rule);
    for (std::size_t a = 0; a < kinds; ++a)
        for (std::size_t b = 0; b < kinds; ++b)
            for (std::uint32_t r = static_cast<std::uint32_t>(rules.size()); r-- > 0;)
                if (fits(rules[r].kinds, world.kinds[a], world.kinds[b])) rule_of_kinds_[a * kinds + b] = r;
}

// A dynamic body is replaced by its bounding sphere when every rule that can take it asks for no more: its triangles
// are then never looked at.
void Pipeline::use_bounding_spheres() {
    const std::size_t kinds = world.kinds.size();
    std::vector<std::uint8_t> kind_in_use(kinds, 0);
    for (const std::uint32_t kind : world.kind) kind_in_use[kind] = 1;
    std::vector<std::uint32_t> sphere_of(world.shapes.size(), no_rule);
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        const Shape shape = world.shape_of(body);
        if (world.is_static[body] || shape.kind == ShapeKind::sphere) continue;
        bool spheres_do = false, more_needed = false;
        for (std::size_t other = 0; other < kinds; ++other) {
            const std::uint32_t rule = rule_of_kinds_[world.kind[body] * kinds + other];
            if (!kind_in_use[other] || rule == no_rule) continue;
            (rules[rule].plugin->descriptor->capabilities.bounding_spheres ? spheres_do : more_needed) = true;
        }
        if (!spheres_do || more_needed) continue;
        std::uint32_t& sphere = sphere_of[world.shape[body]];
        if (sphere == no_rule) {
            sphere = static_cast<std::uint32_t>(world.shapes.size());
            Shape bounding = make_sphere(shape.name, shape.radius);
            bounding.volume = shape.volume;
            bounding.moments = shape.moments;
            bounding.center_in_model = shape.center_in_model;
            bounding.body_to_model = shape.body_to_model;
            world.shapes.push_back(bounding);
        }
        world.shape[body] = sphere;
    }
}

}  // namespace kolize
