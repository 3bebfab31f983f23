#include "framework/scenes.h"

#include <kolize/conformance.h>

#include <catch2/catch.hpp>

using namespace kolize;

TEST_CASE("The OpenGL renderer keeps the contract of its stage", "[render][conformance]") {
    const PluginLibrary& library = test::plugins();
    for (const Check& check : check_plugin(library, library.require(StageKind::render, "gl"))) {
        INFO(check.name << ": " << check.detail);
        CHECK(check.outcome == Check::Outcome::pass);
    }
}
