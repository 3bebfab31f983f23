// Every file that a fault can make of a good one must end in a soup that keeps its promises, or in an Error.
#include "framework/mesh_files.h"
#include "framework/mesh_mutations.h"
#include "framework/solids.h"

#include <kolize/mesh_io.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

struct Sample {
    std::string name;
    std::string bytes;
};

std::vector<Sample> samples() {
    const ScratchFolder folder;
    const TriangleSoup solid = cone(5, 1, 2);
    write_mesh(solid, folder.path() / "out.obj");
    return {{"m.obj", file_bytes(folder.path() / "out.obj")},
            {"m.off", as_off(solid)},
            {"t.stl", as_text_stl(solid)},
            {"b.stl", as_binary_stl(solid)},
            {"t.ply", as_text_ply(solid)},
            {"l.ply", as_binary_ply(solid, false)},
            {"b.ply", as_binary_ply(solid, true)}};
}

}  // namespace

TEST_CASE("Files with random faults end in a sound soup or an error that names the file", "[mesh_io]") {
    const ScratchFolder folder;
    std::size_t soups = 0, errors = 0;
    for (const Sample& sample : samples()) {
        std::mt19937 random(4711);
        for (int i = 0; i < 600; ++i) {
            CAPTURE(sample.name, i);
            const std::filesystem::path path = folder.write(sample.name, mutated(sample.bytes, random));
            try {
                check_promises(read_mesh(path));
                ++soups;
            } catch (const Error& error) {
                ++errors;
                REQUIRE(std::string(error.what()).starts_with(path.string() + ":"));
            }
        }
    }
    CHECK(soups > 500);   // the faults leave some files readable
    CHECK(errors > 500);  // and break others
}

TEST_CASE("A file that is cut off ends in a sound soup or an error", "[mesh_io]") {
    const ScratchFolder folder;
    for (const Sample& sample : samples()) {
        std::size_t errors = 0;
        for (std::size_t size = 1; size < sample.bytes.size(); size += 3) {
            CAPTURE(sample.name, size);
            try {
                check_promises(read_mesh(folder.write(sample.name, sample.bytes.substr(0, size))));
            } catch (const Error&) {
                ++errors;
            }
        }
        CAPTURE(sample.name);
        CHECK(errors > sample.bytes.size() / 9);
    }
}
