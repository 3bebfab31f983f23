#include "plugin_file.h"

#include "shared_object.h"
#include "trial_load.h"

#include <boost/dll/shared_library.hpp>
#include <dlfcn.h>

#include <cinttypes>
#include <cstdio>
#include <set>

namespace kolize {

namespace {

using boost::dll::shared_library;

std::string decimal(std::uint64_t number) { return std::to_string(number); }

std::string hexadecimal(std::uint64_t number) {
    char text[20];
    std::snprintf(text, sizeof text, "0x%016" PRIx64, number);
    return text;
}

std::string version(std::uint64_t number) {
    return decimal(number / 10000) + "." + decimal(number / 100 % 100) + "." + decimal(number % 100);
}

// The fields in the order of AbiTag: where an earlier one differs, the later ones may stand elsewhere.
void require_same_abi(const AbiTag& plugin) {
    const AbiTag host;
    const auto require_same = [](const char* field, auto ours, auto theirs, std::string (*text)(std::uint64_t)) {
        if (ours != theirs) throw Refusal(std::string(field) + ": host " + text(ours) + ", plugin " + text(theirs));
    };
    require_same("magic number", host.magic, plugin.magic, hexadecimal);
    require_same("plugin API number", host.api, plugin.api, decimal);
    require_same("scalar size (bytes)", host.scalar_bytes, plugin.scalar_bytes, decimal);
    require_same("Eigen alignment (compiler flags)", host.eigen_alignment, plugin.eigen_alignment, decimal);
    require_same("Eigen version", host.eigen_version, plugin.eigen_version, version);
    require_same("std::string ABI (_GLIBCXX_USE_CXX11_ABI)", host.cxx11_strings, plugin.cxx11_strings, decimal);
    require_same("debug standard library (_GLIBCXX_DEBUG)", host.debug_stl, plugin.debug_stl, decimal);
    require_same("layout of the shared types (plugin is stale)", host.layout, plugin.layout, hexadecimal);
}

bool is_missing(const char* text) { return !text || !*text; }

void require_sound(const PluginDescriptor& plugin) {
    if (plugin.stage > StageKind::render)
        throw Refusal("its stage number is " + decimal(static_cast<std::uint32_t>(plugin.stage)) +
                      ", must be 0 (broadphase), 1 (narrowphase), 2 (response) or 3 (render)");
    if (is_missing(plugin.name)) throw Refusal("its descriptor gives no name");
    if (is_missing(plugin.summary)) throw Refusal("its descriptor gives no summary");
    if (is_missing(plugin.source)) throw Refusal("its descriptor gives no source");
    if (!plugin.declare) throw Refusal("its descriptor names no declare function");
    if (!plugin.create) throw Refusal("its descriptor names no create function");
    if (!plugin.destroy) throw Refusal("its descriptor names no destroy function");
}

// Never unloaded: an object that outlives its library would crash.
shared_library open_for_ever(const std::filesystem::path& file) {
    constexpr auto no_delete = static_cast<boost::dll::load_mode::type>(RTLD_NODELETE);
    try {
        return shared_library(file, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local | no_delete);
    } catch (const std::exception& failure) {
        throw Refusal(std::string("cannot be loaded: ") + failure.what());
    }
}

ParameterList declared_parameters(const PluginDescriptor& plugin) {
    ParameterList list;
    try {
        plugin.declare(list);
    } catch (const std::exception& failure) {
        throw Refusal(std::string("the declaration of its parameters threw: ") + failure.what());
    } catch (...) {
        throw Refusal("the declaration of its parameters threw something that is not a std::exception");
    }
    return list;
}

}  // namespace

void require_sound(const ParameterList& parameters) {
    std::set<std::string> seen;
    for (const Parameter& parameter : parameters.items) {
        if (parameter.name.empty()) throw Refusal("it declares a parameter without a name");
        if (!seen.insert(parameter.name).second)
            throw Refusal("it declares the parameter '" + parameter.name + "' twice");
        if (const std::string complaint = parameter.complaint(parameter.default_value); !complaint.empty())
            throw Refusal("the default of its parameter '" + parameter.name + "' " + complaint);
    }
}

LoadedPlugin load_plugin(const std::filesystem::path& file) {
    if (const std::string defect = shared_object_defect(file); !defect.empty()) throw Refusal(defect);
    if (const std::string defect = trial_load_defect(file); !defect.empty()) throw Refusal(defect);
    const shared_library library = open_for_ever(file);
    if (!library.has("kolize_plugin")) throw Refusal("exports no kolize_plugin: not a kolize plugin");
    const auto& plugin = library.get<const PluginDescriptor>("kolize_plugin");
    require_same_abi(plugin.abi);
    require_sound(plugin);
    LoadedPlugin loaded{&plugin, file, declared_parameters(plugin)};
    require_sound(loaded.parameters);
    return loaded;
}

}  // namespace kolize
