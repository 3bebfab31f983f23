#include "broadphase_under_test.h"
#include "triangle_families.h"

#include <kolize/predicates.h>

namespace kolize {

namespace {

AccuracyRow compare(const TriangleNarrowphase& test, const TriangleFamily& family, std::uint64_t seed) {
    const std::vector<TrianglePair> pairs = triangle_pairs(family, 1000, seed);
    std::vector<std::uint8_t> hit(pairs.size());
    test.intersect_triangles(pairs, hit, {});
    AccuracyRow row{family.name, pairs.size()};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const bool meet = triangles_intersect(pairs[i].a, pairs[i].b);
        row.hits += meet;
        row.false_hits += hit[i] && !meet;
        row.misses += meet && !hit[i];
    }
    return row;
}

std::vector<AccuracyRow> triangle_accuracy(const PluginLibrary& library, const LoadedPlugin& plugin,
                                           std::uint64_t seed) {
    const auto host = make_host(1);
    const auto stage = library.make<Narrowphase>(default_config(plugin), *host);
    std::vector<AccuracyRow> rows;
    if (const auto* const test = dynamic_cast<const TriangleNarrowphase*>(stage.get()))
        for (const TriangleFamily& family : triangle_families()) rows.push_back(compare(*test, family, seed));
    return rows;
}

class MeasuredBroadphase : BroadphaseUnderTest {
public:
    using BroadphaseUnderTest::BroadphaseUnderTest;

    AccuracyRow compare(const BoxSceneKind& kind) const {
        const BoxScene scene = kind.make(options_.seed);
        const std::size_t count = scene.bounds.size();
        const std::vector<Pair> found = find_afresh(scene);
        AccuracyRow row{kind.name, count * (count - 1) / 2, overlapping_pairs(scene).size()};
        for (const Pair& pair : found) row.false_hits += !scene.bounds[pair.a].overlaps(scene.bounds[pair.b]);
        row.misses = row.hits + row.false_hits - found.size();  // no pair comes twice
        return row;
    }
};

}  // namespace

std::vector<AccuracyRow> measure_accuracy(const PluginLibrary& library, const LoadedPlugin& plugin,
                                          std::uint64_t seed) {
    std::vector<AccuracyRow> rows;
    if (plugin.descriptor->stage == StageKind::narrowphase) return triangle_accuracy(library, plugin, seed);
    if (plugin.descriptor->stage != StageKind::broadphase) return rows;
    ConformanceOptions options;
    options.seed = seed;
    const MeasuredBroadphase measured(library, plugin, options);
    for (const BoxSceneKind& kind : box_scene_kinds()) rows.push_back(measured.compare(kind));
    return rows;
}

}  // namespace kolize
