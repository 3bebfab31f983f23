// kolize stability: the options, who is asked what, and where the answers go.
#include "stability/report.h"

#include "bench.h"

#include <kolize/integrator.h>

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>

namespace kolize::cli {
namespace {

using namespace stability;

struct StabilityOptions {
    std::vector<std::string> stages, names, axes, pipelines, set, vary, plugin_path;
    std::uint64_t seed = 1;
    std::string map, report, json;

    // Without a choice of --axis, a map is about its own two.
    std::vector<std::string> followed() const { return axes.empty() ? map_axes() : axes; }
    std::vector<std::string> map_axes() const {
        if (map.empty()) return {};
        const std::size_t comma = map.find(',');
        if (comma == std::string::npos || map.find(',', comma + 1) != std::string::npos ||
            map.substr(0, comma) == map.substr(comma + 1))
            throw Error("--map takes two different axes, AXIS1,AXIS2, not '" + map + "'");
        return {map.substr(0, comma), map.substr(comma + 1)};
    }
};

constexpr const char* stage_words[] = {"broadphase", "narrowphase", "continuous", "response", "integrator", "pipeline"};

bool wanted(const std::vector<std::string>& choice, const std::string& name) {
    return choice.empty() || std::find(choice.begin(), choice.end(), name) != choice.end();
}

// "moller precision=float"
std::string short_name(const PlannedVariant& variant) {
    std::string name = variant.plugin->descriptor->name;
    for (const auto& [key, value] : variant.varied)
        if (!key.ends_with(".plugin")) name += " " + key.substr(key.find('.') + 1) + "=" + value;
    return name;
}

bool concerns(const std::string& setting, StageKind stage) {
    return setting.starts_with(std::string(to_string(stage)) + ".");
}

std::vector<Subject> plan_subjects(const StabilityOptions& options, StageKind stage, const PluginLibrary& library) {
    BenchOptions bench;
    const auto concerned = [&](const std::string& setting) { return concerns(setting, stage); };
    std::copy_if(options.set.begin(), options.set.end(), std::back_inserter(bench.set), concerned);
    std::copy_if(options.vary.begin(), options.vary.end(), std::back_inserter(bench.vary), concerned);
    std::vector<Subject> subjects;
    if (library.names(stage).empty()) return subjects;
    if (!names_plugin(bench, stage)) {
        std::string joined;
        for (const std::string& name : library.names(stage))
            if (wanted(options.names, name)) joined += (joined.empty() ? "" : ",") + name;
        if (joined.empty()) return subjects;
        bench.vary.insert(bench.vary.begin(), std::string(to_string(stage)) + ".plugin=" + joined);
    }
    for (const PlannedVariant& variant : plan_variants(bench, stage, "", library))
        subjects.emplace_back(short_name(variant), variant.config, variant.plugin);
    return subjects;
}

// Without a choice of files one for each stepping.
std::vector<Subject> plan_pipelines(const StabilityOptions& options) {
    std::vector<Subject> subjects;
    for (const std::string& file : options.pipelines) subjects.emplace_back(file).pipeline = file;
    if (subjects.empty())
        for (const std::string& name : stepping_names())
            if (wanted(options.names, name)) subjects.emplace_back(name);
    return subjects;
}

std::vector<Study> plan_studies(const StabilityOptions& options, const Context& context) {
    std::vector<Study> studies;
    const auto add = [&](std::vector<Study> more) {
        for (Study& study : more)
            if (wanted(options.stages, study.stage) && !study.subjects.empty()) studies.push_back(std::move(study));
    };
    add(broadphase_studies(context, plan_subjects(options, StageKind::broadphase, context.plugins)));
    const std::vector<Subject> narrowphases = plan_subjects(options, StageKind::narrowphase, context.plugins);
    add(narrowphase_studies(context, narrowphases));
    add(continuous_studies(context, narrowphases));
    add(response_studies(context, plan_subjects(options, StageKind::response, context.plugins)));
    std::vector<Subject> integrators;
    for (const std::string& name : integrator_names())
        if (wanted(options.names, name)) integrators.emplace_back(name);
    add(integrator_studies(context, integrators));
    if (wanted(options.stages, "pipeline")) add(pipeline_studies(context, plan_pipelines(options)));
    return studies;
}

void require_stages(const std::vector<std::string>& settings) {
    for (const std::string& setting : settings)
        if (!concerns(setting, StageKind::broadphase) && !concerns(setting, StageKind::narrowphase) &&
            !concerns(setting, StageKind::response))
            throw Error("'" + setting + "' has to begin with broadphase., narrowphase. or response.");
}

void require_known(const StabilityOptions& options, const Survey& survey) {
    std::vector<std::string> axes;
    for (const Study& study : survey.studies)
        for (const Axis& axis : study.axes) axes.push_back(axis.name);
    std::vector<std::string> names = options.axes, of_map = options.map_axes();
    names.insert(names.end(), of_map.begin(), of_map.end());
    for (const std::string& name : names)
        if (std::find(axes.begin(), axes.end(), name) == axes.end()) {
            const std::string nearest = nearest_name(name, axes);
            throw Error("there is no axis '" + name + "' to follow" +
                        (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
        }
    for (const std::string& name : options.names)
        if (std::none_of(survey.studies.begin(), survey.studies.end(), [&](const Study& study) {
                return std::any_of(study.subjects.begin(), study.subjects.end(), [&](const Subject& subject) {
                    return subject.name == name || subject.name.starts_with(name + " ");
                });
            }))
            throw Error("nothing that could be asked is called '" + name + "' (see kolize plugins list)");
}

void measure(Survey& survey, const std::vector<std::string>& axes) {
    for (const Study& study : survey.studies)
        for (const Subject& subject : study.subjects)
            for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
                if (wanted(axes, study.axes[axis].name)) survey.rows.push_back({&study, &subject, axis, {}});
    Progress progress("stability", survey.rows.size());
    for (Row& row : survey.rows) {
        row.envelope = find_envelope(*row.study, *row.subject, row.axis_index);
        progress.advance();
    }
}

void make_maps(Survey& survey, const std::vector<std::string>& axes) {
    if (axes.empty()) return;
    std::uint64_t count = 0;
    const auto for_each = [&](auto&& action) {
        for (const Study& study : survey.studies) {
            const auto across = axis_index(study, axes[0]), up = axis_index(study, axes[1]);
            if (!across || !up) continue;
            for (const Subject& subject : study.subjects) action(study, subject, *across, *up);
        }
    };
    for_each([&](const Study&, const Subject&, std::size_t, std::size_t) { ++count; });
    if (count == 0) throw Error("nothing that is asked has both axes, '" + axes[0] + "' and '" + axes[1] + "'");
    Progress progress("maps", count);
    for_each([&](const Study& study, const Subject& subject, std::size_t across, std::size_t up) {
        survey.maps.push_back(make_map(study, subject, across, up));
        progress.advance();
    });
}

void write_report(const std::filesystem::path& folder, const Survey& survey) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error("folder '" + folder.string() + "' cannot be made: " + error.message());
    write_text(text_report(survey), folder / "stability.txt");
    write_text(csv_report(survey), folder / "stability.csv");
    write_json(to_json(survey), folder / "stability.json");
    write_text(html_report(survey), folder / "stability.html");
}

void run(const StabilityOptions& options) {
    require_stages(options.set);
    require_stages(options.vary);
    const PluginLibrary plugins = open_plugins(options.plugin_path, {});
    const std::unique_ptr<Host> host = make_host(1);
    Survey survey{options.seed, plan_studies(options, {plugins, *host, options.seed}), {}, {}};
    require_known(options, survey);
    measure(survey, options.followed());
    make_maps(survey, options.map_axes());
    if (options.json != "-") std::cout << text_report(survey);
    if (!options.json.empty()) write_json(to_json(survey), options.json);
    if (!options.report.empty()) write_report(options.report, survey);
}

}  // namespace

void add_stability(CLI::App& app) {
    const auto options = std::make_shared<StabilityOptions>();
    CLI::App* command =
        app.add_subcommand("stability", "How far each plugin can be pushed before its answers fail, and how they fail");
    command->add_option("--stage", options->stages, "Only these (repeatable)")
        ->allow_extra_args(false)
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(stage_words), std::end(stage_words))));
    command->add_option("--plugin", options->names, "Only these (repeatable)")->allow_extra_args(false);
    command->add_option("--pipeline", options->pipelines, "Pipeline file that is asked as a whole (repeatable)")
        ->allow_extra_args(false);
    command->add_option("--axis", options->axes, "Follow only these axes (repeatable)")->allow_extra_args(false);
    command->add_option("--map", options->map, "Two axes at once (AXIS1,AXIS2): what holds where");
    command->add_option("--vary", options->vary, "STAGE.KEY=V1,V2,...: all combinations are asked (repeatable)")
        ->allow_extra_args(false);
    add_set_option(*command, options->set);
    command->add_option("--seed", options->seed, "Of all random input")->capture_default_str();
    command->add_option("--report", options->report, "Write stability.txt, .csv, .json and .html to this folder");
    add_plugin_path_option(*command, options->plugin_path);
    add_json_option(*command, options->json);
    command->footer(
        "Example: kolize stability --stage narrowphase --vary narrowphase.plugin=moller,exact --axis distance");
    command->callback([options] { run(*options); });
}

}  // namespace kolize::cli
