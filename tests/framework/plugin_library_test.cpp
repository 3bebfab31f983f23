#include "plugin_folder.h"

#include <catch2/catch.hpp>
#include <kolize/simulation.h>

#include <cstdlib>

using namespace kolize;

namespace {

StageConfig fixture_config(const std::map<std::string, Setting>& settings) {
    return {"fixture", {"scene.toml", 12, 10}, settings};
}

Setting setting(Value value) { return {std::move(value), {"scene.toml", 13, 1}}; }

// The message of the Error that making a broadphase ends with.
std::string failure(const PluginLibrary& library, const StageConfig& config) {
    const auto host = make_host(1);
    try {
        library.make<Broadphase>(config, *host);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::string fixture_failure(const std::map<std::string, Setting>& settings) {
    PluginFolder folder;
    folder.link("good");
    return failure(PluginLibrary({folder.path()}), fixture_config(settings));
}

class EnvironmentVariable {
public:
    EnvironmentVariable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
    ~EnvironmentVariable() { unsetenv(name_); }

private:
    const char* name_;
};

}  // namespace

TEST_CASE("a plugin is found by stage and name and carries its descriptor", "[plugins]") {
    PluginFolder folder;
    folder.link("good").write("readme.txt", "no library");
    const PluginLibrary library({folder.path()});
    CHECK(library.refused().empty());
    const LoadedPlugin* plugin = library.find(StageKind::broadphase, "fixture");
    REQUIRE(plugin != nullptr);
    CHECK(plugin->file == folder.path() / "good.so");
    CHECK(plugin->descriptor->summary == std::string("every overlapping pair"));
    CHECK(plugin->parameters.items.size() == 4);
    CHECK(library.find(StageKind::narrowphase, "fixture") == nullptr);
    CHECK(&library.require(StageKind::broadphase, "fixture") == plugin);
}

TEST_CASE("a stage is made with its parameters and does its work", "[plugins]") {
    PluginFolder folder;
    folder.link("good");
    const PluginLibrary library({folder.path()});
    const auto host = make_host(1);
    const auto stage = library.make<Broadphase>(
        fixture_config({{"passes", setting(std::int64_t{5})}, {"cell_size", setting(std::int64_t{3})}}), *host);

    const auto settings = effective_settings(*library.find(StageKind::broadphase, "fixture"), *stage);
    const std::vector<std::pair<std::string, Value>> expected = {
        {"strict", false}, {"passes", std::int64_t{5}}, {"cell_size", 3.0}, {"precision", std::string("double")}};
    CHECK(settings == expected);

    const std::vector<Aabb> bounds(3, {Vec3::Zero(), Vec3::Ones()});
    const std::vector<std::uint8_t> is_static(3, 0);
    std::vector<Pair> pairs;
    stage->find_pairs({bounds, is_static, 0}, pairs);
    CHECK(pairs == std::vector<Pair>{{0, 1}, {0, 2}, {1, 2}});
}

TEST_CASE("a stage outlives the library object that made it", "[plugins]") {
    PluginFolder folder;
    folder.link("good");
    const auto host = make_host(1);
    const auto stage = PluginLibrary({folder.path()}).make<Broadphase>(fixture_config({}), *host);
    std::vector<Pair> pairs;
    stage->find_pairs({}, pairs);
    CHECK(pairs.empty());
}

TEST_CASE("a misspelt parameter is an error with its place and the nearest name", "[plugins]") {
    CHECK(fixture_failure({{"cel_size", setting(1.0)}}) ==
          "scene.toml:13:1: no parameter 'cel_size' in broadphase 'fixture'; did you mean 'cell_size'?");
    CHECK(fixture_failure({{"colour", setting(1.0)}}) ==
          "scene.toml:13:1: no parameter 'colour' in broadphase 'fixture'; "
          "its parameters: strict, passes, cell_size, precision");
}

TEST_CASE("a bad value is an error with its place and what would be right", "[plugins]") {
    CHECK(fixture_failure({{"cell_size", setting(-1.0)}}) ==
          "scene.toml:13:1: parameter 'cell_size' of broadphase 'fixture' must be from 0 to 1e9 m, is -1.0");
    CHECK(fixture_failure({{"precision", setting(std::string("half"))}}) ==
          "scene.toml:13:1: parameter 'precision' of broadphase 'fixture' "
          "must be one of \"float\", \"double\", is \"half\"");
}

TEST_CASE("parameters that do not go together are an error with the plugin's place", "[plugins]") {
    PluginFolder folder;
    folder.link("good");
    const StageConfig config =
        fixture_config({{"precision", setting(std::string("float"))}, {"cell_size", setting(2e6)}});
    CHECK(failure(PluginLibrary({folder.path()}), config) ==
          "scene.toml:12:10: broadphase 'fixture' (" + folder.file("good.so") +
              ") refuses its parameters: cell_size above 1e6 m needs precision = \"double\"");
}

TEST_CASE("a plugin that cannot make its stage is an error, whatever it throws", "[plugins]") {
    const auto failure_of = [](const std::string& name) {
        PluginFolder folder;
        folder.link(name, "x.so");
        const std::string message = failure(PluginLibrary({folder.path()}), fixture_config({}));
        const std::string beginning =
            "scene.toml:12:10: broadphase 'fixture' (" + folder.file("x.so") + ") cannot be made: ";
        REQUIRE_THAT(message, Catch::StartsWith(beginning));
        return message.substr(beginning.size());
    };
    CHECK(failure_of("throwing_create") == "no grid today");
    CHECK(failure_of("number_throwing_create") == "it threw something that is not a std::exception");
    CHECK(failure_of("empty_create") == "its create function gave nothing");
}

TEST_CASE("a plugin that makes another kind of stage than it says is an error", "[plugins]") {
    PluginFolder folder;
    folder.link("false_stage");
    const PluginLibrary library({folder.path()});
    const auto host = make_host(1);
    CHECK_THROWS_WITH(library.make<Response>(fixture_config({}), *host),
                      "scene.toml:12:10: response 'fixture' (" + folder.file("false_stage.so") +
                          ") cannot be made: what it creates is no response");
}

TEST_CASE("a plugin that is not found is an error that says where it was looked for", "[plugins]") {
    PluginFolder first, second;
    first.link("good").link("twin_a").link("other_api");
    second.link("liar_narrowphase");
    const std::string nowhere = first.file("nowhere");
    const PluginLibrary library({first.path(), nowhere, second.path()});
    const std::string lists = "\n  found: fixture, twin\n  searched: " + first.path().string() + ", " + nowhere +
                              " (no such folder), " + second.path().string() +
                              "\n  refused: " + first.file("other_api.so") + ": plugin API number: host " +
                              std::to_string(plugin_api) + ", plugin 99";
    CHECK_THROWS_WITH(library.require(StageKind::broadphase, "fixtrue", {"scene.toml", 12, 10}),
                      "scene.toml:12:10: no broadphase 'fixtrue'; did you mean 'fixture'?" + lists);
    CHECK_THROWS_WITH(library.require(StageKind::broadphase, "octree"), "no broadphase 'octree'" + lists);
    CHECK_THROWS_AS(library.require(StageKind::broadphase, "liar"), Error);
}

TEST_CASE("without any plugin the error says so", "[plugins]") {
    CHECK_THROWS_WITH(PluginLibrary({}).require(StageKind::response, "impulse"),
                      "no response 'impulse'\n  found: none\n  searched: none");
}

TEST_CASE("of two folders with the same plugin the first one wins without a word", "[plugins]") {
    PluginFolder first, second;
    first.link("good", "z.so");
    second.link("good", "a.so");
    const PluginLibrary library({first.path(), second.path()});
    CHECK(library.refused().empty());
    REQUIRE(library.plugins().size() == 1);
    CHECK(library.plugins().front().file == first.path() / "z.so");
}

TEST_CASE("a folder that is named twice is searched once", "[plugins]") {
    PluginFolder folder;
    folder.link("good").link("other_api");
    const PluginLibrary library({folder.path(), folder.path() / ".", folder.path()});
    CHECK(library.folders() == std::vector<std::filesystem::path>{folder.path()});
    CHECK(library.refused().size() == 1);
}

TEST_CASE("options come before the scene's folder, the environment and the executable's", "[plugins]") {
    const EnvironmentVariable variable("KOLIZE_PLUGIN_PATH", "/from/environment::/second");
    const auto folders = PluginLibrary::search_path({"/option"}, "/scene");
    REQUIRE(folders.size() == 5);
    CHECK(folders[0] == "/option");
    CHECK(folders[1] == "/scene");
    CHECK(folders[2] == "/from/environment");
    CHECK(folders[3] == "/second");
    CHECK(std::filesystem::weakly_canonical(folders[4]) == std::filesystem::weakly_canonical(KOLIZE_PLUGIN_DIR));
}

TEST_CASE("the plugins beside the executable are all taken", "[plugins]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    for (const RefusedPlugin& refused : library.refused()) FAIL_CHECK(refused.file.string() + ": " + refused.reason);
    CHECK(library.find(StageKind::broadphase, "brute_force") != nullptr);
}
