// bench_triangle_tests: every triangle test there is, in each precision: how fast, and how often wrong.
//
// Speed is that of batches of 64 pairs, as the walk over two meshes hands them over, from the processor's cache and on
// one thread. Answers are compared with an oracle in rational numbers, family by family.
#include "conformance/triangle_families.h"
#include "oracle/rational_triangles.h"

#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>

namespace {

using kolize::TrianglePair;
using Pairs = std::vector<TrianglePair>;
using Answers = std::vector<std::uint8_t>;

struct Contestant {
    std::string name;
    kolize::StagePtr<kolize::Narrowphase> stage;
    std::vector<std::vector<double>> rates = {};  // pairs per s: one a round, for each workload

    void answer(const Pairs& pairs, Answers& hit) const {
        constexpr std::size_t batch = 64;
        const auto& test = dynamic_cast<const kolize::TriangleNarrowphase&>(*stage);
        hit.resize(pairs.size());
        for (std::size_t first = 0; first < pairs.size(); first += batch) {
            const std::size_t count = std::min(batch, pairs.size() - first);
            test.intersect_triangles(std::span(pairs).subspan(first, count), std::span(hit).subspan(first, count), {});
        }
    }
};

std::vector<Contestant> contestants(const kolize::PluginLibrary& library, kolize::Host& host) {
    std::vector<Contestant> found;
    for (const std::string& plugin : library.names(kolize::StageKind::narrowphase)) {
        const bool has_precision =
            library.find(kolize::StageKind::narrowphase, plugin)->parameters.find("precision") != nullptr;
        for (const std::string precision : {"double", "float"}) {
            kolize::StageConfig config{.plugin = plugin, .where = {}, .settings = {}};
            if (has_precision) config.settings["precision"] = {precision, {}};
            auto stage = library.make<kolize::Narrowphase>(config, host);
            if (!dynamic_cast<const kolize::TriangleNarrowphase*>(stage.get())) break;
            found.push_back({has_precision ? plugin + ", " + precision : plugin, std::move(stage)});
            if (!has_precision) break;
        }
    }
    return found;
}

Pairs pairs_of(const kolize::TriangleFamily& family, std::size_t count, std::uint64_t seed) {
    kolize::PairMaker maker(seed);
    Pairs pairs;
    for (std::size_t i = 0; i < count; ++i) pairs.push_back((maker.*family.make)());
    return pairs;
}

// Of processor time: others that use the machine do not count.
double seconds(const Contestant& contestant, const Pairs& pairs, int repeats) {
    Answers hit;
    contestant.answer(pairs, hit);  // now they are in the cache
    const std::clock_t start = std::clock();
    for (int i = 0; i < repeats; ++i) contestant.answer(pairs, hit);
    return std::max(1.0, static_cast<double>(std::clock() - start)) / CLOCKS_PER_SEC;
}

// Round by round, so that a disturbance of the machine falls on all. The first round warms up.
void measure(std::vector<Contestant>& all, const std::vector<Pairs>& workloads, int rounds) {
    for (Contestant& contestant : all) contestant.rates.resize(workloads.size());
    for (int round = 0; round <= rounds; ++round)
        for (std::size_t w = 0; w < workloads.size(); ++w)
            for (Contestant& contestant : all) {
                constexpr double long_enough = 1e-3;
                const int repeats = 1 + static_cast<int>(long_enough / seconds(contestant, workloads[w], 1));
                const double time = seconds(contestant, workloads[w], repeats);
                if (round > 0) contestant.rates[w].push_back(repeats * static_cast<double>(workloads[w].size()) / time);
            }
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void print_head(const std::vector<Contestant>& all, const std::vector<std::string>& first) {
    for (const std::string& column : first) std::printf("| %s ", column.c_str());
    for (const Contestant& contestant : all) std::printf("| %s ", contestant.name.c_str());
    std::printf("|\n");
    for (std::size_t i = 0; i < first.size() + all.size(); ++i) std::printf("|---");
    std::printf("|\n");
}

void print_rates(const std::vector<Contestant>& all) {
    print_head(all, {"10^6 pairs a second"});
    for (std::size_t w = 0; w < kolize::triangle_families().size(); ++w) {
        std::printf("| %s |", kolize::triangle_families()[w].name.c_str());
        for (const Contestant& contestant : all) std::printf(" %.3g |", 1e-6 * median(contestant.rates[w]));
        std::printf("\n");
    }
}

// Returns the number of wrong answers of the tests that claim to be exact.
std::size_t print_errors(const std::vector<Contestant>& all, const kolize::PluginLibrary& library,
                         std::size_t pairs_of_each, std::uint64_t seed) {
    std::printf("\nFalse hits + misses, of %zu pairs in each family:\n\n", pairs_of_each);
    print_head(all, {"wrong", "hits"});
    std::size_t wrong_though_exact = 0;
    for (const auto& family : kolize::triangle_families()) {
        const Pairs pairs = pairs_of(family, pairs_of_each, seed);
        Answers truth, hit;
        for (const TrianglePair& pair : pairs) truth.push_back(oracle::triangles_meet(pair.a, pair.b));
        std::printf("| %s | %td |", family.name.c_str(), std::count(truth.begin(), truth.end(), 1));
        for (const Contestant& contestant : all) {
            contestant.answer(pairs, hit);
            std::size_t false_hits = 0, misses = 0;
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                false_hits += hit[i] && !truth[i];
                misses += !hit[i] && truth[i];
            }
            std::printf(" %zu + %zu |", false_hits, misses);
            const auto* plugin = library.find(kolize::StageKind::narrowphase, contestant.name);
            if (plugin && plugin->descriptor->capabilities.exact) wrong_though_exact += false_hits + misses;
        }
        std::printf("\n");
        std::fflush(stdout);
    }
    return wrong_though_exact;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Triangle-triangle tests: speed and errors. Example: bench_triangle_tests --verify 1000000");
    std::size_t verify = 120000, count = 2048;
    std::uint64_t seed = 1;
    int rounds = 11;
    app.add_option("--verify", verify, "pairs compared with rational arithmetic, over all families; 0: none")
        ->check(CLI::Range(0, 1000000000))
        ->capture_default_str();
    app.add_option("--pairs", count, "pairs of each family that are timed")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    app.add_option("--rounds", rounds, "timed rounds; 0: none")->check(CLI::Range(0, 10000))->capture_default_str();
    app.add_option("--seed", seed, "of the random numbers")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        const kolize::PluginLibrary library({KOLIZE_PLUGIN_DIR});
        const auto host = kolize::make_host(1);
        std::vector<Contestant> all = contestants(library, *host);
        if (rounds > 0) {
            std::vector<Pairs> workloads;
            for (const auto& family : kolize::triangle_families()) workloads.push_back(pairs_of(family, count, seed));
            measure(all, workloads, rounds);
            print_rates(all);
        }
        const std::size_t families = kolize::triangle_families().size(), of_each = (verify + families - 1) / families;
        if (of_each > 0 && print_errors(all, library, of_each, seed) > 0) {
            std::fprintf(stderr, "bench_triangle_tests: a test that claims to be exact gave a wrong answer\n");
            return 1;
        }
    } catch (const kolize::Error& error) {
        std::fprintf(stderr, "bench_triangle_tests: %s\n", error.what());
        return 2;
    }
    return 0;
}
