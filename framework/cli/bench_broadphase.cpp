#include "bench.h"

#include "box_workload.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>

namespace kolize::cli {
namespace {

struct Variant {
    PlannedVariant plan;
    StagePtr<Broadphase> stage;
    std::vector<double> milliseconds;  // one a frame and round
    std::vector<std::size_t> pairs;    // per frame
    bool same_pairs = true;            // the overlapping ones of every frame are those of the first variant
};

using PairFrames = std::vector<std::vector<Pair>>;

// Untimed: warms the variant up, and compares its pairs with those of the first variant, which come empty for that one.
void check_pairs(Variant& variant, const BoxFrames& frames, PairFrames& reference) {
    const std::vector<std::uint8_t> is_static(frames.front().size(), 0);
    const bool is_first = reference.empty();
    std::vector<Pair> pairs;
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        const std::vector<Aabb>& bounds = frames[frame];
        pairs.clear();
        variant.stage->find_pairs({bounds, is_static, 1}, pairs);
        variant.pairs.push_back(pairs.size());
        std::erase_if(pairs, [&](const Pair& pair) { return !bounds[pair.a].overlaps(bounds[pair.b]); });
        std::sort(pairs.begin(), pairs.end());
        if (is_first)
            reference.push_back(pairs);
        else
            variant.same_pairs = variant.same_pairs && pairs == reference[frame];
    }
}

void time_round(Variant& variant, const BoxFrames& frames) {
    using Clock = std::chrono::steady_clock;
    const std::vector<std::uint8_t> is_static(frames.front().size(), 0);
    std::vector<Pair> pairs;
    pairs.reserve(*std::max_element(variant.pairs.begin(), variant.pairs.end()));
    for (const std::vector<Aabb>& bounds : frames) {
        pairs.clear();
        const auto start = Clock::now();
        variant.stage->find_pairs({bounds, is_static, 1}, pairs);
        variant.milliseconds.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
}

// Round by round over all variants, so that a disturbance of the machine falls on all of them.
void measure(std::vector<Variant>& variants, const BoxFrames& frames, int repeat) {
    Progress progress("bench", variants.size() * static_cast<std::size_t>(repeat + 1));
    PairFrames reference;
    for (Variant& variant : variants) {
        check_pairs(variant, frames, reference);
        progress.advance();
    }
    for (int round = 0; round < repeat; ++round)
        for (Variant& variant : variants) {
            time_round(variant, frames);
            progress.advance();
        }
}

std::string pairs_per_frame(const Variant& variant) {
    const auto [least, most] = std::minmax_element(variant.pairs.begin(), variant.pairs.end());
    return *least == *most ? std::to_string(*least) : std::to_string(*least) + " to " + std::to_string(*most);
}

void print_variants(const std::vector<Variant>& variants) {
    Table table({"variant", "median ms", "p95 ms", "pairs a frame", "same pairs"});
    for (const Variant& variant : variants)
        table.add({variant.plan.name(), number(median(variant.milliseconds)),
                   number(quantile(variant.milliseconds, 0.95)), pairs_per_frame(variant),
                   variant.same_pairs ? "yes" : "NO"});
    table.print(std::cout);
}

Json to_json(const Variant& variant) {
    return {{"broadphase", stage_json(*variant.plan.plugin, *variant.stage)},
            {"median_ms", median(variant.milliseconds)},
            {"p95_ms", quantile(variant.milliseconds, 0.95)},
            {"pairs", variant.pairs},
            {"same_pairs", variant.same_pairs}};
}

Json to_json(const BenchOptions& options, const BoxFrames& frames, const std::vector<Variant>& variants) {
    Json json = bench_json(options, StageKind::broadphase);
    json["frames"] = frames.size();
    json["boxes"] = frames.front().size();
    json["variants"] = Json::array();
    for (const Variant& variant : variants) json["variants"].push_back(to_json(variant));
    return json;
}

}  // namespace

int bench_broadphase(const BenchOptions& options) {
    const BoxFrames frames = read_box_frames(options.workload);
    const PluginLibrary library =
        open_plugins(options.plugin_path, std::filesystem::path(options.workload).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    std::vector<Variant> variants;
    for (PlannedVariant& plan : plan_variants(options, StageKind::broadphase, plugin_defaults().broadphase, library))
        variants.push_back({plan, library.make<Broadphase>(plan.config, *host), {}, {}, true});
    measure(variants, frames, options.repeat);
    if (options.json != "-") {
        std::cout << options.workload << ": " << frames.size() << " frames of " << frames.front().size() << " boxes, "
                  << options.repeat << " rounds\n\n";
        print_variants(variants);
    }
    if (!options.json.empty()) write_json(to_json(options, frames, variants), options.json);
    return std::all_of(variants.begin(), variants.end(), [](const Variant& v) { return v.same_pairs; }) ? 0 : 1;
}

}  // namespace kolize::cli
