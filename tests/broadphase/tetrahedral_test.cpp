// What broadphase tetrahedral does beyond the contract: it keeps its mesh while the static boxes stay the same, and
// boxes may lie outside of the mesh.
#include "oracle/allocation_counter.h"

#include <catch2/catch.hpp>
#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

#include <algorithm>
#include <random>

using namespace kolize;

namespace {

constexpr std::uint64_t seed = 7;

struct Boxes {
    std::vector<Aabb> bounds;
    std::vector<std::uint8_t> is_static;
};

Vec3 random_point(std::mt19937_64& random, double side) {
    std::uniform_real_distribution<double> place(-side, side);
    const double x = place(random), y = place(random), z = place(random);
    return {x, y, z};
}

void add_boxes(Boxes& boxes, std::size_t count, bool is_static, double side, std::mt19937_64& random) {
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 corner = random_point(random, side);
        boxes.bounds.push_back({corner, corner + Vec3::Ones()});
        boxes.is_static.push_back(is_static);
    }
}

// By definition.
std::vector<Pair> overlapping_pairs(const Boxes& boxes) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < boxes.bounds.size(); ++a)
        for (std::uint32_t b = a + 1; b < boxes.bounds.size(); ++b)
            if (boxes.bounds[a].overlaps(boxes.bounds[b]) && !(boxes.is_static[a] && boxes.is_static[b]))
                pairs.push_back({a, b});
    return pairs;
}

std::vector<Pair> find_pairs(Broadphase& stage, const Boxes& boxes, std::uint64_t generation) {
    std::vector<Pair> pairs;
    stage.find_pairs({boxes.bounds, boxes.is_static, generation}, pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace

TEST_CASE("tetrahedral finds all pairs while moving boxes come and go among the same static ones", "[broadphase]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const auto host = make_host(1);
    const auto stage = library.make<Broadphase>({"tetrahedral", {}, {}}, *host);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Boxes standing;
    add_boxes(standing, 60, true, 5, random);
    for (std::uint64_t generation = 1; generation < 20; ++generation) {
        Boxes boxes;
        add_boxes(boxes, random() % 30, false, 5, random);  // so that static rows have other numbers each time
        boxes.bounds.insert(boxes.bounds.end(), standing.bounds.begin(), standing.bounds.end());
        boxes.is_static.insert(boxes.is_static.end(), standing.is_static.begin(), standing.is_static.end());
        add_boxes(boxes, random() % 30, false, 5, random);
        CAPTURE(generation);
        REQUIRE(find_pairs(*stage, boxes, generation) == overlapping_pairs(boxes));
    }
}

TEST_CASE("tetrahedral finds pairs of boxes far outside of the static ones", "[broadphase]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const auto host = make_host(1);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const double far : {20.0, 1e6, 1e300}) {
        const auto stage = library.make<Broadphase>({"tetrahedral", {}, {}}, *host);
        Boxes boxes;
        add_boxes(boxes, 40, true, 5, random);
        add_boxes(boxes, 100, false, 20, random);
        boxes.bounds.push_back({Vec3(-far, -far, 0), Vec3(-far / 2, far, 1)});
        boxes.bounds.push_back({Vec3(-far, far, 1), Vec3(far, far, 1)});
        boxes.bounds.push_back({Vec3(far, 0, 0), Vec3(far, 0, 0)});
        boxes.is_static.resize(boxes.bounds.size(), 0);
        CAPTURE(far);
        REQUIRE(find_pairs(*stage, boxes, 1) == overlapping_pairs(boxes));
    }
}

TEST_CASE("tetrahedral allocates nothing while boxes move among static ones", "[broadphase]") {
    if (!AllocationCounter::available()) return;
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const auto host = make_host(1);
    const auto stage = library.make<Broadphase>({"tetrahedral", {}, {}}, *host);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Boxes boxes;
    add_boxes(boxes, 300, true, 8, random);
    add_boxes(boxes, 300, false, 8, random);
    std::vector<Pair> pairs;
    pairs.reserve(100 * boxes.bounds.size());
    stage->find_pairs({boxes.bounds, boxes.is_static, 1}, pairs);
    const AllocationCounter counter;
    for (int step = 0; step < 50; ++step) {
        for (std::size_t row = 300; row < boxes.bounds.size(); ++row) {
            const Vec3 by = random_point(random, 0.2);
            boxes.bounds[row] = {boxes.bounds[row].min + by, boxes.bounds[row].max + by};
        }
        pairs.clear();
        stage->find_pairs({boxes.bounds, boxes.is_static, 1}, pairs);
    }
    CHECK(counter.count() == 0);
}
