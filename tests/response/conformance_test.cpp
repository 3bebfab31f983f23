#include "oracle/allocation_counter.h"

#include <kolize/conformance.h>

#include <catch2/catch.hpp>

using namespace kolize;

TEST_CASE("Our response plugins keep the contract of the stage", "[response][conformance]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const AllocationCounter allocations;
    ConformanceOptions options;
    if (AllocationCounter::available()) options.allocations = [&] { return allocations.count(); };
    for (const char* name : {"explode", "impulse", "simple_bounce"})
        for (const Check& check : check_plugin(library, library.require(StageKind::response, name), options)) {
            INFO(name << ", " << check.name << ": " << check.detail);
            CHECK(check.outcome != Check::Outcome::fail);
        }
}
