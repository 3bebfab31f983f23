// Every file that a fault can make of a good one must end in a soup that keeps its promises, or in an Error.
#include "framework/mesh_files.h"
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
    write_obj(solid, folder.path() / "out.obj");
    return {{"m.obj", file_bytes(folder.path() / "out.obj")},
            {"m.off", as_off(solid)},
            {"t.stl", as_text_stl(solid)},
            {"b.stl", as_binary_stl(solid)},
            {"t.ply", as_text_ply(solid)},
            {"l.ply", as_binary_ply(solid, false)},
            {"b.ply", as_binary_ply(solid, true)}};
}

std::string mutated(std::string bytes, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
    for (std::size_t changes = below(4) + 1; changes > 0; --changes) {
        char& byte = bytes[below(bytes.size())];
        const std::string likely = "0123456789 -.\n/e#\\";
        byte = below(2) ? static_cast<char>(below(256)) : likely[below(likely.size())];
    }
    if (below(4) == 0) bytes.resize(below(bytes.size()) + 1);
    if (below(8) == 0) bytes.insert(below(bytes.size()), bytes.substr(below(bytes.size()), 40));
    return bytes;
}

void check_promises(const TriangleSoup& soup) {
    REQUIRE_FALSE(soup.triangles.empty());
    REQUIRE((soup.lines.empty() || soup.lines.size() == soup.triangles.size()));
    for (const Vec3& v : soup.vertices) REQUIRE(v.allFinite());
    for (const Triangle& t : soup.triangles)
        for (const std::uint32_t v : t) REQUIRE(v < soup.vertices.size());
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
