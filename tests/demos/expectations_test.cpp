// Every demo keeps what it promises in demos/NAME/expect.toml.
#include <kolize/expectation.h>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace kolize;

TEST_CASE("every demo holds its expectations", "[demos]") {
    const PluginLibrary plugins({KOLIZE_PLUGIN_DIR});
    const std::unique_ptr<Host> host = make_host(1);
    std::vector<std::filesystem::path> demos;
    for (const auto& entry : std::filesystem::directory_iterator(KOLIZE_SOURCE_DIR "/demos"))
        if (std::filesystem::exists(entry.path() / "expect.toml")) demos.push_back(entry.path());
    std::sort(demos.begin(), demos.end());
    REQUIRE(!demos.empty());
    for (const std::filesystem::path& demo : demos)
        for (const Expectation& expectation : read_expectations(demo / "expect.toml")) {
            const ExpectationOutcome outcome =
                run_expectation(expectation, demo / "scene.toml", {"grid", "moller", "impulse"}, plugins, *host);
            CAPTURE(demo.filename().string(), outcome.what, outcome.failures);
            CHECK(outcome.failures.empty());
        }
}
