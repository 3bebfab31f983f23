// bench_broadphase: our broadphases, Bullet's and FCL's on the same boxes, one thread, a complete pair list each frame.
#include "broadphase_rivals.h"

#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>

namespace {

using bench::Contestant;
using bench::Frame;
using kolize::Pair;

class Plugin final : public Contestant {
public:
    Plugin(const std::string& plugin, const kolize::PluginLibrary& library, kolize::Host& host)
        : stage_(library.make<kolize::Broadphase>({.plugin = plugin, .where = {}, .settings = {}}, host)) {
        name = "kolize " + plugin;
    }
    void find_pairs(const Frame& frame, std::vector<Pair>& pairs) override {
        is_static_.resize(frame.size(), 0);
        stage_->find_pairs({frame, is_static_, 1}, pairs);
    }

private:
    kolize::StagePtr<kolize::Broadphase> stage_;
    std::vector<std::uint8_t> is_static_;
};

struct Entry {
    std::unique_ptr<Contestant> contestant;
    std::vector<double> milliseconds;
    std::vector<std::size_t> pairs;  // per frame of the last round
    bool agrees = true;              // in every frame as many pairs as the first contestant
};

void run_round(Entry& entry, const std::vector<Frame>& frames, bool timed) {
    using Clock = std::chrono::steady_clock;
    std::vector<Pair> found;
    entry.pairs.clear();
    for (const Frame& frame : frames) {
        found.clear();
        const auto start = Clock::now();
        entry.contestant->find_pairs(frame, found);
        const std::chrono::duration<double, std::milli> took = Clock::now() - start;
        if (timed) entry.milliseconds.push_back(took.count());
        entry.pairs.push_back(found.size());
    }
}

// Round by round, so that a disturbance of the machine falls on all. The first round warms up.
std::vector<Entry> run(std::vector<Entry> entries, bench::MovingBoxes& boxes, std::size_t frames, std::size_t rounds) {
    for (std::size_t round = 0; round <= rounds; ++round) {
        const std::vector<Frame> work = boxes.take(frames);
        for (Entry& entry : entries) {
            run_round(entry, work, round > 0);
            entry.agrees = entry.agrees && entry.pairs == entries.front().pairs;
        }
    }
    return entries;
}

double quantile(std::vector<double> values, double part) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

std::vector<Entry> enter(const kolize::PluginLibrary& library, kolize::Host& host, const Frame& first) {
    constexpr std::size_t brute_force_limit = 2000;  // boxes; its time grows with the square
    std::vector<Entry> entries;
    for (const std::string& name : library.names(kolize::StageKind::broadphase))
        if (name != "brute_force" || first.size() <= brute_force_limit)
            entries.push_back({std::make_unique<Plugin>(name, library, host), {}, {}, true});
    for (auto& rival : bench::rival_broadphases(first)) entries.push_back({std::move(rival), {}, {}, true});
    return entries;
}

// False if two of them disagree about the number of pairs.
bool print_table(const std::vector<Entry>& entries, std::size_t boxes) {
    double fastest_rival = kolize::infinity;
    for (const Entry& entry : entries)
        if (!entry.contestant->name.starts_with("kolize"))
            fastest_rival = std::min(fastest_rival, quantile(entry.milliseconds, 0.5));
    std::printf("\n%zu boxes, %zu pairs in the last frame\n%-28s %12s %12s %22s\n", boxes, entries[0].pairs.back(), "",
                "median ms", "p95 ms", "fastest rival / this");
    bool agree = true;
    for (const Entry& entry : entries) {
        const double median = quantile(entry.milliseconds, 0.5);
        std::printf("%-28s %12.3f %12.3f %22.2f%s\n", entry.contestant->name.c_str(), median,
                    quantile(entry.milliseconds, 0.95), fastest_rival / median,
                    entry.agrees ? "" : "   DIFFERENT PAIR COUNT");
        agree = agree && entry.agrees;
    }
    return agree;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Broadphases of kolize, Bullet and FCL on the same moving boxes. Example: bench_broadphase --n 1e4");
    std::vector<double> counts{1e3, 1e4, 1e5};
    std::size_t frames = 10, repeat = 5;
    app.add_option("--n", counts, "numbers of boxes")->delimiter(',')->check(CLI::Range(2.0, 1e8));
    app.add_option("--frames", frames, "frames in a round")->check(CLI::Range(1, 10000))->capture_default_str();
    app.add_option("--repeat", repeat, "timed rounds")->check(CLI::Range(1, 10000))->capture_default_str();
    CLI11_PARSE(app, argc, argv);

    const kolize::PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const auto host = kolize::make_host(1);
    std::puts("Debian's libfcl is built with its assertions on; upstream's is somewhat faster.");
    bool agree = true;
    for (const double count : counts) {
        bench::MovingBoxes boxes(static_cast<std::size_t>(count), 1);
        const std::vector<Entry> entries = run(enter(library, *host, boxes.take(1).front()), boxes, frames, repeat);
        agree = print_table(entries, static_cast<std::size_t>(count)) && agree;
    }
    return agree ? 0 : 1;
}
