// bench_broadphase: our broadphases and those of other libraries on the same boxes, one thread, a complete pair list
// each frame.
#include "broadphase_rivals.h"

#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <numeric>

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
        is_static_.resize(frame.boxes.size(), 0);
        stage_->find_pairs({frame.boxes, is_static_, 1}, pairs);
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

// Of all threads in the processor, in which other programs have no part.
double milliseconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

void run_round(Entry& entry, const std::vector<Frame>& frames, bool timed) {
    std::vector<Pair> found;
    entry.pairs.clear();
    for (const Frame& frame : frames) {
        found.clear();
        const double start = milliseconds();
        entry.contestant->find_pairs(frame, found);
        const double took = milliseconds() - start;
        if (timed) entry.milliseconds.push_back(took);
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

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<Entry> enter(const kolize::PluginLibrary& library, kolize::Host& host, const Frame& first,
                         const std::vector<std::string>& words) {
    constexpr std::size_t brute_force_limit = 2000;  // boxes; its time grows with the square
    const auto wanted = [&](const std::string& name) {
        const auto in_name = [&](const std::string& word) { return name.find(word) != std::string::npos; };
        return words.empty() || std::any_of(words.begin(), words.end(), in_name);
    };
    std::vector<Entry> entries;
    for (const std::string& name : library.names(kolize::StageKind::broadphase))
        if (wanted("kolize " + name) && (name != "brute_force" || first.boxes.size() <= brute_force_limit))
            entries.push_back({std::make_unique<Plugin>(name, library, host), {}, {}, true});
    for (auto& rival : bench::rival_broadphases(first, wanted)) entries.push_back({std::move(rival), {}, {}, true});
    return entries;
}

// False if two of them disagree about the number of pairs.
bool print_table(const std::vector<Entry>& entries, const std::string& title) {
    double fastest_rival = kolize::infinity;
    for (const Entry& entry : entries)
        if (!entry.contestant->name.starts_with("kolize"))
            fastest_rival = std::min(fastest_rival, quantile(entry.milliseconds, 0.5));
    std::printf("\n%s, %zu pairs in the last frame\n%-28s %12s %12s %12s %22s\n", title.c_str(),
                entries[0].pairs.back(), "", "median ms", "mean ms", "p95 ms", "fastest rival / this");
    bool agree = true;
    for (const Entry& entry : entries) {
        const double median = quantile(entry.milliseconds, 0.5);
        std::printf("%-28s %12.3f %12.3f %12.3f %22.2f%s\n", entry.contestant->name.c_str(), median,
                    mean(entry.milliseconds), quantile(entry.milliseconds, 0.95), fastest_rival / median,
                    entry.agrees ? "" : "   DIFFERENT PAIR COUNT");
        agree = agree && entry.agrees;
    }
    std::fflush(stdout);
    return agree;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "Broadphases on the same moving boxes. Example: bench_broadphase --n 1e4 --workload uniform,clustered");
    const std::map<std::string, bench::Workload> workloads{{"uniform", bench::Workload::uniform},
                                                           {"clustered", bench::Workload::clustered},
                                                           {"power_law", bench::Workload::power_law}};
    const std::map<std::string, bench::Movers> movers{{"all", bench::Movers::all},
                                                      {"same_tenth", bench::Movers::same_tenth},
                                                      {"random_tenth", bench::Movers::random_tenth}};
    std::vector<double> counts{1e3, 1e4, 1e5};
    std::vector<std::string> chosen_workloads{"uniform"}, chosen_movers{"all"}, words;
    std::size_t frames = 10, repeat = 5;
    app.add_option("--n", counts, "numbers of boxes")->delimiter(',')->check(CLI::Range(2.0, 1e8));
    app.add_option("--workload", chosen_workloads)->delimiter(',')->check(CLI::IsMember(workloads));
    app.add_option("--moving", chosen_movers, "which boxes move in a frame")
        ->delimiter(',')
        ->check(CLI::IsMember(movers));
    app.add_option("--only", words, "those with one of these words in their name")->delimiter(',');
    app.add_option("--frames", frames, "frames in a round")->check(CLI::Range(1, 10000))->capture_default_str();
    app.add_option("--repeat", repeat, "timed rounds")->check(CLI::Range(1, 10000))->capture_default_str();
    CLI11_PARSE(app, argc, argv);

    const kolize::PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const auto host = kolize::make_host(1);
    std::puts("Debian's libfcl and Embree are built with their assertions on; upstream's are somewhat faster.");
    bool agree = true;
    for (const double count : counts)
        for (const std::string& workload : chosen_workloads)
            for (const std::string& moving : chosen_movers) {
                const auto boxes = static_cast<std::size_t>(count);
                bench::MovingBoxes motion(workloads.at(workload), boxes, movers.at(moving));
                const std::vector<Frame> first = motion.take(1);
                const std::vector<Entry> entries =
                    run(enter(library, *host, first.front(), words), motion, frames, repeat);
                if (entries.empty()) continue;
                agree = print_table(entries, std::to_string(boxes) + " boxes, " + workload + ", moving: " + moving) &&
                        agree;
            }
    return agree ? 0 : 1;
}
