// docs/plugins.md done as it stands there: its code is built by its own lines, outside the tree, and its commands are
// run. The document cannot say what is not so.
#include "framework/mesh_files.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <sstream>
#include <sys/wait.h>

namespace {

using kolize::test::file_bytes;
using nlohmann::json;

struct Document {
    std::vector<std::string> code;      // each ```cpp block
    std::vector<std::string> commands;  // what is to be typed: indented lines that build a plugin or run the program
};

Document read_document(const std::filesystem::path& file) {
    Document document;
    std::istringstream stream(file_bytes(file));
    bool in_code = false;
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("```")) {
            in_code = line == "```cpp";
            if (in_code) document.code.emplace_back();
        } else if (in_code) {
            document.code.back() += line + '\n';
        } else if (line.starts_with("    g++ ") || line.starts_with("    $kolize ")) {
            document.commands.push_back(line.substr(4));
        }
    }
    return document;
}

// "// my/sweep.cpp: sweep and prune ..." names the file.
std::string file_name(const std::string& code) { return code.substr(3, code.find(':') - 3); }

void replace(std::string& text, const std::string& what, const std::string& with) {
    if (const std::size_t at = text.find(what); at != std::string::npos) text.replace(at, what.size(), with);
}

// A folder that holds of the repository what the commands of the document name.
class Outside {
public:
    Outside() {
        for (const char* name : {"framework", "demos"})
            std::filesystem::create_directory_symlink(std::filesystem::path(KOLIZE_SOURCE_DIR) / name,
                                                      folder_.path() / name);
        std::filesystem::create_directory(folder_.path() / "my");
    }

    void write(const std::string& name, const std::string& code) const { folder_.write(name, code); }

    // The exit code. Compiler and Eigen are those of this build, which need not be the document's.
    int type(std::string command) const {
        replace(command, "g++", "'" KOLIZE_CXX "' " KOLIZE_CXX_FLAGS);
        replace(command, "/usr/include/eigen3", "'" KOLIZE_EIGEN_DIR "'");
        const std::string there =
            "cd '" + folder_.path().string() + "' && kolize='" KOLIZE_BINARY_DIR "/bin/kolize' && ";
        return WEXITSTATUS(std::system((there + command + " >out.txt 2>err.txt").c_str()));
    }
    std::string out() const { return file_bytes(folder_.path() / "out.txt"); }
    std::string err() const { return file_bytes(folder_.path() / "err.txt"); }

    // The state at the end of a short run with these settings.
    std::string state_hash(const std::string& settings) const {
        const int code =
            type("$kolize run demos/box_objects/scene.toml --plugin-path my --time 2 --json - " + settings);
        INFO(settings << "\n" << err());
        REQUIRE(code == 0);
        return json::parse(out())["state_hash"];
    }

private:
    kolize::test::ScratchFolder folder_;
};

}  // namespace

TEST_CASE("the plugins of docs/plugins.md are built outside the tree, keep their contracts and run", "[cli][plugins]") {
    const Document document = read_document(KOLIZE_SOURCE_DIR "/docs/plugins.md");
    REQUIRE(document.code.size() == 2);
    const Outside outside;
    std::size_t built = 0, tested = 0;
    for (const std::string& code : document.code) outside.write(file_name(code), code);
    for (const std::string& command : document.commands) {
        const int code = outside.type(command);
        INFO(command << "\n" << outside.out() << outside.err());
        CHECK(code == 0);
        built += command.starts_with("g++ ");
        tested += command.starts_with("$kolize plugins test ");
    }
    CHECK(built == 2);
    CHECK(tested == 2);
    const std::string ours = outside.state_hash("");
    CHECK(outside.state_hash("--set broadphase.plugin=sweep --set broadphase.axis=y") == ours);
    CHECK(outside.state_hash("--set narrowphase.plugin=edges --set narrowphase.planes_first=false") == ours);
}
