#include "impact_times.h"
#include "suite.h"
#include "two_solids.h"

#include <kolize/simulation.h>

#include <cstring>

namespace kolize {

namespace {

constexpr double tolerance = 1e-9;  // m, rad: for solids of size 1 seen from another side

[[noreturn]] void violate(const std::string& what, const World& world) {
    throw Violation(what + ": " + to_text(world));
}

bool same_bits(const std::vector<Contact>& a, const std::vector<Contact>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].a != b[i].a || a[i].b != b[i].b || a[i].region != b[i].region || a[i].normal != b[i].normal ||
            a[i].arm_a != b[i].arm_a || a[i].arm_b != b[i].arm_b || a[i].depth != b[i].depth)
            return false;
    return true;
}

// Each contact of `a` has its like in `b`, wherever it stands there.
bool same_geometry(const std::vector<Contact>& a, const std::vector<Contact>& b, double within) {
    const auto alike = [&](const Contact& x, const Contact& y) {
        return (x.normal - y.normal).norm() < within && (x.arm_a - y.arm_a).norm() < within &&
               (x.arm_b - y.arm_b).norm() < within && std::abs(x.depth - y.depth) < within;
    };
    if (a.size() != b.size()) return false;
    for (const Contact& x : a)
        if (std::none_of(b.begin(), b.end(), [&](const Contact& y) { return alike(x, y); })) return false;
    return true;
}

// The plugin under test; the checks are its member functions.
class NarrowphaseChecks {
public:
    NarrowphaseChecks(const PluginLibrary& library, const LoadedPlugin& plugin, const ConformanceOptions& options)
        : library_(library), plugin_(plugin), options_(options) {}

    void nothing_to_find() const {
        std::mt19937_64 random(options_.seed);
        const World world = solids(random);
        if (!find(world, {}, {}).rows.empty()) violate("contacts without pairs", world);
    }

    void rows_mean_what_they_should() const {
        for_each_world([&](const World& world) {
            const Detail most = gives();
            for (const Contact& c : find_pair(world, most).rows) {
                if (c.a != 0 || c.b != 1) violate("a contact of bodies that were not asked for", world);
                if (most == Detail::overlap) continue;
                if (!(std::abs(c.normal.norm() - 1) < 1e-9)) violate("a normal that is not a unit vector", world);
                if (!(c.depth > 0)) violate("a depth that is not above 0", world);
                if ((world.position[0] + c.arm_a - world.position[1] - c.arm_b).norm() > tolerance)
                    violate("arms that do not end in the same point", world);
            }
        });
    }

    void less_detail_is_less() const {
        for_each_world([&](const World& world) {
            const std::size_t overlaps = find_pair(world, Detail::overlap).rows.size();
            if (overlaps > 1) violate("overlap asked for, and more than one row for the pair", world);
            for (const Contact& c : find_pair(world, Detail::overlap).rows)
                if (!c.normal.isZero(0) || !c.arm_a.isZero(0) || c.depth != 0)
                    violate("overlap asked for, and columns filled that nobody wants", world);
            if (gives() == Detail::overlap) return;
            const auto regions = find_pair(world, Detail::normal).rows;
            for (std::size_t i = 0; i < regions.size(); ++i)
                if (regions[i].region != i) violate("normal asked for, and not one row for each region in turn", world);
            if (regions.empty() != (overlaps == 0))
                violate("overlap and normal disagree on whether the pair touches", world);
            if (gives() == Detail::normal) return;
            std::vector<int> points(regions.size() + 1, 0);
            for (const Contact& c : find_pair(world, Detail::manifold).rows)
                if (c.region >= regions.size() || ++points[c.region] > 4)
                    violate("manifold asked for, and other regions than for normal, or more than four points in one",
                            world);
        });
    }

    void exchanged_bodies() const {
        for_each_world([&](const World& world) {
            auto there = find_pair(exchanged(world), gives()).rows;
            for (Contact& c : there) {
                c.normal = -c.normal;
                std::swap(c.arm_a, c.arm_b);
            }
            if (!same_geometry(find_pair(world, gives()).rows, there, tolerance))
                violate("exchanging the bodies gives other contacts", world);
        });
    }

