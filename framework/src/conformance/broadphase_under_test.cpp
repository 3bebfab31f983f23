#include "broadphase_under_test.h"

#include <algorithm>
#include <numeric>

namespace kolize {

StagePtr<Broadphase> BroadphaseUnderTest::make(Host& host, const Settings& settings) const {
    StageConfig config = default_config(plugin_);
    config.settings = settings;
    return library_.make<Broadphase>(config, host);
}

std::vector<Pair> BroadphaseUnderTest::find(Broadphase& stage, const BoxScene& scene, std::uint64_t generation) {
    std::vector<Pair> pairs;
    stage.find_pairs({scene.bounds, scene.is_static, generation, scene.is_reference}, pairs);
    return pairs;
}

std::vector<Pair> BroadphaseUnderTest::find_afresh(const BoxScene& scene) const {
    const auto host = make_host(1);
    return find(*make(*host), scene, 1);
}

void BroadphaseUnderTest::expect_right(const BoxScene& scene, Judge judge) const {
    if (!judge(scene, find_afresh(scene)).empty()) throw_reduced(scene, judge);
}

void BroadphaseUnderTest::expect_right(const std::vector<Pair>& pairs, const BoxScene& scene, const std::string& what) {
    if (const std::string wrong = fault(scene, pairs); !wrong.empty())
        throw Violation(what + ": " + wrong + ": " + to_code(scene));
}

void BroadphaseUnderTest::expect_same(std::vector<Pair> pairs, const BoxScene& scene, const std::string& what) const {
    expect_right(pairs, scene, what);
    std::vector<Pair> afresh = find_afresh(scene);
    std::sort(pairs.begin(), pairs.end());
    std::sort(afresh.begin(), afresh.end());
    if (pairs != afresh) throw Violation(what + ": not the pairs that a new object finds: " + to_code(scene));
}

void BroadphaseUnderTest::throw_reduced(BoxScene scene, Judge judge) const {
    for (std::size_t row = scene.bounds.size(); row-- > 0;) {
        std::vector<std::uint32_t> others(scene.bounds.size());
        std::iota(others.begin(), others.end(), 0u);
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(row));
        BoxScene smaller = permute(scene, others);
        if (!judge(smaller, find_afresh(smaller)).empty()) scene = std::move(smaller);
    }
    throw Violation(judge(scene, find_afresh(scene)) + ": " + to_code(scene));
}

}  // namespace kolize
