#include "oracle/allocation_counter.h"

#include <kolize/conformance.h>

#include <catch2/catch.hpp>

using namespace kolize;

namespace {

struct FalseClaim {
    const char* plugin;
    const char* check;   // that fails
    const char* detail;  // is part of what it says
};

// Only the plugin's own stage and name are looked at: two stages may have a plugin of the same name.
void require_caught(StageKind stage, const FalseClaim& claim) {
    CAPTURE(claim.plugin);
    const PluginLibrary library({KOLIZE_FALSE_CLAIM_DIR});
    const AllocationCounter counter;
    ConformanceOptions options;
    if (AllocationCounter::available()) options.allocations = [&] { return counter.count(); };
    const std::vector<Check> checks = check_plugin(library, library.require(stage, claim.plugin), options);
    const auto guilty =
        std::find_if(checks.begin(), checks.end(), [&](const Check& check) { return check.name == claim.check; });
    REQUIRE(guilty != checks.end());
    CHECK(guilty->outcome == Check::Outcome::fail);
    CHECK_THAT(guilty->detail, Catch::Contains(claim.detail));
}

}  // namespace

TEST_CASE("the narrowphase suite catches each false claim", "[narrowphase][conformance]") {
    for (const FalseClaim& claim : {
             FalseClaim{"exact", "exact as declared", "takes for the opposite"},
             FalseClaim{"any_size", "the whole scaled by powers of two", "power of two"},
             FalseClaim{"crossings", "crossings as declared", "finds no line"},
             FalseClaim{"time_of_impact", "nothing overlaps before the time of impact",
                        "does not find times of impact"},
             FalseClaim{"gives", "gives no more than it declares", "manifold"},
             FalseClaim{"no_memory", "earlier calls leave no trace", "after calls about others"},
         })
        require_caught(StageKind::narrowphase, claim);
    if (AllocationCounter::available())
        require_caught(StageKind::narrowphase, {"no_allocations", "warm calls allocate nothing", "allocations"});
}

TEST_CASE("the response suite catches each false claim", "[response][conformance]") {
    constexpr const char* writes = "writes velocities of touching bodies only";
    for (const FalseClaim& claim : {
             FalseClaim{"friction", "friction as declared", "nothing holds"},
             FalseClaim{"moves", "moves bodies as declared", "0.2 m deep"},
             FalseClaim{"rests", "rests as declared", "come to rest"},
             FalseClaim{"sleeps", "sleeps as declared", "no setting"},
             FalseClaim{"no_friction", "friction as declared", "declares no friction"},
             FalseClaim{"no_moves", writes, "is moved"},
             FalseClaim{"no_sleeps", writes, "constant of the bodies"},
             FalseClaim{"uses", "needs no more than it uses", "needs normal"},
             FalseClaim{"symmetry", "the whole in a mirror", "in a mirror"},
             FalseClaim{"any_mass", "all masses scaled", "masses are scaled"},
             FalseClaim{"any_speed", "all velocities shifted", "bodies are faster"},
         })
        require_caught(StageKind::response, claim);
    if (AllocationCounter::available())
        require_caught(StageKind::response, {"no_allocations", "warm calls allocate nothing", "allocations"});
}
