// Nothing is wrong with this one: it must load whatever stands beside it.
#include "fixture.h"

KOLIZE_PLUGIN(fixture::Fixture, .name = "fixture", .summary = "every overlapping pair", .source = "none")
