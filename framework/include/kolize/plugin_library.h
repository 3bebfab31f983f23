// The plugin host: finds, checks, loads and pins plugin libraries (Boost.DLL), and makes stages from them.
#pragma once

#include <kolize/error.h>
#include <kolize/plugin.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace kolize {

struct LoadedPlugin {
    const PluginDescriptor* descriptor = nullptr;  // lives for ever: libraries are never unloaded
    std::filesystem::path file;
    ParameterList parameters;
};

// A library that was looked at and not taken, with the one sentence that says why.
struct RefusedPlugin {
    std::filesystem::path file;
    std::string reason;
};

struct Setting {
    Value value;
    SourceLocation where;
};

// One stage of a pipeline as it was configured.
struct StageConfig {
    std::string plugin;
    SourceLocation where;                     // of the plugin's name
    std::map<std::string, Setting> settings;  // the plugin's own parameters, not yet checked
};

template <class T>
using StagePtr = std::unique_ptr<T, void (*)(Stage*)>;

class KOLIZE_API PluginLibrary {
public:
    // Searches the folders in order; of two plugins with the same stage and name in different folders the first one
    // wins; within one folder the second one (by file name) is refused. Folders that do not exist are passed over.
    explicit PluginLibrary(std::vector<std::filesystem::path> folders);

    // --plugin-path entries, the scene's folder, KOLIZE_PLUGIN_PATH (':' between entries), then ../lib/kolize seen from
    // the executable's folder (the same in the build tree and in an installation).
    static std::vector<std::filesystem::path> search_path(const std::vector<std::filesystem::path>& options,
                                                          const std::filesystem::path& scene_folder);

    const std::vector<LoadedPlugin>& plugins() const { return plugins_; }
    const std::vector<RefusedPlugin>& refused() const { return refused_; }
    const std::vector<std::filesystem::path>& folders() const { return folders_; }

    // nullptr if there is none.
    const LoadedPlugin* find(StageKind stage, const std::string& name) const;
    // Throws Error: folders searched, names found for the stage, the nearest name, refused libraries with reasons.
    const LoadedPlugin& require(StageKind stage, const std::string& name, const SourceLocation& where = {}) const;
    // Plugin names of one stage, sorted.
    std::vector<std::string> names(StageKind stage) const;

    // Makes a stage, checks and sets its parameters and attaches it. Throws Error with the setting's place.
    template <class T>
    StagePtr<T> make(const StageConfig& config, Host& host) const {
        StagePtr<Stage> stage = make_stage(T::kind, config, host);
        auto destroy = stage.get_deleter();
        return StagePtr<T>(static_cast<T*>(stage.release()), destroy);
    }

private:
    StagePtr<Stage> make_stage(StageKind kind, const StageConfig& config, Host& host) const;
    void load_folder(const std::filesystem::path& folder);
    void take(LoadedPlugin plugin);

    std::vector<std::filesystem::path> folders_;
    std::vector<LoadedPlugin> plugins_;
    std::vector<RefusedPlugin> refused_;
};

// The parameters of a stage as they are in force, for the echo in results.
KOLIZE_API std::vector<std::pair<std::string, Value>> effective_settings(const LoadedPlugin& plugin,
                                                                         const Stage& stage);

}  // namespace kolize
