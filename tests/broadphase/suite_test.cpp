#include "oracle/allocation_counter.h"

#include <catch2/catch.hpp>
#include <kolize/conformance.h>

#include <sstream>

using namespace kolize;

namespace {

std::vector<Check> check(const std::string& fault) {
    const PluginLibrary library({KOLIZE_FAULTY_BROADPHASE_DIR});
    const AllocationCounter counter;
    ConformanceOptions options;
    if (AllocationCounter::available()) options.allocations = [&] { return counter.count(); };
    return check_plugin(library, library.require(StageKind::broadphase, fault), options);
}

const Check& find(const std::vector<Check>& checks, const std::string& name) {
    const auto found = std::find_if(checks.begin(), checks.end(), [&](const Check& c) { return c.name == name; });
    REQUIRE(found != checks.end());
    return *found;
}

// The check `name` fails, and says `word`.
void require_caught(const std::string& fault, const std::string& name, const std::string& word) {
    const std::vector<Check> checks = check(fault);
    const Check& guilty = find(checks, name);
    INFO(guilty.detail);
    CHECK(guilty.outcome == Check::Outcome::fail);
    CHECK(guilty.detail.find(word) != std::string::npos);
    CHECK_FALSE(passed(checks));
}

}  // namespace

TEST_CASE("the broadphase suite passes a right plugin", "[broadphase][conformance]") {
    for (const Check& c : check("none")) {
        INFO(c.name << ": " << c.detail);
        CHECK(c.outcome != Check::Outcome::fail);
    }
}

TEST_CASE("the broadphase suite catches each way of being wrong", "[broadphase][conformance]") {
    SECTION("touching boxes lost") { require_caught("loses_touching", "touching boxes", "is missing"); }
    SECTION("pairs twice") { require_caught("repeats", "uniform boxes", "twice"); }
    SECTION("a > b") { require_caught("unordered", "uniform boxes", "a < b"); }
    SECTION("static pairs") { require_caught("reports_static", "nine in ten static", "two static rows"); }
    SECTION("boxes of the last frame") { require_caught("remembers", "moving boxes, rows kept", "frame"); }
    SECTION("boxes that hardly moved") { require_caught("lazy", "few rows move, some jump", "frame"); }
    SECTION("boxes of another object") { require_caught("shares", "two objects at a time", "of two objects"); }
    SECTION("references lost") { require_caught("loses_references", "rows that are references", "is missing"); }
    SECTION("exact claimed") { require_caught("inexact", "exact as declared", "are apart"); }
    SECTION("NaN accepted") { require_caught("takes_nan", "refuses non-finite boxes", "no std::invalid_argument"); }
    SECTION("outline not declared") { require_caught("undeclared_outline", "outline", "name none"); }
    SECTION("outline empty") { require_caught("empty_outline", "outline", "is empty"); }
    SECTION("cells elsewhere") { require_caught("misplaced_cells", "outline", "holds row"); }
    SECTION("planes with a thickness") { require_caught("thick_planes", "outline", "not flat"); }
    SECTION("allocation") {
        if (AllocationCounter::available()) require_caught("allocates", "warm calls allocate nothing", "allocations");
    }
}

TEST_CASE("a failed broadphase check prints the fewest boxes that show it", "[broadphase][conformance]") {
    const std::vector<Check> checks = check("loses_touching");
    const std::string& detail = find(checks, "touching boxes").detail;
    INFO(detail);
    CHECK(detail.find("const std::vector<Aabb> bounds{{{") != std::string::npos);
    CHECK(detail.find("is_static{0, 0};") != std::string::npos);  // two boxes are left of 216
}

TEST_CASE("the matrix has a row a check, a column a plugin, and the details below", "[conformance]") {
    using Outcome = Check::Outcome;
    std::ostringstream out;
    print_matrix(out, {{"one", {{"first", Outcome::pass, ""}, {"second check", Outcome::skip, "no time"}}},
                       {"another", {{"first", Outcome::fail, "boxes {}"}, {"second check", Outcome::pass, ""}}}});
    CHECK(out.str() ==
          "               one  another\n"
          "first         pass     FAIL\n"
          "second check  skip     pass\n"
          "one, second check: skip: no time\n"
          "another, first: FAIL: boxes {}\n");
}