    // Regions are compared: which four points of a region are taken may hang on the last digit.
    void turned_and_moved() const {
        std::mt19937_64 random(options_.seed + 1);
        const Detail detail = std::min(gives(), Detail::normal);
        for_each_world([&](const World& world) {
            const Mat3 turn = random_rotation(random);
            auto rows = find_pair(world, detail).rows;
            for (Contact& c : rows) {
                c.normal = turn * c.normal;
                c.arm_a = turn * c.arm_a;
                c.arm_b = turn * c.arm_b;
            }
            const auto moved = find_pair(placed_elsewhere(world, turn, Vec3(3, -2, 1)), detail).rows;
            if (!same_geometry(rows, moved, tolerance))
                violate("turning and moving the whole gives other contacts", world);
        });
    }

    // A million metres away a position has lost 1e-10 m; arms and normals may lose no more.
    void far_from_the_origin() const {
        const Detail detail = std::min(gives(), Detail::normal);
        for_each_world([&](const World& world) {
            const auto far = find_pair(placed_elsewhere(world, Mat3::Identity(), Vec3(1e6, -2e6, 3e6)), detail).rows;
            if (reference_overlap(world) == Overlap::too_close_to_tell) return;
            if (!same_geometry(find_pair(world, detail).rows, far, 1e-6))
                violate("contacts change a million metres from the origin", world);
        });
    }

    void agrees_with_brute_force() const {
        std::size_t overlapping = 0, apart = 0;
        for_each_world([&](const World& world) {
            const Overlap expected = reference_overlap(world);
            if (expected == Overlap::too_close_to_tell) return;
            const bool found = !find_pair(world, gives()).rows.empty();
            if (found && answers_for_volumes()) return;
            if (found != (expected == Overlap::overlapping))
                violate(found ? "a contact where surfaces are apart" : "no contact where surfaces intersect", world);
            ++(found ? overlapping : apart);
        });
        if ((overlapping < 10 && !answers_for_volumes()) || apart < 10)
            throw Violation("the suite's own input does not cover both answers");
    }

    void same_bits_again() const {
        const World world = crowd();
        const std::vector<Pair> pairs = all_pairs(world);
        const Contacts once = find(world, pairs, gives(), 1);
        for (const int threads : {1, 2, 8})
            if (!same_bits(once.rows, find(world, pairs, gives(), threads).rows))
                throw Violation("other bits with " + std::to_string(threads) + " threads");
    }

    void pairs_do_not_influence_each_other() const {
        const World world = crowd();
        const auto host = make_host(1);
        const auto stage = make(*host, world);
        const std::vector<Pair> pairs = all_pairs(world);
        const Contacts together = find(*stage, world, pairs, gives());
        std::vector<Contact> one_by_one;
        for (const Pair& pair : pairs) {
            const Contacts alone = find(*stage, world, {pair}, gives());
            one_by_one.insert(one_by_one.end(), alone.rows.begin(), alone.rows.end());
        }
        if (!same_bits(together.rows, one_by_one)) throw Violation("a pair alone gives other bits than among others");
    }

    void refuses_what_is_not_finite() const {
        std::mt19937_64 random(options_.seed);
        for (const double bad : {std::nan(""), infinity}) {
            World world = solids(random);
            world.position[1][2] = bad;
            try {
                find_pair(world, gives());
            } catch (const std::invalid_argument&) {
                continue;
            }
            violate("a position that is not finite is not refused with std::invalid_argument", world);
        }
    }

    void warm_calls_allocate_nothing() const {
        if (plugin_.descriptor->capabilities.allocates) throw Inapplicable("it declares that its calls allocate");
        if (!options_.allocations) throw Inapplicable("this program does not count allocations");
        const World world = crowd();
        const auto host = make_host(1);
        const auto stage = make(*host, world);
        const std::vector<Pair> pairs = all_pairs(world);
        const std::vector<Detail> detail(pairs.size(), gives());
        Contacts contacts;
        std::size_t count = 0;
        for (int call = 0; call < 4; ++call) {
            contacts.clear();
            const std::size_t before = options_.allocations();
            stage->find_contacts({world, pairs, detail}, contacts);
            count = options_.allocations() - before;
        }
        if (count > 0) throw Violation(std::to_string(count) + " allocations in a fourth call on the same pairs");
    }

private:
    // What it finds to overlap are bounding volumes, of bodies that may be apart.
    bool answers_for_volumes() const { return plugin_.descriptor->capabilities.bounding_spheres; }

