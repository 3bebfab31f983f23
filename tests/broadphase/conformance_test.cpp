#include "oracle/allocation_counter.h"

#include <catch2/catch.hpp>
#include <kolize/conformance.h>

#include <iostream>

using namespace kolize;

TEST_CASE("every broadphase keeps the contract", "[broadphase][conformance]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const AllocationCounter counter;
    ConformanceOptions options;
    if (AllocationCounter::available()) options.allocations = [&] { return counter.count(); };

    std::vector<ConformanceReport> reports;
    for (const LoadedPlugin& plugin : library.plugins())
        if (plugin.descriptor->stage == StageKind::broadphase)
            reports.push_back({plugin.descriptor->name, check_plugin(library, plugin, options)});
    REQUIRE(reports.size() >= 4);
    print_matrix(std::cout, reports);
    for (const ConformanceReport& report : reports) {
        const Capabilities& can = library.require(StageKind::broadphase, report.plugin).descriptor->capabilities;
        for (const Check& check : report.checks) {
            INFO(report.plugin << ", " << check.name << ": " << check.detail);
            const bool inapplicable =
                (check.name == "warm calls allocate nothing" && (!options.allocations || can.allocates)) ||
                (check.name == "exact as declared" && !can.exact);
            CHECK(check.outcome == (inapplicable ? Check::Outcome::skip : Check::Outcome::pass));
        }
    }
}
