#include "narrowphase_under_test.h"

#include <algorithm>

namespace kolize {

bool same_bits(const std::vector<Contact>& a, const std::vector<Contact>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].a != b[i].a || a[i].b != b[i].b || a[i].region != b[i].region || a[i].normal != b[i].normal ||
            a[i].arm_a != b[i].arm_a || a[i].arm_b != b[i].arm_b || a[i].depth != b[i].depth)
            return false;
    return true;
}

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

World NarrowphaseUnderTest::crowd() const {
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

std::vector<Pair> NarrowphaseUnderTest::all_pairs(const World& world) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < world.size(); ++a)
        for (std::uint32_t b = a + 1; b < world.size(); ++b)
            if (!world.is_static[a] || !world.is_static[b]) pairs.push_back({a, b});
    return pairs;
}

StagePtr<Narrowphase> NarrowphaseUnderTest::make(Host& host, const World& world, const Settings& settings) const {
    StageConfig config = default_config(plugin_);
    config.settings = settings;
    auto stage = library_.make<Narrowphase>(config, host);
    stage->prepare(world);
    return stage;
}

Detail NarrowphaseUnderTest::gives() const {
    const auto host = make_host(1);
    return library_.make<Narrowphase>(default_config(plugin_), *host)->gives();
}

Contacts NarrowphaseUnderTest::find(Narrowphase& stage, const World& world, const std::vector<Pair>& pairs,
                                    Detail detail) {
    const std::vector<Detail> details(pairs.size(), detail);
    Contacts contacts;
    stage.find_contacts({world, pairs, details}, contacts);
    return contacts;
}

Contacts NarrowphaseUnderTest::find(const World& world, const std::vector<Pair>& pairs, Detail detail,
                                    int threads) const {
    const auto host = make_host(threads);
    return find(*make(*host, world), world, pairs, detail);
}

}  // namespace kolize
