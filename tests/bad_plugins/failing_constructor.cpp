// Does not survive the static constructors that the dynamic loader runs; FAILURE says how (CMakeLists.txt).
#include "fixture.h"

#include <csignal>
#include <cstdlib>

namespace {

const struct Doomed {
    Doomed() { FAILURE; }
} doomed;

}  // namespace

KOLIZE_PLUGIN(fixture::Fixture, .name = "fixture", .summary = "every overlapping pair", .source = "none")
