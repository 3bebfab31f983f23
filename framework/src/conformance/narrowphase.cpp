#include "impact_times.h"
#include "metamorphic.h"
#include "narrowphase_under_test.h"

namespace kolize {

namespace {

// The plugin under test; the checks are its member functions.
class NarrowphaseChecks : NarrowphaseUnderTest {
public:
    using NarrowphaseUnderTest::NarrowphaseUnderTest;

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

    // Here and below regions are compared: which four points of a region are taken may hang on the last digit.
    void exchanged_bodies() const {
        const Detail detail = std::min(gives(), Detail::normal);
        for_each_world([&](const World& world) {
            auto there = find_pair(exchanged(world), detail).rows;
            for (Contact& c : there) {
                c.normal = -c.normal;
                std::swap(c.arm_a, c.arm_b);
            }
            if (!same_geometry(find_pair(world, detail).rows, there, tolerance))
                violate("exchanging the bodies gives other contacts", world);
        });
    }

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
    check_metamorphic_narrowphase(library, plugin, options, suite);
    return suite.take();
}

}  // namespace kolize
