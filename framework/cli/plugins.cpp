// kolize plugins: what there is, what it does and which parameters it has.
#include "plugins.h"

#include "allocations.h"

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>

namespace kolize::cli {
namespace {

struct PluginOptions {
    std::vector<std::string> plugin_path;
    std::string json;
    std::string name;
    std::string certificate;
    std::uint64_t seed = 1;
};

constexpr const char* beside = "beside the library";  // where the certificate goes if no path is given

constexpr StageKind stage_kinds[] = {StageKind::broadphase, StageKind::narrowphase, StageKind::response,
                                     StageKind::render};

// What the plugin can do at most, or cannot do without; only what its stage knows.
Json capabilities_json(const PluginDescriptor& plugin) {
    const Capabilities& can = plugin.capabilities;
    switch (plugin.stage) {
    case StageKind::broadphase:
        return {{"exact", can.exact},
                {"outline", can.outline ? Json(can.outline) : Json()},
                {"chooses", can.chooses},
                {"allocates", can.allocates}};
    case StageKind::narrowphase:
        return {{"gives", to_string(can.gives)},
                {"shapes", shape_kind_names(can.shape_kinds)},
                {"exact", can.exact},
                {"time_of_impact", can.time_of_impact},
                {"crossings", can.crossings},
                {"bounding_volumes", can.bounding_spheres},
                {"allocates", can.allocates}};
    case StageKind::response:
        return {{"needs", to_string(can.needs)},
                {"uses", to_string(can.uses)},
                {"friction", can.friction},
                {"rests", can.rests},
                {"sleeps", can.sleeps},
                {"moves", can.moves},
                {"bounding_spheres", can.bounding_spheres},
                {"allocates", can.allocates}};
    case StageKind::render: break;
    }
    return Json::object();
}

bool has_range(const Parameter& parameter) {
    const Parameter unlimited;
    return parameter.min != unlimited.min || parameter.max != unlimited.max;
}

Json parameter_json(const Parameter& parameter) {
    Json json{{"name", parameter.name},
              {"type", parameter.type_name()},
              {"default", to_json(parameter.default_value)},
              {"unit", parameter.unit}};
    if (has_range(parameter)) json["range"] = {parameter.min, parameter.max};
    if (!parameter.choices.empty()) json["choices"] = parameter.choices;
    json["doc"] = parameter.doc;
    return json;
}

Json plugin_json(const LoadedPlugin& plugin) {
    Json parameters = Json::array();
    for (const Parameter& parameter : plugin.parameters.items) parameters.push_back(parameter_json(parameter));
    return {{"stage", to_string(plugin.descriptor->stage)},
            {"name", plugin.descriptor->name},
            {"summary", plugin.descriptor->summary},
            {"source", plugin.descriptor->source},
            {"cost", plugin.descriptor->cost},
            {"accuracy", plugin.descriptor->accuracy},
            {"choose", plugin.descriptor->choose},
            {"file", plugin.file.string()},
            {"certificate", to_json(certificate_of(plugin))},
            {"capabilities", capabilities_json(*plugin.descriptor)},
            {"parameters", parameters}};
}

Json list_json(const PluginLibrary& library) {
    Json plugins = Json::array(), refused = Json::array();
    for (const LoadedPlugin* plugin : sorted_plugins(library)) plugins.push_back(plugin_json(*plugin));
    for (const RefusedPlugin& plugin : library.refused())
        refused.push_back({{"file", plugin.file.string()}, {"reason", plugin.reason}});
    return {{"plugin_api", plugin_api}, {"plugins", plugins}, {"refused", refused}};
}

void print_list(const PluginLibrary& library) {
    for (const LoadedPlugin* plugin : sorted_plugins(library)) {
        const PluginDescriptor& d = *plugin->descriptor;
        std::string stage = to_string(d.stage), name = d.name;
        stage.resize(std::max<std::size_t>(stage.size(), 12), ' ');
        name.resize(std::max<std::size_t>(name.size(), 20), ' ');
        const std::string indent(32, ' ');
        std::cout << stage << name << d.summary << '\n'
                  << indent << plugin->file.string() << '\n'
                  << indent << in_words(certificate_of(*plugin)) << '\n';
    }
    for (const RefusedPlugin& refused : library.refused())
        std::cout << "refused     " << refused.file.string() << ": " << refused.reason << '\n';
    if (library.plugins().empty()) std::cout << "no plugins found in:\n";
    for (const std::filesystem::path& folder : library.folders())
        if (library.plugins().empty()) std::cout << "  " << folder.string() << '\n';
}

void list(const PluginOptions& options) {
    const PluginLibrary library = open_plugins(options.plugin_path, {});
    if (options.json != "-") print_list(library);
    if (!options.json.empty()) write_json(list_json(library), options.json);
}

void print_plugin(const LoadedPlugin& plugin) {
    const PluginDescriptor& d = *plugin.descriptor;
    std::cout << to_string(d.stage) << ' ' << d.name << ": " << d.summary << "\n  source        " << d.source
              << "\n  file          " << plugin.file.string() << "\n  certificate   "
              << in_words(certificate_of(plugin)) << '\n';
    for (const auto& [title, text] : {std::pair{"cost", d.cost}, {"accuracy", d.accuracy}, {"choose", d.choose}})
        if (*text) std::cout << "  " << title << std::string(14 - std::string(title).size(), ' ') << text << '\n';
    const Json capabilities = capabilities_json(d);
    for (const auto& [key, value] : capabilities.items())
        std::cout << "  " << key << std::string(14 - std::min<std::size_t>(13, key.size()), ' ')
                  << (value.is_string() ? value.get<std::string>() : value.dump()) << '\n';
    for (const Parameter& p : plugin.parameters.items) {
        std::cout << "\n  " << p.name << " = " << to_string(p.default_value) << (p.unit.empty() ? "" : " ") << p.unit
                  << "    " << p.type_name();
        if (const std::string text = limits(p); !text.empty()) std::cout << ", " << text;
        std::cout << "\n      " << p.doc << '\n';
    }
}

// A name may stand in more than one stage: all of them are shown.
void show(const PluginOptions& options) {
    const PluginLibrary library = open_plugins(options.plugin_path, {});
    std::vector<const LoadedPlugin*> found;
    std::vector<std::string> names;
    for (const LoadedPlugin* plugin : sorted_plugins(library)) {
        names.emplace_back(plugin->descriptor->name);
        if (names.back() == options.name) found.push_back(plugin);
    }
    if (found.empty()) {
        const std::string near = nearest_name(options.name, names);
        throw Error("there is no plugin '" + options.name + "'; " +
                    (near.empty() ? "kolize plugins list shows all" : "did you mean '" + near + "'?"));
    }
    Json json = Json::array();
    for (const LoadedPlugin* plugin : found) {
        if (options.json != "-") print_plugin(*plugin);
        json.push_back(plugin_json(*plugin));
    }
    if (!options.json.empty()) write_json(json, options.json);
}

const LoadedPlugin& plugin_in(const PluginLibrary& library, const std::filesystem::path& file) {
    std::error_code error;
    for (const RefusedPlugin& refused : library.refused())
        if (std::filesystem::equivalent(refused.file, file, error)) throw Error(file.string() + ": " + refused.reason);
    for (const LoadedPlugin& plugin : library.plugins())
        if (std::filesystem::equivalent(plugin.file, file, error)) return plugin;
    throw Error("'" + file.string() + "' is no plugin library");
}

// Only the file's own folder is searched, so that no other plugin of the same name gets in its way.
int test(const PluginOptions& options) {
    const std::filesystem::path file = std::filesystem::absolute(options.name);
    const PluginLibrary library({file.parent_path()});
    const LoadedPlugin& plugin = plugin_in(library, file);
    const std::vector<Check> checks = hold_to_contract(library, plugin, options.seed);
    if (options.json != "-") print_matrix(std::cout, {{plugin.descriptor->name, checks}});
    Json rows = Json::array();
    for (const Check& check : checks)
        rows.push_back({{"name", check.name}, {"outcome", word(check.outcome)}, {"detail", check.detail}});
    if (!options.json.empty()) write_json({{"plugin", plugin_json(plugin)}, {"checks", rows}}, options.json);
    if (!passed(checks)) return 1;
    if (options.certificate == beside)
        write_certificate(plugin, checks, options.seed, certificate_path(plugin.file));
    else if (!options.certificate.empty())
        write_certificate(plugin, checks, options.seed, options.certificate);
    return 0;
}

void docs(const PluginOptions& options) { write_plugin_pages(open_plugins(options.plugin_path, {}), options.name); }

void add_common(CLI::App& command, PluginOptions& options) {
    add_plugin_path_option(command, options.plugin_path);
    add_json_option(command, options.json);
}

}  // namespace

std::vector<const LoadedPlugin*> sorted_plugins(const PluginLibrary& library) {
    std::vector<const LoadedPlugin*> plugins;
    for (const StageKind stage : stage_kinds)
        for (const std::string& name : library.names(stage)) plugins.push_back(library.find(stage, name));
    return plugins;
}

std::vector<std::string> shape_kind_names(std::uint32_t bits) {
    std::vector<std::string> names;
    for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::box, ShapeKind::half_space, ShapeKind::mesh,
                                 ShapeKind::capsule, ShapeKind::hull})
        if (bits & bit(kind)) names.emplace_back(to_string(kind));
    return names;
}

