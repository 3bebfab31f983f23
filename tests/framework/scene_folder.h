// Scenes written into a folder of their own, for tests of what is read and what is refused.
#pragma once

#include <kolize/scene.h>

#include "framework/mesh_files.h"

namespace kolize::test {

inline const PluginDefaults defaults{"grid", "moller", "impulse"};
inline const PluginLibrary no_plugins({});
using Set = std::vector<std::pair<std::string, std::string>>;

// Files beside each other in a folder of their own; "DIR/" in messages stands for it.
class SceneFolder {
public:
    SceneFolder& write(const std::string& name, const std::string& text) {
        folder_.write(name, text);
        return *this;
    }
    Scene load(const Set& set = {}, const std::string& pipeline = "") const {
        const std::filesystem::path file = pipeline.empty() ? std::filesystem::path() : folder_.path() / pipeline;
        return load_scene(folder_.path() / "scene.toml", {file, set, defaults}, no_plugins);
    }
    std::string complaint(const Set& set = {}, const std::string& pipeline = "") const {
        try {
            load(set, pipeline);
        } catch (const Error& error) {
            return shortened(error.what());
        }
        return "";
    }

private:
    std::string shortened(std::string text) const {
        const std::string prefix = folder_.path().string() + "/";
        for (std::size_t at; (at = text.find(prefix)) != std::string::npos;) text.erase(at, prefix.size());
        return text;
    }
    ScratchFolder folder_;
};

inline std::string complaint(const std::string& scene, const Set& set = {}) {
    return SceneFolder().write("scene.toml", scene).complaint(set);
}

inline const std::string ball = "[[shape]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 1\n";

// A tetrahedron with its corner at the origin, outward.
inline const std::string tetrahedron_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
inline const std::string tetrahedron = tetrahedron_vertices + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

}  // namespace kolize::test
