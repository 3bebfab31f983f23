#include <kolize/expectation.h>

#include "framework/mesh_files.h"

#include <catch2/catch.hpp>

using namespace kolize;

namespace {

std::vector<Expectation> read(const std::string& text) {
    const test::ScratchFolder folder;
    folder.write("fast.toml", "");
    return read_expectations(folder.write("expect.toml", text));
}

}  // namespace

TEST_CASE("an expectation says how to run and what must come out", "[expectation]") {
    const std::vector<Expectation> expectations = read(R"([[expect]]
pipeline = "fast.toml"
steps = 100
set = { step.dt = 0.5, "broadphase.plugin" = "grid" }
energy_drift = { max = 1e-12 }
contacts = { min = 10, max = 20 }
[[expect]]
time = 2
escaped = { max = 0 }
)");
    REQUIRE(expectations.size() == 2);
    CHECK(expectations[0].pipeline == "fast.toml");
    CHECK(expectations[0].pipeline_file.filename() == "fast.toml");
    CHECK(expectations[0].steps == 100);
    const std::vector<std::pair<std::string, std::string>> set = {{"broadphase.plugin", "'grid'"}, {"step.dt", "0.5"}};
    CHECK(expectations[0].set == set);
    REQUIRE(expectations[0].bounds.size() == 2);
    CHECK(expectations[1].pipeline.empty());
    CHECK(expectations[1].time == 2);
}

TEST_CASE("each broken bound is one failure, and what is not finite breaks any bound", "[expectation]") {
    const Expectation expectation =
        read("[[expect]]\nenergy_drift = { max = 0.5 }\ncontacts = { min = 10, max = 20 }\n")[0];
    RunResult result;
    const auto count = [&](double drift, std::uint64_t contacts) {
        result.energy_drift = drift;
        result.contacts = contacts;
        return failures(expectation, result).size();
    };
    CHECK(count(0.5, 10) == 0);
    CHECK(count(0.5, 20) == 0);
    CHECK(count(0.6, 10) == 1);
    CHECK(count(0.5, 9) == 1);
    CHECK(count(0.6, 21) == 2);
    CHECK(count(std::nan(""), 10) == 1);
    count(0.75, 10);
    CHECK(failures(expectation, result)[0].find(":2:16: energy_drift is 0.75, expected at most 0.5") !=
          std::string::npos);
}

TEST_CASE("a broken expectation is refused in a sentence", "[expectation]") {
    const auto [text, sentence] = GENERATE(table<std::string, std::string>({
        {"[[expected]]", ":1:3: no table 'expected' in expectations; only [[expect]]"},
        {"[[expect]]", ":1:1: [[expect]] needs a bound such as stuck = { max = 0 }"},
        {"[[expect]]\nstuk = { max = 0 }", ":2:1: no key 'stuk' in [[expect]]; did you mean 'stuck'?"},
        {"[[expect]]\nstuck = 0", ":2:9: stuck must be a table such as { max = 0 }"},
        {"[[expect]]\nstuck = {}", ":2:9: stuck needs min or max"},
        {"[[expect]]\nstuck = { min = 2, max = 1 }", ":2:26: max must not be less than min"},
        {"[[expect]]\ntime = 1\nsteps = 1", ":3:9: steps cannot stand beside time"},
    }));
    std::string said;
    try {
        read(text);
    } catch (const Error& error) {
        said = error.what();
    }
    INFO(said);
    CHECK(said.substr(std::min(said.size(), said.rfind("expect.toml") + 11)) == sentence);
}