std::string limits(const Parameter& parameter) {
    std::string text;
    for (const std::string& choice : parameter.choices) text += (text.empty() ? "one of " : ", ") + choice;
    if (has_range(parameter)) text = "from " + number(parameter.min, 6) + " to " + number(parameter.max, 6);
    return text;
}

const char* word(Check::Outcome outcome) {
    constexpr const char* words[] = {"pass", "fail", "skip"};
    return words[static_cast<std::size_t>(outcome)];
}

std::vector<Check> hold_to_contract(const PluginLibrary& library, const LoadedPlugin& plugin, std::uint64_t seed) {
    const AllocationCounter counter;
    ConformanceOptions options;
    options.seed = seed;
    if (AllocationCounter::available()) options.allocations = [&] { return counter.count(); };
    return check_plugin(library, plugin, options);
}

void add_plugins(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<PluginOptions>();
    CLI::App* command = app.add_subcommand("plugins", "List and describe plugins");
    command->require_subcommand(1);
    command->footer("Example: kolize plugins show grid");

    CLI::App* listing = command->add_subcommand("list", "All plugins found, and the libraries that were refused");
    add_common(*listing, *options);
    listing->get_option("--json")->expected(0, 1)->default_str("-");
    listing->footer("Example: kolize plugins list --json");
    listing->callback([options] { list(*options); });

    CLI::App* showing = command->add_subcommand("show", "Source, capabilities and parameters of a plugin");
    showing->add_option("name", options->name, "Plugin name")->required();
    add_common(*showing, *options);
    showing->footer("Example: kolize plugins show grid");
    showing->callback([options] { show(*options); });

    CLI::App* testing = command->add_subcommand("test", "Hold a plugin library to the contract of its stage");
    testing->add_option("file", options->name, "Plugin library (.so)")->required()->check(CLI::ExistingFile);
    add_json_option(*testing, options->json);
    testing
        ->add_option("--certificate", options->certificate,
                     "If no check fails, write which ones passed, for this very file, as JSON; without a path beside "
                     "the library, as its name with .certificate.json")
        ->expected(0, 1)
        ->default_str(beside);
    testing->add_option("--seed", options->seed, "Seed of all random input")->capture_default_str();
    testing->footer("Example: kolize plugins test build/my_broadphase.so");
    testing->callback([options, &exit_code] { exit_code = test(*options); });

    CLI::App* writing = command->add_subcommand("docs", "Write the reference pages of all plugins found");
    writing->add_option("folder", options->name, "Folder for the pages (Markdown)")
        ->required()
        ->check(CLI::ExistingDirectory);
    add_plugin_path_option(*writing, options->plugin_path);
    writing->footer("Example: kolize plugins docs docs/plugins");
    writing->callback([options] { docs(*options); });
}

}  // namespace kolize::cli
