// `kolize run --save-workload` and what `kolize bench` makes of it, as a user meets them.
#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <sstream>

using namespace kolize::test;
using nlohmann::json;

namespace {

// Wedges, boxes and balls that meet in a room; with `heap` they fall on its floor and come to rest.
std::string crowd(bool heap) {
    std::ostringstream text;
    text << "[step]\ndt = 0.005\ntime = 0.5\n"
         << (heap ? "[world]\ngravity = [0, -9.81, 0]\n[[response]]\nplugin = \"solver\"\n" : "")
         << "[[material]]\nname = \"stuff\"\nrestitution = " << (heap ? 0.2 : 1.0)
         << (heap ? "\nfriction = 0.3\n" : "\n")
         << "[[room]]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = \"stuff\"\n"
         << "[[shape]]\nname = \"wedge\"\nkind = \"mesh\"\nfile = \"wedge.obj\"\n"
         << "[[shape]]\nname = \"brick\"\nkind = \"box\"\nhalf_extents = [0.2, 0.15, 0.1]\n"
         << "[[shape]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.15\n";
    const char* const shapes[] = {"wedge", "brick", "ball"};
    const char* const turns[] = {"[0.8, 0.6, 0, 0]", "[0.6, 0, 0.8, 0]", "[0.28, 0, 0, 0.96]", "[0.5, -0.5, 0.1, 0.7]"};
    for (int i = 0; i < 12; ++i)
        text << "[[body]]\nshape = \"" << shapes[i % 3] << "\"\nmaterial = \"stuff\"\nmass = 1\nposition = ["
             << -0.6 + 0.6 * (i % 3) << ", " << -0.6 + 0.4 * (i / 3) << ", " << 0.1 * (i % 2)
             << "]\norientation = " << turns[i % 4] << "\nvelocity = [" << 3 - i % 5 << ", " << i % 3 - 1 << ", "
             << 2 - i % 4 << "]\n";
    return text.str();
}

void write_scene(const Shell& shell, bool heap = false) {
    shell.folder.write("wedge.obj",
                       "v -0.1 -0.1 -0.1\nv 0.3 -0.1 -0.1\nv -0.1 0.3 -0.1\nv -0.1 -0.1 0.3\n"
                       "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    shell.folder.write("scene.toml", crowd(heap));
}

json bench(const Shell& shell, const std::string& arguments, int code = 0) {
    const Outcome outcome = shell.kolize("bench " + arguments + " --repeat 1 --json -");
    CAPTURE(arguments, outcome.err);
    REQUIRE(outcome.code == code);
    return json::parse(outcome.out);
}

const json* variant_of(const json& result, const std::string& stage, const std::string& plugin) {
    for (const json& variant : result["variants"])
        if (variant[stage]["plugin"] == plugin) return &variant;
    return nullptr;
}

std::string line_of_calls(const Shell& shell, const std::string& begin) {
    std::istringstream calls(file_bytes(shell.folder.path() / "w/calls.txt"));
    std::string line;
    while (std::getline(calls, line))
        if (line.starts_with(begin)) return line;
    return "";
}

}  // namespace

TEST_CASE("a workload gives the plugin that made it the very same contacts", "[cli][workload]") {
    const Shell shell;
    write_scene(shell);
    const std::string plugin = GENERATE("moller", "guigue_devillers", "exact", "fcl");
    CAPTURE(plugin);
    const json alone = json::parse(shell.kolize("run scene.toml --json - --set narrowphase.plugin=" + plugin).out);
    const Outcome run =
        shell.kolize("run scene.toml --json r.json --save-workload w --set narrowphase.plugin=" + plugin);
    INFO(run.out << run.err);
    REQUIRE(run.code == 0);
    CHECK(run.out.find("workload in w: 100 frames of boxes in 1 files, ") != std::string::npos);
    const json watched = json::parse(file_bytes(shell.folder.path() / "r.json"));
    CHECK(watched["state_hash"] == alone["state_hash"]);
    CHECK(watched["workload"]["box_frames"] == 100);

    const json result = bench(shell, "narrowphase w");
    CHECK(result["pairs"].get<int>() > 100);
    for (const json& variant : result["variants"]) {
        CAPTURE(variant["narrowphase"]);
        const bool bounds = variant["narrowphase"]["plugin"] == "bounding_volume";
        CHECK((variant["false_positive"] > 0) == bounds);
        CHECK(variant["false_negative"] == 0);
        CHECK(variant.contains("as_recorded") == (variant["narrowphase"]["plugin"] == plugin));
    }
    REQUIRE(variant_of(result, "narrowphase", plugin));
    CHECK((*variant_of(result, "narrowphase", plugin))["as_recorded"] == true);
    CHECK((*variant_of(result, "narrowphase", plugin))["contacts"] == watched["counts"]["contacts"]);
    // Not with another contact model.
    const json other =
        bench(shell, "narrowphase w --set narrowphase.contact=averaged --vary narrowphase.plugin=" + plugin);
    CHECK_FALSE(other["variants"][0].contains("as_recorded"));
}

TEST_CASE("a workload gives the response that made it the very same impulses", "[cli][workload]") {
    const Shell shell;
    const bool heap = GENERATE(false, true);  // the solver remembers, and lays bodies to sleep
    CAPTURE(heap);
    write_scene(shell, heap);
    const std::string steps = GENERATE("", " --workload-steps 30:90:7");
    REQUIRE(shell.kolize("run scene.toml --save-workload w" + steps).code == 0);
    const std::string maker = heap ? "solver" : "impulse";
    CHECK(line_of_calls(shell, "memory").empty() == !heap);
    const json result = bench(shell, "response w");
    REQUIRE(variant_of(result, "response", maker));
    const json& made = *variant_of(result, "response", maker);
    CHECK(made["as_recorded"] == true);
    CHECK(made["contacts"] > 0);
    for (const json& variant : result["variants"]) CHECK(variant["contacts"] == made["contacts"]);
    if (!heap) CHECK(made["energy_off"] < 1e-12);
    if (!heap) CHECK(made["approaching"] == 0);
    REQUIRE(variant_of(result, "response", "slide"));
}

TEST_CASE("boxes of a workload go to bench broadphase, one file a generation", "[cli][workload]") {
    const Shell shell;
    write_scene(shell);
    REQUIRE(shell.kolize("run scene.toml --set response.plugin=explode --save-workload w").code == 0);
    std::size_t frames = 0, files = 0;
    std::size_t boxes = 13;
    for (; std::filesystem::exists(shell.folder.path() / ("w/broadphase." + std::to_string(files) + ".npy")); ++files) {
        const json result = bench(shell, "broadphase w/broadphase." + std::to_string(files) +
                                             ".npy --vary broadphase.plugin=brute_force,grid");
        frames += result["frames"].get<std::size_t>();
        CHECK(result["boxes"] < boxes);  // each explosion takes some
        boxes = result["boxes"];
        CHECK(result["variants"][1]["same_pairs"] == true);
    }
    CHECK(files > 1);
    CHECK(frames <= 100);
}

TEST_CASE("a workload that was changed or cut is noticed", "[cli][workload]") {
    const Shell shell;
    write_scene(shell);
    REQUIRE(shell.kolize("run scene.toml --save-workload w").code == 0);
    const std::string calls = file_bytes(shell.folder.path() / "w/calls.txt");
    const std::string found = line_of_calls(shell, "found 1");
    std::string other = calls;
    other.replace(other.find(found), 7, "found 2");
    shell.folder.write("w/calls.txt", other);
    const json result = bench(shell, "narrowphase w --vary narrowphase.plugin=moller", 1);
    CHECK(result["variants"][0]["as_recorded"] == false);

    const auto [line, sentence] = GENERATE(table<std::string, std::string>({
        {"pair 0 1 manifold", "the line belongs to no such call"},
        {"narrowphase\npair 1 0 manifold", "of two bodies the lower one stands first"},
        {"narrowphase\npair 0 99 manifold", "there are 18 bodies, no number 99"},
        {"narrowphase\npair 0 1 much", "a detail is overlap, normal or manifold, not 'much'"},
        {"narrowphase\nfound 0 0", "the call has no pairs"},
        {"narrowphase\npair 0 1 normal\nresponse 0 1p+0 0p+0", "the call before is cut short"},
        {"narrowphase", "the last call is cut short"},
        {"response 3 1p+0 0p+0", "there are 1 rules, no number 3"},
        {"response 0 -1p+0 0p+0", "times must not be below 0"},
        {"response 0 inf 0p+0", "a number such as 1.8p+1 is wanted, not 'inf'"},
        {"body 0 0 0 1p+0 1p+0", "the line is cut short"},
        {"body 0 0 2", "there are 2 marks, no number 2"},
        {"step 1 2", "the line is too long"},
        {"steps", "no line begins with 'steps'"},
    }));
    CAPTURE(line);
    shell.folder.write("w/calls.txt", line + "\n");
    const Outcome outcome = shell.kolize("bench narrowphase w");
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find(sentence) != std::string::npos);
    CHECK(outcome.err.starts_with("kolize: w/calls.txt:"));
}

