#include "plugin_file.h"

#include <boost/dll/runtime_symbol_info.hpp>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace kolize {

namespace {

namespace fs = std::filesystem;

// Folders by their first mention: a second look at the same one would only repeat what was refused there.
std::vector<fs::path> without_repetitions(const std::vector<fs::path>& folders) {
    std::vector<fs::path> seen, result;
    for (const fs::path& folder : folders) {
        std::error_code ignored;
        const fs::path real = fs::weakly_canonical(folder, ignored);
        if (folder.empty() || std::find(seen.begin(), seen.end(), real) != seen.end()) continue;
        seen.push_back(real);
        result.push_back(folder);
    }
    return result;
}

// By name, so that what is found does not depend on the order of a directory's entries.
std::vector<fs::path> libraries_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code unreadable;
    for (fs::directory_iterator entry(folder, unreadable), end; !unreadable && entry != end;
         entry.increment(unreadable))
        if (entry->path().extension() == ".so") files.push_back(entry->path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string quoted(const std::string& text) { return "'" + text + "'"; }

std::string title(StageKind stage, const std::string& name) {
    return std::string(to_string(stage)) + " " + quoted(name);
}

std::string title(const LoadedPlugin& plugin) { return title(plugin.descriptor->stage, plugin.descriptor->name); }

std::string joined(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
    return list.empty() ? "none" : list;
}

std::vector<std::string> described(const std::vector<fs::path>& folders) {
    std::vector<std::string> result;
    for (const fs::path& folder : folders) {
        std::error_code ignored;
        result.push_back(folder.string() + (fs::is_directory(folder, ignored) ? "" : " (no such folder)"));
    }
    return result;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
    const std::string nearest = nearest_name(word, candidates);
    return nearest.empty() ? "" : "; did you mean " + quoted(nearest) + "?";
}

// Runs a function of the plugin; whatever it throws becomes an Error that names the plugin, its file and the place.
template <class Function>
auto guarded(const LoadedPlugin& plugin, const SourceLocation& where, const char* deed, Function&& function) {
    const std::string subject = title(plugin) + " (" + plugin.file.string() + ") " + deed + ": ";
    try {
        return function();
    } catch (const std::exception& failure) {
        throw Error(where, subject + failure.what());
    } catch (...) {
        throw Error(where, subject + "it threw something that is not a std::exception");
    }
}

bool is_of_kind(const Stage* stage, StageKind kind) {
    switch (kind) {
    case StageKind::broadphase: return dynamic_cast<const Broadphase*>(stage);
    case StageKind::narrowphase: return dynamic_cast<const Narrowphase*>(stage);
    case StageKind::response: return dynamic_cast<const Response*>(stage);
    case StageKind::render: return dynamic_cast<const Renderer*>(stage);
    }
    return false;
}

StagePtr<Stage> create(const LoadedPlugin& plugin, const SourceLocation& where) {
    const PluginDescriptor& descriptor = *plugin.descriptor;
    return guarded(plugin, where, "cannot be made", [&] {
        StagePtr<Stage> stage(descriptor.create(), descriptor.destroy);
        if (!stage) throw std::logic_error("its create function gave nothing");
        if (!is_of_kind(stage.get(), descriptor.stage))
            throw std::logic_error(std::string("what it creates is no ") + to_string(descriptor.stage));
        return stage;
    });
}

std::string unknown_parameter(const LoadedPlugin& plugin, const std::string& name) {
    std::vector<std::string> names;
    for (const Parameter& parameter : plugin.parameters.items) names.push_back(parameter.name);
    const std::string nearest = suggestion(name, names);
    return "no parameter " + quoted(name) + " in " + title(plugin) +
           (nearest.empty() ? "; its parameters: " + joined(names) : nearest);
}

// Copies what it needs of the library: stages outlive it.
class OtherBroadphases final : public BroadphaseChoice {
public:
    OtherBroadphases(const std::vector<LoadedPlugin>& plugins, Host& host) : host_(host) {
        for (const LoadedPlugin& plugin : plugins)
            if (plugin.descriptor->stage == StageKind::broadphase && !plugin.descriptor->capabilities.chooses)
                plugins_.push_back(plugin);
    }
    std::size_t size() const override { return plugins_.size(); }
    const char* name(std::size_t i) const override { return plugins_[i].descriptor->name; }
    std::shared_ptr<Broadphase> make(std::size_t i) const override {
        StagePtr<Stage> stage = create(plugins_[i], {});
        guarded(plugins_[i], {}, "refuses its parameters", [&] { stage->attach(host_); });
        const auto destroy = stage.get_deleter();
        return {static_cast<Broadphase*>(stage.release()), destroy};
    }

private:
    std::vector<LoadedPlugin> plugins_;
    Host& host_;
};

void apply(const LoadedPlugin& plugin, const std::string& name, const Setting& setting, Stage& stage) {
    const Parameter* parameter = plugin.parameters.find(name);
    if (!parameter) throw Error(setting.where, unknown_parameter(plugin, name));
    const std::string complaint = parameter->complaint(setting.value);
    if (!complaint.empty())
        throw Error(setting.where, "parameter " + quoted(name) + " of " + title(plugin) + " " + complaint);
    parameter->set(stage, parameter->coerce(setting.value));
}

}  // namespace

PluginLibrary::PluginLibrary(std::vector<fs::path> folders) : folders_(without_repetitions(folders)) {
    for (const fs::path& folder : folders_) load_folder(folder);
}

std::vector<fs::path> PluginLibrary::search_path(const std::vector<fs::path>& options, const fs::path& scene_folder) {
    std::vector<fs::path> folders = options;
    folders.push_back(scene_folder.empty() ? fs::path(".") : scene_folder);
    if (const char* variable = std::getenv("KOLIZE_PLUGIN_PATH")) {
        std::istringstream entries(variable);
        for (std::string entry; std::getline(entries, entry, ':');) folders.push_back(entry);
    }
    folders.push_back(boost::dll::program_location().parent_path().parent_path() / "lib" / "kolize");
    return without_repetitions(folders);
}

void PluginLibrary::load_folder(const fs::path& folder) {
    for (const fs::path& file : libraries_in(folder)) {
        try {
            take(load_plugin(file));
        } catch (const Refusal& refusal) {
            refused_.push_back({file, refusal.what()});
        }
    }
}

void PluginLibrary::take(LoadedPlugin plugin) {
    const LoadedPlugin* rival = find(plugin.descriptor->stage, plugin.descriptor->name);
    if (!rival)
        plugins_.push_back(std::move(plugin));
    else if (rival->file.parent_path() == plugin.file.parent_path())
        throw Refusal("another " + title(plugin) + " is in this folder: " + rival->file.filename().string());
}

const LoadedPlugin* PluginLibrary::find(StageKind stage, const std::string& name) const {
    const auto found = std::find_if(plugins_.begin(), plugins_.end(), [&](const LoadedPlugin& plugin) {
        return plugin.descriptor->stage == stage && plugin.descriptor->name == name;
    });
    return found == plugins_.end() ? nullptr : &*found;
}

const LoadedPlugin& PluginLibrary::require(StageKind stage, const std::string& name,
                                           const SourceLocation& where) const {
    if (const LoadedPlugin* plugin = find(stage, name)) return *plugin;
    const std::vector<std::string> found = names(stage);
    std::string message = "no " + title(stage, name) + suggestion(name, found);
    message += "\n  found: " + joined(found) + "\n  searched: " + joined(described(folders_));
    for (const RefusedPlugin& refused : refused_)
        message += "\n  refused: " + refused.file.string() + ": " + refused.reason;
    throw Error(where, message);
}

std::vector<std::string> PluginLibrary::names(StageKind stage) const {
    std::vector<std::string> result;
    for (const LoadedPlugin& plugin : plugins_)
        if (plugin.descriptor->stage == stage) result.emplace_back(plugin.descriptor->name);
    std::sort(result.begin(), result.end());
    return result;
}

StagePtr<Stage> PluginLibrary::make_stage(StageKind kind, const StageConfig& config, Host& host) const {
    const LoadedPlugin& plugin = require(kind, config.plugin, config.where);
    StagePtr<Stage> stage = create(plugin, config.where);
    for (const auto& [name, setting] : config.settings) apply(plugin, name, setting, *stage);
    guarded(plugin, config.where, "refuses its parameters", [&] { stage->attach(host); });
    if (auto* broadphase = dynamic_cast<Broadphase*>(stage.get());
        broadphase && plugin.descriptor->capabilities.chooses)
        guarded(plugin, config.where, "finds nothing to choose from",
                [&] { broadphase->choose_from(std::make_shared<OtherBroadphases>(plugins_, host)); });
    return stage;
}

std::vector<std::pair<std::string, Value>> effective_settings(const LoadedPlugin& plugin, const Stage& stage) {
    std::vector<std::pair<std::string, Value>> settings;
    for (const Parameter& parameter : plugin.parameters.items)
        settings.emplace_back(parameter.name, parameter.get(stage));
    return settings;
}

}  // namespace kolize
