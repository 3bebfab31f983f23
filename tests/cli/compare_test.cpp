// kolize compare as a user meets it.
#include "cli/crowd.h"
#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace kolize::test;
using nlohmann::json;

namespace {

json compare(const Shell& shell, const std::string& options, int code = 0) {
    const Outcome outcome = shell.kolize("compare scene.toml --steps 40 --json - " + options);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == code);
    return json::parse(outcome.out);
}

}  // namespace

TEST_CASE("compare holds every row against the baseline, and the baseline against itself", "[cli][compare]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    const json answer = compare(shell, "--vary broadphase.plugin=grid,bsp --baseline 2");
    const json& rows = answer["variants"];
    REQUIRE(rows.size() == 2);
    CHECK(answer["baseline"] == rows[1]["label"]);
    CHECK(rows[1]["verdict"] == "baseline");
    CHECK(rows[1]["ratio"]["median"] == 1);
    CHECK(answer["again"]["state_hash"] == rows[1]["state_hash"]);
    CHECK(answer["again"]["verdict"].get<std::string>().find("(") != std::string::npos);
    for (const json& row : rows) {
        CHECK(row["step_us_of_runs"].size() == answer["repeat"]);
        CHECK(row["step_us"]["low"] <= row["step_us"]["median"]);
        CHECK(row["step_us"]["median"] <= row["step_us"]["high"]);
        CHECK(row["ranked"] == true);
    }
    const Outcome wrong = shell.kolize("compare scene.toml --steps 4 --baseline nobody");
    CHECK(wrong.code == 2);
    CHECK(wrong.err.find("nobody") != std::string::npos);
}

TEST_CASE("compare does not rank rows that answered different questions", "[cli][compare]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    for (const char* vary : {"world.drag=0,0.5", "step.dt=0.01,0.02"}) {  // the latter: 40 steps of other lengths
        CAPTURE(vary);
        const json rows = compare(shell, "--repeat 1 --vary " + std::string(vary))["variants"];
        CHECK(rows[0]["ranked"] == true);
        CHECK(rows[1]["ranked"] == false);
        CHECK(rows[1]["verdict"] == "not ranked: another question");
        CHECK(rows[1]["front"] == false);
    }
    const json same = json::parse(
        shell.kolize("compare scene.toml --time 0.4 --json - --repeat 1 --vary step.dt=0.01,0.02").out)["variants"];
    CHECK(same[1]["ranked"] == true);
}

TEST_CASE("compare fails where a row breaks a gate", "[cli][compare]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    CHECK(compare(shell, "--repeat 1 --max-drift 1 --budget-ms 1e6 --max-missed 0")["variants"][0]["breaks"].empty());
    CHECK(compare(shell, "--repeat 1 --budget-ms 1e-9", 1)["variants"][0]["breaks"].size() == 1);
    CHECK(shell.kolize("compare scene.toml --steps 4 --max-drift -1").code == 2);
}

TEST_CASE("compare --judge says what each narrowphase made up", "[cli][compare]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    const json rows = compare(shell, "--repeat 1 --judge exact --vary narrowphase.plugin=moller,exact")["variants"];
    for (const json& row : rows) {
        CHECK(row["judged"]["pairs"] > 0);
        CHECK(row["judged"]["missed"] == 0);
        CHECK(row["judged"]["false_hits"] == 0);
    }
    CHECK(shell.kolize("compare scene.toml --steps 4 --judge nobody").code == 2);
}

TEST_CASE("the path error shrinks with the step", "[cli][compare]") {
    const Shell shell;
    // Free fall in drag: smooth, so that only the length of the steps counts.
    shell.folder.write("scene.toml", R"(
[world]
gravity = [0, -9.81, 0]
drag = 0.5
[step]
integrator = "semi_implicit_euler"
dt = 0.01
[[shape]]
name = "ball"
kind = "sphere"
radius = 0.5
[[body]]
shape = "ball"
mass = 1
velocity = [3, 4, 0]
)");
    const json rows = json::parse(
        shell.kolize("compare scene.toml --time 1 --repeat 1 --reference 64 --vary step.dt=0.01,0.02,0.04 --json -")
            .out)["variants"];
    const auto last = [&](int i) { return rows[i]["course"]["path_error"].back().get<double>(); };
    CHECK(last(0) > 0);
    CHECK(last(1) == Approx(2 * last(0)).epsilon(0.1));  // first order
    CHECK(last(2) == Approx(4 * last(0)).epsilon(0.1));
}