TEST_CASE("narrowphases that cannot take a workload are left out, or refused if named", "[cli][workload]") {
    const Shell shell;
    write_scene(shell);
    REQUIRE(shell.kolize("run scene.toml --save-workload w --steps 60").code == 0);
    const json result = bench(shell, "narrowphase w");
    CHECK(result["left_out"].size() == 2);
    CHECK_FALSE(variant_of(result, "narrowphase", "sat"));
    const Outcome named = shell.kolize("bench narrowphase w --vary narrowphase.plugin=moller,sat");
    CHECK(named.code == 2);
    CHECK(named.err.starts_with("kolize: narrowphase 'sat' does not take shapes of kind "));
}

TEST_CASE("bad input of workloads is refused in a sentence", "[cli][workload]") {
    const Shell shell;
    write_scene(shell);
    const Outcome full = shell.kolize("run scene.toml --save-workload .");
    CHECK(full.code == 2);
    CHECK(full.err == "kolize: folder '.' is not empty; one of its own is wanted\n");
    for (const std::string steps : {"5:5", "1:2:0", "a:b", "1:2:3:4", "-1:3"}) {
        CAPTURE(steps);
        const Outcome wrong = shell.kolize("run scene.toml --save-workload v --workload-steps=" + steps);
        CHECK(wrong.code == 2);
        CHECK(wrong.err.starts_with("kolize: --workload-steps " + steps + ": FROM:TO:EVERY is wanted"));
    }
    CHECK(shell.kolize("run scene.toml --workload-steps 1:2").code == 2);
    std::filesystem::create_directory(shell.folder.path() / "empty");
    CHECK(shell.kolize("bench narrowphase empty").code == 2);
    CHECK(shell.kolize("bench response empty").code == 2);
    CHECK(shell.kolize("bench response scene.toml").err ==
          "kolize: workload 'scene.toml' is not a folder; kolize run SCENE --save-workload writes one\n");
    REQUIRE(shell.kolize("run scene.toml --steps 1 --save-workload none --workload-steps 5:9").code == 0);
    CHECK(shell.kolize("bench narrowphase none").err == "kolize: workload 'none' has no call of the narrowphase\n");
    REQUIRE(shell.kolize("run scene.toml --set step.mode=continuous --steps 10 --save-workload touching").code == 0);
    CHECK(shell.kolize("bench response touching").code == 0);
}
