// kolize bench: one stage alone on a recorded input, in as many variants as asked for.
#include "box_workload.h"
#include "common.h"

#include <algorithm>
#include <iostream>

namespace kolize::cli {
namespace {

struct BenchOptions {
    std::string workload;
    std::vector<std::string> vary;
    std::vector<std::string> set;
    std::vector<std::string> plugin_path;
    int repeat = 5;
    int threads = 1;
    std::string json;
};

struct Variant {
    Settings settings;
    const LoadedPlugin* plugin;
    StagePtr<Broadphase> stage;
    std::vector<double> milliseconds;  // one a frame and round
    std::vector<std::size_t> pairs;    // per frame
    bool same_pairs = true;            // the overlapping ones of every frame are those of the first variant
};

using PairFrames = std::vector<std::vector<Pair>>;

bool names_plugin(const std::vector<Variation>& variations, const Settings& fixed) {
    const std::string key = "broadphase.plugin";
    return std::any_of(variations.begin(), variations.end(), [&](const auto& v) { return v.key == key; }) ||
           std::any_of(fixed.begin(), fixed.end(), [&](const auto& setting) { return setting.first == key; });
}

std::vector<Variant> make_variants(const BenchOptions& options, const PluginLibrary& library, Host& host) {
    const Settings fixed = parse_settings(options.set);
    std::vector<Variation> variations = parse_variations(options.vary);
    if (!names_plugin(variations, fixed)) {
        variations.insert(variations.begin(), {"broadphase.plugin", library.names(StageKind::broadphase)});
        if (variations.front().values.empty()) throw Error("no broadphase plugin was found (see kolize plugins list)");
    }
    std::vector<Variant> variants;
    for (const Settings& varied : combinations(variations)) {
        Settings all = fixed;
        all.insert(all.end(), varied.begin(), varied.end());
        const StageConfig config = stage_config(StageKind::broadphase, all, plugin_defaults().broadphase);
        variants.push_back({varied,
                            &library.require(StageKind::broadphase, config.plugin, config.where),
                            library.make<Broadphase>(config, host),
                            {},
                            {},
                            true});
    }
    return variants;
}

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
        table.add({variant.settings.empty() ? variant.plugin->descriptor->name : label(variant.settings),
                   number(median(variant.milliseconds)), number(quantile(variant.milliseconds, 0.95)),
                   pairs_per_frame(variant), variant.same_pairs ? "yes" : "NO"});
    table.print(std::cout);
}

Json to_json(const Variant& variant) {
    Json stage{{"plugin", variant.plugin->descriptor->name}};
    for (const auto& [name, value] : effective_settings(*variant.plugin, *variant.stage))
        stage[name] = cli::to_json(value);
    return {{"broadphase", stage},
            {"median_ms", median(variant.milliseconds)},
            {"p95_ms", quantile(variant.milliseconds, 0.95)},
            {"pairs", variant.pairs},
            {"same_pairs", variant.same_pairs}};
}

Json to_json(const BenchOptions& options, const BoxFrames& frames, const std::vector<Variant>& variants) {
    Json json{{"stage", "broadphase"},          {"workload", options.workload}, {"frames", frames.size()},
              {"boxes", frames.front().size()}, {"repeat", options.repeat},     {"threads", options.threads},
              {"variants", Json::array()}};
    for (const Variant& variant : variants) json["variants"].push_back(to_json(variant));
    json["host"] = host_block();
    json["command"] = command_line();
    return json;
}

int bench_broadphase(const BenchOptions& options) {
    const BoxFrames frames = read_box_frames(options.workload);
    const PluginLibrary library =
        open_plugins(options.plugin_path, std::filesystem::path(options.workload).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    std::vector<Variant> variants = make_variants(options, library, *host);
    measure(variants, frames, options.repeat);
    if (options.json != "-") {
        std::cout << options.workload << ": " << frames.size() << " frames of " << frames.front().size() << " boxes, "
                  << options.repeat << " rounds\n\n";
        print_variants(variants);
    }
    if (!options.json.empty()) write_json(to_json(options, frames, variants), options.json);
    return std::all_of(variants.begin(), variants.end(), [](const Variant& v) { return v.same_pairs; }) ? 0 : 1;
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* bench = app.add_subcommand("bench", "Measure one stage alone on a recorded input");
    bench->require_subcommand(1);
    bench->footer("Example: kolize bench broadphase boxes.csv");
    CLI::App* command = bench->add_subcommand("broadphase", "Find the overlapping pairs of moving boxes");
    command
        ->add_option("workload", options->workload,
                     "CSV (frame,min_x,min_y,min_z,max_x,max_y,max_z; a row per box) or .npy [frames, boxes, 6]")
        ->required();
    command->add_option("--vary", options->vary, "Values to compare (KEY=V1,V2,...; repeatable)")
        ->allow_extra_args(false);
    command->add_option("--repeat", options->repeat, "Timed rounds over all frames")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    add_set_option(*command, options->set);
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    add_json_option(*command, options->json);
    command->footer(
        "Without a choice of broadphase.plugin all that are found are compared.\n"
        "Example: kolize bench broadphase boxes.csv --vary broadphase.plugin=grid,bsp --json -");
    command->callback([options, &exit_code] { exit_code = bench_broadphase(*options); });
}

}  // namespace kolize::cli
