#include "bench.h"
#include "triangle_workload.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>

namespace kolize::cli {
namespace {

struct Variant {
    PlannedVariant plan;
    StagePtr<Narrowphase> stage;
    const TriangleNarrowphase* test;   // the stage, seen as what it is
    std::vector<double> milliseconds;  // one a round, over all pairs
    std::vector<std::uint8_t> hit;     // per pair: its answer

    std::size_t answers(const TriangleWorkload& workload, bool answer, bool truth) const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < workload.hit.size(); ++i)
            count += (hit[i] != 0) == answer && (workload.hit[i] != 0) == truth;
        return count;
    }
    std::size_t false_positives(const TriangleWorkload& workload) const { return answers(workload, true, false); }
    std::size_t false_negatives(const TriangleWorkload& workload) const { return answers(workload, false, true); }
    std::size_t hits() const { return static_cast<std::size_t>(std::count(hit.begin(), hit.end(), 1)); }
};

// Plugins that find intersecting triangles in their own way have no test to call: left out, or refused if named.
std::vector<Variant> make_variants(const BenchOptions& options, const PluginLibrary& library, Host& host) {
    const bool named = names_plugin(options, StageKind::narrowphase);
    std::vector<Variant> variants;
    for (PlannedVariant& plan :
         plan_variants(options, StageKind::narrowphase, plugin_defaults().narrowphase, library)) {
        StagePtr<Narrowphase> stage = library.make<Narrowphase>(plan.config, host);
        const auto* test = dynamic_cast<const TriangleNarrowphase*>(stage.get());
        if (test)
            variants.push_back({plan, std::move(stage), test, {}, {}});
        else if (named)
            throw Error("narrowphase '" + plan.config.plugin + "' does not test triangles pair by pair");
    }
    if (variants.empty()) throw Error("no narrowphase plugin was found that tests triangles pair by pair");
    return variants;
}

// Round by round over all variants, so that a disturbance of the machine falls on all of them. The first warms up.
void measure(std::vector<Variant>& variants, const TriangleWorkload& workload, int repeat) {
    using Clock = std::chrono::steady_clock;
    Progress progress("bench", variants.size() * static_cast<std::size_t>(repeat + 1));
    for (int round = 0; round <= repeat; ++round)
        for (Variant& variant : variants) {
            variant.hit.resize(workload.pairs.size());
            const auto start = Clock::now();
            variant.test->intersect_triangles(workload.pairs, variant.hit, {});
            const std::chrono::duration<double, std::milli> time = Clock::now() - start;
            if (round > 0) variant.milliseconds.push_back(time.count());
            progress.advance();
        }
}

void print_variants(const std::vector<Variant>& variants, const TriangleWorkload& workload) {
    Table table({"variant", "median ms", "10^6 tests/s", "hits", "false positives", "false negatives"});
    const bool judged = !workload.hit.empty();
    for (const Variant& variant : variants) {
        const double time = median(variant.milliseconds);
        table.add({variant.plan.name(), number(time), number(1e-3 * double(workload.pairs.size()) / time),
                   std::to_string(variant.hits()), judged ? std::to_string(variant.false_positives(workload)) : "-",
                   judged ? std::to_string(variant.false_negatives(workload)) : "-"});
    }
    table.print(std::cout);
}

Json to_json(const BenchOptions& options, const TriangleWorkload& workload, const std::vector<Variant>& variants) {
    Json json = bench_json(options, StageKind::narrowphase);
    json["tests"] = workload.pairs.size();
    json["variants"] = Json::array();
    for (const Variant& variant : variants) {
        Json row{{"narrowphase", stage_json(*variant.plan.plugin, *variant.stage)},
                 {"median_ms", median(variant.milliseconds)},
                 {"p95_ms", quantile(variant.milliseconds, 0.95)},
                 {"pairs", {variant.hits()}}};
        if (!workload.hit.empty()) {
            row["false_positive"] = variant.false_positives(workload);
            row["false_negative"] = variant.false_negatives(workload);
        }
        json["variants"].push_back(row);
    }
    return json;
}

}  // namespace

int bench_narrowphase(const BenchOptions& options) {
    if (std::filesystem::is_directory(options.workload)) return bench_narrowphase_calls(options);
    const TriangleWorkload workload = read_triangle_pairs(options.workload);
    const PluginLibrary library =
        open_plugins(options.plugin_path, std::filesystem::path(options.workload).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    std::vector<Variant> variants = make_variants(options, library, *host);
    measure(variants, workload, options.repeat);
    if (options.json != "-") {
        std::cout << options.workload << ": " << workload.pairs.size() << " pairs of triangles, " << options.repeat
                  << " rounds\n\n";
        print_variants(variants, workload);
    }
    if (!options.json.empty()) write_json(to_json(options, workload, variants), options.json);
    return 0;
}

}  // namespace kolize::cli