TEST_CASE("compare --report is whole, and --rerun repeats it bit for bit", "[cli][compare]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    REQUIRE(
        shell.kolize("compare scene.toml --steps 40 --vary narrowphase.plugin=moller,angle_sum --report out").code ==
        0);
    const std::string html = file_bytes(shell.folder.path() / "out/compare.html");
    CHECK(html.find("http") == std::string::npos);  // nothing from a network
    for (const char* part :
         {"<svg", "Time against accuracy", "Cost of the stages", "kolize compare", "A/A", "viewport"})
        CHECK(html.find(part) != std::string::npos);
    // The data in it are the report's own.
    const std::size_t begin = html.find('>', html.find("id=\"data\"")) + 1;
    const json data = json::parse(html.substr(begin, html.find("</script>", begin) - begin));
    const json report = json::parse(file_bytes(shell.folder.path() / "out/compare.json"));
    CHECK(data == report);

    const Outcome again = shell.kolize("compare --rerun out/compare.json");
    CHECK(again.out.find("differs: moller: accuracy") == std::string::npos);
    json forged = report;
    forged["variants"][0]["state_hash"] = "0000000000000000";
    shell.folder.write("forged.json", forged.dump());
    const Outcome other = shell.kolize("compare --rerun forged.json");
    CHECK(other.code == 1);
    CHECK(other.out.find(": state_hash") != std::string::npos);
    shell.folder.write("none.json", "{}");
    CHECK(shell.kolize("compare --rerun none.json").code == 2);
}

TEST_CASE("labels cannot break out of the report", "[cli][compare]") {
    const Shell shell;
    shell.folder.write("<b>scene&.toml", crowd);
    REQUIRE(shell.kolize("compare '<b>scene&.toml' --steps 4 --repeat 1 --report out").code == 0);
    const std::string html = file_bytes(shell.folder.path() / "out/compare.html");
    CHECK(html.find("<b>scene") == std::string::npos);
    CHECK(html.find("&lt;b&gt;scene&amp;.toml") != std::string::npos);
}

TEST_CASE("compare takes several scenes: each has a baseline of its own, and none is ranked against another",
          "[cli][compare]") {
    const Shell shell;
    const auto balls = [](int count) {
        std::string text = "[step]\ndt = 0.01\n[[shape]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.5\n";
        for (int i = 0; i < count; ++i)
            text += "[[body]]\nshape = \"ball\"\nmass = 1\nposition = [" + std::to_string(2 * i) + ", 0, 0]\n";
        return text;
    };
    for (const int count : {2, 8, 32}) shell.folder.write("balls" + std::to_string(count) + ".toml", balls(count));
    const Outcome outcome = shell.kolize(
        "compare balls2.toml balls8.toml balls32.toml --steps 20 --repeat 6 --vary broadphase.plugin=grid,brute_force "
        "--report out");
    REQUIRE(outcome.code == 0);
    const json rows = json::parse(file_bytes(shell.folder.path() / "out/compare.json"))["variants"];
    REQUIRE(rows.size() == 6);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CHECK(rows[i]["scene_file"] == std::vector<std::string>{"balls2.toml", "balls8.toml", "balls32.toml"}[i / 2]);
        CHECK(rows[i]["ranked"] == true);
        CHECK((rows[i]["verdict"] == "baseline") == (i % 2 == 0));
        if (!rows[i]["dominated_by"].is_null())
            CHECK(rows[i]["dominated_by"].get<std::string>().starts_with(rows[i]["scene_file"].get<std::string>()));
    }
    const std::string html = file_bytes(shell.folder.path() / "out/compare.html");
    CHECK(html.find("<h2>Scaling</h2>") != std::string::npos);
    CHECK(html.find("<h2>Profile over the scenes</h2>") != std::string::npos);
    CHECK(shell.kolize("compare --rerun out/compare.json").out.find("state_hash") == std::string::npos);
}
