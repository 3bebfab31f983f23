// Sizes at which brute force takes too long: there the broadphases judge each other.
#include <catch2/catch.hpp>
#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

#include <algorithm>
#include <random>

using namespace kolize;

namespace {

constexpr std::size_t count = 5000;
constexpr std::uint64_t seed = 11;

std::vector<Pair> find_pairs(const PluginLibrary& library, const std::string& plugin, const std::vector<Aabb>& bounds) {
    const auto host = make_host(1);
    const auto stage = library.make<Broadphase>({plugin, {}, {}}, *host);
    const std::vector<std::uint8_t> is_static(bounds.size(), 0);
    std::vector<Pair> pairs;
    stage->find_pairs({bounds, is_static, 1}, pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

void require_agreement(const std::vector<Aabb>& bounds) {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const std::vector<Pair> pairs = find_pairs(library, "grid", bounds);
    CAPTURE(seed, pairs.size());
    REQUIRE(pairs.size() > 100);
    for (const char* other : {"bsp", "regions", "sphere_hierarchy", "sweep_and_prune", "tetrahedral"}) {
        CAPTURE(other);
        CHECK(find_pairs(library, other, bounds) == pairs);
    }
}

// `size` gives the side of box number i; the cube holds about two overlaps a box of side 1.
template <class Size>
std::vector<Aabb> scattered(Size&& size) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(0, std::cbrt(4.0 * count)), unit(0, 1);
    std::vector<Aabb> bounds;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 corner(place(random), place(random), place(random));
        bounds.push_back({corner, corner + Vec3::Constant(size(i, unit(random)))});
    }
    return bounds;
}

}  // namespace

TEST_CASE("broadphases agree on thousands of boxes", "[broadphase]") {
    SECTION("of one size") {
        require_agreement(scattered([](std::size_t, double) { return 1.0; }));
    }
    SECTION("of sizes after a power law") {
        require_agreement(scattered([](std::size_t, double u) { return 0.1 * std::pow(1 - u, -0.5); }));
    }
    SECTION("with a few that are far larger than the rest") {
        require_agreement(scattered([](std::size_t i, double) { return i % 1000 == 0 ? 1e4 : 0.5; }));
    }
    SECTION("with one that is far away, so that the cells in use wrap round") {
        std::vector<Aabb> bounds = scattered([](std::size_t, double) { return 1.0; });
        bounds[0] = {Vec3::Constant(-1e9), Vec3::Constant(-1e9 + 1)};
        require_agreement(bounds);
    }
    SECTION("on a plane") {
        std::vector<Aabb> bounds = scattered([](std::size_t, double) { return 0.5; });
        for (Aabb& box : bounds) box.min.y() = box.max.y() = 2;
        require_agreement(bounds);
    }
}
