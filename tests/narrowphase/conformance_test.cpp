#include "narrowphase/two_bodies.h"
#include "oracle/allocation_counter.h"

#include <kolize/conformance.h>

#include <catch2/catch.hpp>

#include <iostream>

using namespace kolize;

TEST_CASE("every narrowphase plugin that is built keeps the contract of the stage", "[narrowphase][conformance]") {
    const AllocationCounter allocations;
    ConformanceOptions options;
    if (AllocationCounter::available()) options.allocations = [&] { return allocations.count(); };
    std::vector<ConformanceReport> reports;
    for (const std::string& name : test::library().names(StageKind::narrowphase)) {
        const LoadedPlugin& plugin = test::library().require(StageKind::narrowphase, name);
        reports.push_back({name, check_plugin(test::library(), plugin, options)});
        CAPTURE(name);
        for (const Check& check : reports.back().checks) {
            INFO(check.name << ": " << check.detail);
            CHECK(check.outcome != Check::Outcome::fail);
        }
    }
    CHECK(reports.size() >= 3);
    print_matrix(std::cout, reports);
}
