// What the grid keeps from call to call never shows: long histories against brute force.
#include "oracle/allocation_counter.h"

#include <catch2/catch.hpp>
#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

#include <algorithm>
#include <random>

using namespace kolize;

namespace {

struct History {
    std::vector<Aabb> bounds;
    std::vector<std::uint8_t> is_static;
    std::uint64_t generation = 1;

    BroadphaseInput input() const { return {bounds, is_static, generation}; }
};

std::vector<Pair> brute_force(const History& now) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < now.bounds.size(); ++a)
        for (std::uint32_t b = a + 1; b < now.bounds.size(); ++b)
            if (!(now.is_static[a] && now.is_static[b]) && now.bounds[a].overlaps(now.bounds[b]))
                pairs.push_back({a, b});
    return pairs;
}

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    std::size_t below(std::size_t n) { return engine_() % n; }
    Vec3 point(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }

private:
    std::mt19937_64 engine_;
};

struct Kind {
    const char* name;
    Vec3 place;      // of the middle
    double half;     // of the cube of the corners
    double decades;  // of sizes, down from 1 m
    bool on_lattice;
};

Aabb random_box(const Kind& kind, Random& random) {
    Vec3 corner = random.point(kind.half);
    const auto side = [&] { return std::pow(10, -random.between(0, kind.decades)); };
    Vec3 size(side(), side(), side());
    if (kind.on_lattice) corner = corner.array().floor(), size = Vec3(1, random.below(2), 1);  // touching, some flat
    corner += kind.place;
    return {corner, corner + size};
}

// Moves a share of the boxes: most a little, some anywhere, a few very far or to another size.
void step(History& now, const Kind& kind, Random& random) {
    const double share = std::pow(random.between(0, 1), 3);
    for (std::size_t row = 0; row < now.bounds.size(); ++row) {
        if (now.is_static[row] || random.between(0, 1) > share) continue;
        Aabb& box = now.bounds[row];
        const std::size_t how = random.below(40);
        const Vec3 by = kind.on_lattice ? Vec3(random.point(2).array().floor()) : random.point(0.3);
        if (how > 2) box = {box.min + by, box.max + by};
        if (how == 2) box = random_box(kind, random);
        if (how == 1) box = {box.min + Vec3::Constant(1e13), box.max + Vec3::Constant(1e13)};
        if (how == 0) box.max += Vec3::Constant(random.between(0, random.below(5) == 0 ? 30 : 2));
    }
}

void renew(History& now, const Kind& kind, Random& random) {
    ++now.generation;
    if (random.below(2) == 0) now.bounds.resize(random.below(2) * 150 + random.below(4));
    for (Aabb& box : now.bounds) box = random_box(kind, random);
    now.is_static.resize(now.bounds.size());
    const std::size_t statics = random.below(4);
    for (std::uint8_t& flag : now.is_static) flag = random.below(4) < statics;
}

const Kind kinds[] = {{"sparse", Vec3::Zero(), 4.5, 0, false},
                      {"dense", Vec3::Zero(), 1.5, 0, false},
                      {"1e12 m away", Vec3(1e12, -1e12, 1e12), 4.5, 0, false},
                      {"of six decades", Vec3::Zero(), 3, 6, false},
                      {"on a lattice", Vec3::Zero(), 4, 0, true}};

StagePtr<Broadphase> make_grid(const PluginLibrary& library, Host& host) {
    return library.make<Broadphase>({"grid", {}, {}}, host);
}

}  // namespace

TEST_CASE("the grid finds what brute force finds, whatever came before", "[broadphase]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const auto host = make_host(1);
    for (const Kind& kind : kinds)
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            Random random(seed);
            const auto grid = make_grid(library, *host);
            History now;
            now.bounds.resize(150);
            renew(now, kind, random);
            for (int call = 0; call < 80; ++call) {
                std::vector<Pair> pairs;
                grid->find_pairs(now.input(), pairs);
                std::sort(pairs.begin(), pairs.end());
                CAPTURE(kind.name, seed, call, now.bounds.size());
                REQUIRE(pairs == brute_force(now));
                if (random.below(25) == 0)
                    renew(now, kind, random);
                else
                    step(now, kind, random);
            }
        }
}

TEST_CASE("the grid refuses a bad box that moved, and goes on with the last good ones", "[broadphase]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const auto host = make_host(1);
    const auto grid = make_grid(library, *host);
    Random random(7);
    History now;
    for (int i = 0; i < 150; ++i) now.bounds.push_back(random_box(kinds[0], random));
    now.is_static.assign(150, 0);
    std::vector<Pair> pairs;
    grid->find_pairs(now.input(), pairs);
    const Aabb good = now.bounds[17];
    for (const Aabb& bad : {Aabb{good.max, good.min}, Aabb{good.min, Vec3::Constant(infinity)},
                            Aabb{Vec3::Constant(std::nan("")), good.max}}) {
        now.bounds[3].max.x() += 0.1;
        now.bounds[17] = bad;
        CHECK_THROWS_WITH(grid->find_pairs(now.input(), pairs), Catch::Contains("row 17"));
        now.bounds[17] = good;
        pairs.clear();
        grid->find_pairs(now.input(), pairs);
        std::sort(pairs.begin(), pairs.end());
        CHECK(pairs == brute_force(now));
    }
}

TEST_CASE("the grid allocates nothing when a few boxes move, or all", "[broadphase]") {
    if (!AllocationCounter::available()) return;
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const auto host = make_host(1);
    const auto grid = make_grid(library, *host);
    Random random(11);
    History now;
    for (int i = 0; i < 1000; ++i) now.bounds.push_back(random_box({"", Vec3::Zero(), 8, 0, false}, random));
    now.is_static.assign(now.bounds.size(), 0);
    std::vector<Pair> pairs;
    pairs.reserve(100000);
    for (int call = 0; call < 60; ++call) {
        const AllocationCounter counter;
        pairs.clear();
        grid->find_pairs(now.input(), pairs);
        const std::size_t allocations = counter.count();
        CAPTURE(call);
        if (call > 0) CHECK(allocations == 0);
        for (std::size_t row = 0; row < now.bounds.size(); row += call % 7 == 0 ? 1 : 10) {
            const Vec3 by = random.point(0.1);
            now.bounds[row] = {now.bounds[row].min + by, now.bounds[row].max + by};
        }
    }
}
