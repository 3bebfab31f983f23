#include "cli/shell.h"
#include "oracle/allocation_counter.h"

#include <kolize/plugin_library.h>

#include <catch2/catch.hpp>

#include <set>

using namespace kolize;
using namespace kolize::test;

namespace {

std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".md") names.insert(entry.path().filename().string());
    return names;
}

}  // namespace

TEST_CASE("every plugin of ours says where it comes from, what it costs, how right it is and when to choose it",
          "[plugins]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    REQUIRE(library.plugins().size() >= 20);
    for (const LoadedPlugin& plugin : library.plugins()) {
        const PluginDescriptor& d = *plugin.descriptor;
        CAPTURE(d.name);
        for (const char* text : {d.summary, d.source, d.cost, d.accuracy, d.choose})
            CHECK_FALSE(std::string(text).empty());
        for (const Parameter& parameter : plugin.parameters.items) {
            CAPTURE(parameter.name);
            CHECK_FALSE(parameter.doc.empty());
        }
    }
}

TEST_CASE("the reference pages are those that the program writes", "[plugins]") {
    if (!AllocationCounter::available()) return;  // a check more would not apply
    const Shell shell;
    REQUIRE(shell.kolize("plugins docs .").code == 0);
    const std::filesystem::path pages = KOLIZE_SOURCE_DIR "/docs/plugins";
    INFO("run kolize plugins docs docs/plugins");
    CHECK(names_in(pages) == names_in(shell.folder.path()));
    for (const std::string& name : names_in(shell.folder.path())) {
        CAPTURE(name);
        const bool same = file_bytes(pages / name) == file_bytes(shell.folder.path() / name);
        CHECK(same);  // compared first: a diff of pages helps nobody
    }
}

TEST_CASE("pages go into a folder that exists", "[plugins]") {
    const Shell shell;
    const Outcome outcome = shell.kolize("plugins docs nowhere");
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("nowhere") != std::string::npos);
}
