// A plugin folder of a test's own, filled with links to the fixture libraries and with files made up on the spot.
#pragma once

#include <kolize/plugin_library.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace kolize {

// Links, not copies: the loader knows a library by its inode, and those of deleted copies would be given out again.
class PluginFolder {
public:
    PluginFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "kolize_plugins_XXXXXX").string();
        if (!mkdtemp(name.data())) throw std::runtime_error("cannot make the folder " + name);
        path_ = name;
    }
    ~PluginFolder() { std::filesystem::remove_all(path_); }
    PluginFolder(const PluginFolder&) = delete;
    PluginFolder& operator=(const PluginFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::string file(const std::string& name) const { return (path_ / name).string(); }

    static std::filesystem::path fixture(const std::string& name) {
        return std::filesystem::path(KOLIZE_BAD_PLUGIN_DIR) / (name + ".so");
    }
    PluginFolder& link(const std::string& fixture_name) { return link(fixture_name, fixture_name + ".so"); }
    PluginFolder& link(const std::string& fixture_name, const std::string& as) {
        std::filesystem::create_symlink(fixture(fixture_name), path_ / as);
        return *this;
    }
    PluginFolder& write(const std::string& name, const std::string& bytes) {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return *this;
    }

private:
    std::filesystem::path path_;
};

// All bytes of the good fixture library.
inline std::string good_library() {
    std::ifstream in(PluginFolder::fixture("good"), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace kolize
