#include "oracle/allocation_counter.h"

#include <kolize/conformance.h>

#include <catch2/catch.hpp>

using namespace kolize;

TEST_CASE("Our response plugins keep the contract of the stage", "[response][conformance]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const AllocationCounter allocations;
    ConformanceOptions options;
    if (AllocationCounter::available()) options.allocations = [&] { return allocations.count(); };
    const std::vector<std::string> names = library.names(StageKind::response);
    REQUIRE(names.size() >= 6);
    for (const std::string& name : names)
        for (const Check& check : check_plugin(library, library.require(StageKind::response, name), options)) {
            INFO(name << ", " << check.name << ": " << check.detail);
            CHECK(check.outcome != Check::Outcome::fail);
        }
}
