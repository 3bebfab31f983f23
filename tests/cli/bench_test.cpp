#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace kolize::test;
using nlohmann::json;

namespace {

const std::string header = "a0x,a0y,a0z,a1x,a1y,a1z,a2x,a2y,a2z,b0x,b0y,b0z,b1x,b1y,b1z,b2x,b2y,b2z";
const std::string face = "0,0,0, 4,0,0, 0,4,0, ";  // in the plane z = 0

// The second triangle crosses the first, lies above it, crosses its plane beside it, and lies in its plane on it.
const std::string workload = header + ",hit\n" +                       //
                             face + "1,1,-1, 1,1,1, 2,1,1, 1\n" +      //
                             face + "1,1,1, 2,1,1, 1,2,3, 0\n" +       //
                             face + "9,9,-1, 9,9,1, 8,9,1, 0\r\n\n" +  //
                             face + "1,1,0, 2,1,0, 1,2,0, 1\n";

}  // namespace

TEST_CASE("bench narrowphase counts the answers of each triangle test that are wrong", "[cli]") {
    const Shell shell;
    shell.folder.write("pairs.csv", workload);
    const Outcome outcome = shell.kolize("bench narrowphase pairs.csv --repeat 2 --json -");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json result = json::parse(outcome.out);
    CHECK(result["stage"] == "narrowphase");
    CHECK(result["tests"] == 4);
    REQUIRE(result["variants"].size() == 4);  // angle_sum, exact, guigue_devillers, moller: others have no test to call
    for (const json& variant : result["variants"]) {
        const bool exact = variant["narrowphase"]["plugin"] != "angle_sum";
        CHECK(variant["pairs"] == json::array({exact ? 2 : 1}));
        CHECK(variant["false_positive"] == 0);
        CHECK(variant["false_negative"] == (exact ? 0 : 1));  // coplanar triangles are what angle_sum never finds
        CHECK(variant["median_ms"] > 0);
    }
}

TEST_CASE("bench narrowphase without true answers counts hits alone", "[cli]") {
    const Shell shell;
    shell.folder.write("pairs.csv", header + "\n" + face + "1,1,-1, 1,1,1, 2,1,1\n");
    const json result = json::parse(
        shell.kolize("bench narrowphase pairs.csv --set narrowphase.plugin=moller --repeat 1 --json -").out);
    REQUIRE(result["variants"].size() == 1);
    CHECK(result["variants"][0]["pairs"] == json::array({1}));
    CHECK_FALSE(result["variants"][0].contains("false_positive"));
}

TEST_CASE("bench narrowphase says what is wrong with its input and where", "[cli]") {
    const Shell shell;
    const auto [content, sentence] = GENERATE_COPY(table<std::string, std::string>({
        {"", "pairs.csv:1: the first line must be " + header + ", with or without ,hit at the end"},
        {header + "\n", "pairs.csv:2: there are no triangles"},
        {header + "\n\n" + face + "1,1,-1\n", "pairs.csv:3: 18 numbers are wanted: " + header},
        {header + "\n" + face + "1,1,x, 1,1,1, 2,1,1\n", "pairs.csv:2: column 12 is not a number"},
        {header + "\n" + face + "1,1,nan, 1,1,1, 2,1,1\n", "pairs.csv:2: a number is not finite"},
        {header + ",hit\n" + face + "1,1,1, 1,1,1, 2,1,1, 2\n", "pairs.csv:2: hit must be 0 or 1"},
    }));
    shell.folder.write("pairs.csv", content);
    const Outcome outcome = shell.kolize("bench narrowphase pairs.csv");
    CHECK(outcome.code == 2);
    CHECK(outcome.err == "kolize: " + sentence + "\n");
}

TEST_CASE("bench narrowphase refuses a plugin that does not test triangles pair by pair", "[cli]") {
    const Shell shell;
    shell.folder.write("pairs.csv", workload);
    const Outcome outcome = shell.kolize("bench narrowphase pairs.csv --vary narrowphase.plugin=moller,fcl");
    CHECK(outcome.code == 2);
    CHECK(outcome.err == "kolize: narrowphase 'fcl' does not test triangles pair by pair\n");
    CHECK(shell.kolize("bench narrowphase none.csv").err == "kolize: workload 'none.csv' cannot be read\n");
}

TEST_CASE("bench broadphase compares the pairs of its variants", "[cli]") {
    const Shell shell;
    shell.folder.write("boxes.csv",
                       "frame,min_x,min_y,min_z,max_x,max_y,max_z\n0,0,0,0,1,1,1\n0,1,1,1,2,2,2\n0,5,5,5,6,6,6\n");
    const json result = json::parse(shell.kolize("bench broadphase boxes.csv --repeat 1 --json -").out);
    CHECK(result["stage"] == "broadphase");
    CHECK(result["boxes"] == 3);
    REQUIRE(result["variants"].size() >= 6);  // every broadphase
    for (const json& variant : result["variants"]) {
        CHECK(variant["pairs"] == json::array({1}));
        CHECK(variant["same_pairs"] == true);
    }
    shell.folder.write("short.csv", "frame,min_x,min_y,min_z,max_x,max_y,max_z\n0,0,0,0,1\n");
    CHECK(shell.kolize("bench broadphase short.csv").err ==
          "kolize: short.csv:2: 7 numbers are wanted: frame,min_x,min_y,min_z,max_x,max_y,max_z\n");
}