    World solids(std::mt19937_64& random) const {
        return random_two_solids(random, plugin_.descriptor->capabilities.shape_kinds);
    }

    template <class CheckWorld>
    void for_each_world(CheckWorld&& check) const {
        std::mt19937_64 random(options_.seed);
        for (int round = 0; round < 150; ++round) check(solids(random));
    }

    // Many bodies of all kinds close together.
    World crowd() const {
        std::mt19937_64 random(options_.seed);
        World world = solids(random);
        for (int round = 0; round < 20; ++round) {
            const World more = solids(random);
            const auto first_shape = static_cast<std::uint32_t>(world.shapes.size());
            world.shapes.insert(world.shapes.end(), more.shapes.begin(), more.shapes.end());
            for (std::uint32_t body = 0; body < more.size(); ++body) {
                BodyDescription description;
                description.shape = first_shape + more.shape[body];
                description.is_static = more.is_static[body];
                description.mass = 1;
                description.position = more.model_position(body);
                description.orientation = more.model_orientation(body);
                world.add(description);
            }
        }
        return world;
    }

    static std::vector<Pair> all_pairs(const World& world) {
        std::vector<Pair> pairs;
        for (std::uint32_t a = 0; a < world.size(); ++a)
            for (std::uint32_t b = a + 1; b < world.size(); ++b)
                if (!world.is_static[a] || !world.is_static[b]) pairs.push_back({a, b});
        return pairs;
    }

    StagePtr<Narrowphase> make(Host& host, const World& world) const {
        auto stage = library_.make<Narrowphase>(default_config(plugin_), host);
        stage->prepare(world);
        return stage;
    }

    Detail gives() const {
        const auto host = make_host(1);
        return library_.make<Narrowphase>(default_config(plugin_), *host)->gives();
    }

    static Contacts find(Narrowphase& stage, const World& world, const std::vector<Pair>& pairs, Detail detail) {
        const std::vector<Detail> details(pairs.size(), detail);
        Contacts contacts;
        stage.find_contacts({world, pairs, details}, contacts);
        return contacts;
    }

    Contacts find(const World& world, const std::vector<Pair>& pairs, Detail detail, int threads = 1) const {
        const auto host = make_host(threads);
        return find(*make(*host, world), world, pairs, detail);
    }

    Contacts find_pair(const World& world, Detail detail) const { return find(world, {{0, 1}}, detail); }

    const PluginLibrary& library_;
    const LoadedPlugin& plugin_;
    const ConformanceOptions& options_;
};

}  // namespace

std::vector<Check> check_narrowphase(const PluginLibrary& library, const LoadedPlugin& plugin,
                                     const ConformanceOptions& options) {
    const NarrowphaseChecks checks(library, plugin, options);
    Suite suite;
    suite.run("no pairs, no contacts", [&] { checks.nothing_to_find(); });
    suite.run("rows mean what contact.h says", [&] { checks.rows_mean_what_they_should(); });
    suite.run("asked for less, gives less", [&] { checks.less_detail_is_less(); });
    suite.run("agrees with brute force on overlap", [&] { checks.agrees_with_brute_force(); });
    suite.run("bodies exchanged", [&] { checks.exchanged_bodies(); });
    suite.run("the whole turned and moved", [&] { checks.turned_and_moved(); });
    suite.run("a million metres from the origin", [&] { checks.far_from_the_origin(); });
    suite.run("same bits again, 1, 2 and 8 threads", [&] { checks.same_bits_again(); });
    suite.run("pairs do not influence each other", [&] { checks.pairs_do_not_influence_each_other(); });
    suite.run("poses that are not finite are refused", [&] { checks.refuses_what_is_not_finite(); });
    suite.run("warm calls allocate nothing", [&] { checks.warm_calls_allocate_nothing(); });
    check_impact_times(library, plugin, options, suite);
    return suite.take();
}

}  // namespace kolize
