// kolize run --trace, read as a viewer of traces reads it.
#include "cli/crowd.h"
#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <map>

using namespace kolize::test;
using nlohmann::json;

namespace {

// In nanoseconds, which the format's decimals hold exactly.
struct Stretch {
    long long begin, end;
    std::string name;
};

std::vector<Stretch> stretches(const json& trace) {
    std::vector<Stretch> all;
    const auto nanoseconds = [](const json& microseconds) { return std::llround(1e3 * microseconds.get<double>()); };
    for (const json& event : trace["traceEvents"])
        if (event["ph"] == "X") {
            const long long begin = nanoseconds(event["ts"]);
            all.push_back({begin, begin + nanoseconds(event["dur"]), event["name"]});
        }
    // What contains comes before what it contains.
    std::sort(all.begin(), all.end(), [](const Stretch& a, const Stretch& b) {
        return std::tuple(a.begin, -a.end) < std::tuple(b.begin, -b.end);
    });
    return all;
}

double sum_of_counter(const json& trace, const std::string& name) {
    double sum = 0;
    for (const json& event : trace["traceEvents"])
        if (event["ph"] == "C" && event["name"] == name) sum += event["args"]["value"].get<double>();
    return sum;
}

}  // namespace

TEST_CASE("run --trace writes strictly nested events and the run's own counts, and changes nothing", "[cli][trace]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    for (const char* mode : {"discrete", "continuous"}) {
        CAPTURE(mode);
        const std::string command = "run scene.toml --json - --set step.mode=" + std::string(mode);
        const json alone = json::parse(shell.kolize(command).out);
        const json traced = json::parse(shell.kolize(command + " --trace t.json").out);
        CHECK(traced["state_hash"] == alone["state_hash"]);
        const json trace = json::parse(file_bytes(shell.folder.path() / "t.json"));
        std::vector<Stretch> open;
        std::map<std::string, int> calls;
        for (const Stretch& s : stretches(trace)) {
            while (!open.empty() && open.back().end <= s.begin) open.pop_back();
            if (!open.empty()) CHECK(s.end <= open.back().end);
            CHECK(open.size() == (s.name == "step" ? 0u : 1u));
            open.push_back(s);
            ++calls[s.name];
        }
        CHECK(calls["step"] == alone["steps"]);
        CHECK(calls["broadphase"] >= alone["steps"]);
        CHECK(calls["response"] > 0);
        CHECK(sum_of_counter(trace, "contacts") == alone["counts"]["contacts"]);
        CHECK(sum_of_counter(trace, "triangle tests") == alone["counts"]["triangle_tests"]);
        CHECK(!std::filesystem::exists(shell.folder.path() / "t.json.part"));
    }
}

TEST_CASE("A run that fails leaves the trace of what it has done", "[cli][trace]") {
    const Shell shell;
    shell.folder.write("scene.toml", R"(
[step]
dt = 0.1
[[shape]]
name = "ball"
kind = "sphere"
radius = 1
[[body]]
shape = "ball"
mass = 1
position = [1e308, 0, 0]
velocity = [1e308, 0, 0]
)");
    CHECK(shell.kolize("run scene.toml --steps 100 --trace t.json").code == 1);
    const json trace = json::parse(file_bytes(shell.folder.path() / "t.json"));
    CHECK(trace["traceEvents"].size() > 2);
}

TEST_CASE("A trace that cannot be written is refused before the run", "[cli][trace]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    const Outcome refused = shell.kolize("run scene.toml --trace no/such/folder/t.json");
    CHECK(refused.code == 2);
    CHECK(refused.err.find("no/such/folder/t.json") != std::string::npos);
    CHECK(refused.out.empty());
}
