#include "search.h"

#include "judge/judges.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace kolize::cli {

namespace {

constexpr double screened_share = 0.1;                        // of the time
constexpr std::uint64_t fewest_steps = 20;                    // of a screening
constexpr double noise = 1.25;                                // one short run may be so much slower than it should be
constexpr std::uint64_t fewest_rounds = 5, most_rounds = 50;  // of what is compared by time alone
constexpr double compared_s = 0.1;                            // so long each, within these numbers
constexpr unsigned order_seed = 20261123;

class Search {
public:
    Search(const Question& question, const PluginLibrary& plugins, Host& host)
        : question_(question), plugins_(plugins), host_(host), scene_dt_(load({}).pipeline.step.dt) {
        for (Settings& settings : combinations(question.variations))
            answer_.candidates.push_back({std::move(settings), {}, {}});
    }

    Answer run() {
        screen();
        if (question_.full) try_all();
        choose();
        if (!answer_.chosen) return std::move(answer_);
        choose_broadphase();
        look_for_ten_times();
        if (question_.full) compare_with_best();
        return std::move(answer_);
    }

private:
    Scene load(const Settings& settings) const {
        SceneOptions options = question_.options;
        options.set.insert(options.set.end(), settings.begin(), settings.end());
        return load_scene(question_.scene, options, plugins_);
    }

    static void read_errors(const Judges& judges, Trial& trial) {
        const Verdict& driver = judges.verdicts().front();
        trial.missed = driver.misses.count;
        trial.false_hits = driver.false_hits.count;
    }

    // Stops where a limit that can only be broken once is broken.
    Trial measure(const Settings& settings, double time, bool judged = true) const {
        Trial trial;
        try {
            const Scene scene = load(settings);
            const double dt = scene.pipeline.step.dt;
            const std::uint64_t steps = std::max(fewest_steps, steps_in(time, dt));
            Simulation simulation(scene, plugins_, host_, steps);
            std::optional<Judges> judges;
            if (judged && !question_.judge.empty())
                simulation.watch(judges.emplace(JudgeOptions{.plugins = {question_.judge}, .disagreements = {}},
                                                scene.pipeline, plugins_, host_));
            std::uint64_t done = 0;
            while (done < steps) {
                simulation.step();
                ++done;
                if (question_.limits.drift && simulation.reading().energy_drift > *question_.limits.drift) break;
                if (judges) read_errors(*judges, trial);
                if (trial.missed > question_.limits.missed || trial.false_hits > question_.limits.false_hits) break;
            }
            const RunResult result = simulation.result();
            trial.cost_ms = 1e3 * result.step.total_s / static_cast<double>(done) * (scene_dt_ / dt);
            trial.drift = result.energy_drift;
            trial.penetration = result.max_penetration_m;
            trial.escaped = result.escaped;
            trial.stuck = result.stuck;
            trial.hash = result.state_hash;
        } catch (const std::exception& e) {
            trial.failure = e.what();
        }
        return trial;
    }

    void screen() {
        Progress progress("advise: short runs", answer_.candidates.size());
        for (Candidate& candidate : answer_.candidates) {
            candidate.screened = measure(candidate.settings, screened_share * question_.time);
            progress.advance();
        }
        const auto ran = [](const Candidate& c) { return c.screened->failure.empty(); };
        if (std::none_of(answer_.candidates.begin(), answer_.candidates.end(), ran))
            throw Error("none of the " + std::to_string(answer_.candidates.size()) +
                        " pipelines runs; the first says: " + answer_.candidates.front().screened->failure);
    }

    const Trial& tried(std::size_t i) {
        Candidate& candidate = answer_.candidates[i];
        if (!candidate.tried) candidate.tried = measure(candidate.settings, question_.time);
        return *candidate.tried;
    }

    void try_all() {
        Progress progress("advise: every pipeline", answer_.candidates.size());
        for (std::size_t i = 0; i < answer_.candidates.size(); ++i, progress.advance())
            if (answer_.candidates[i].screened->failure.empty()) tried(i);
    }

    // But for the budget: times of short runs are no proof.
    std::vector<std::size_t> survivors(Limits limits) const {
        limits.budget_ms.reset();
        std::vector<std::size_t> rows;
        for (std::size_t i = 0; i < answer_.candidates.size(); ++i)
            if (broken_limit(*answer_.candidates[i].screened, limits).empty()) rows.push_back(i);
        std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
            return answer_.candidates[a].screened->cost_ms < answer_.candidates[b].screened->cost_ms;
        });
        return rows;
    }

    // The cheapest that keeps the limits: the short runs say in which order to look, and when to stop.
    std::optional<std::size_t> cheapest(const Limits& limits) {
        const std::vector<std::size_t> rows = survivors(limits);
        std::vector<std::size_t> close;
        double best = infinity;
        Progress progress("advise: long runs", rows.size());
        for (const std::size_t i : rows) {
            progress.advance();
            if (answer_.candidates[i].screened->cost_ms > noise * best) break;
            if (!broken_limit(tried(i), limits).empty()) continue;
            best = std::min(best, tried(i).cost_ms);
            close.push_back(i);
        }
        std::erase_if(close, [&](std::size_t i) { return tried(i).cost_ms > noise * best; });
        return fastest(close);
    }

    // By the median of several short runs, interleaved.
    std::optional<std::size_t> fastest(const std::vector<std::size_t>& rows) const {
        if (rows.size() < 2) return rows.empty() ? std::nullopt : std::optional(rows.front());
        std::vector<Settings> settings;
        for (const std::size_t i : rows) settings.push_back(answer_.candidates[i].settings);
        const std::vector<double> costs = median_costs(settings);
        return rows[static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin())];
    }

    std::vector<double> median_costs(const std::vector<Settings>& settings) const {
        std::vector<std::vector<double>> costs(settings.size());
        std::vector<std::size_t> order(settings.size());
        std::iota(order.begin(), order.end(), 0u);
        std::mt19937 random(order_seed);
        const double time = screened_share * question_.time;
        const auto start = std::chrono::steady_clock::now();
        for (const Settings& one : settings) measure(one, time, false);  // warms up
        const std::chrono::duration<double> round_s = std::chrono::steady_clock::now() - start;
        const double wanted = compared_s * static_cast<double>(settings.size()) / round_s.count();
        const auto rounds = static_cast<std::uint64_t>(std::clamp(wanted, double(fewest_rounds), double(most_rounds)));
        Progress progress("advise: comparing times", rounds * settings.size());
        for (std::uint64_t round = 0; round < rounds; ++round) {
            std::shuffle(order.begin(), order.end(), random);
            for (const std::size_t i : order) {
                costs[i].push_back(measure(settings[i], time, false).cost_ms);
                progress.advance();
            }
        }
        std::vector<double> medians;
        for (std::vector<double>& of_one : costs) medians.push_back(median(std::move(of_one)));
        return medians;
    }

    // Within a budget the most accurate wins; otherwise the cheapest.
    void choose() {
        if (!question_.limits.budget_ms) {
            answer_.chosen = cheapest(question_.limits);
            return;
        }
        std::vector<std::size_t> rows = survivors(question_.limits);
        std::erase_if(rows, [&](std::size_t i) {
            return answer_.candidates[i].screened->cost_ms > noise * *question_.limits.budget_ms;
        });
        Progress progress("advise: long runs", rows.size());
        for (const std::size_t i : rows) {
            tried(i);
            progress.advance();
        }
        answer_.chosen = best_tried();
    }

    // Drift, and between drifts that are rounding, penetration.
    static std::pair<double, double> error(const Trial& trial) {
        return {std::max(trial.drift, rounding_drift), trial.penetration};
    }

    std::optional<std::size_t> best_tried() const {
        const bool by_accuracy = question_.limits.budget_ms.has_value();
        std::optional<std::size_t> best;
        const auto rank = [&](const Trial& t) {
            return std::pair(by_accuracy ? error(t) : std::pair(0.0, 0.0), t.cost_ms);
        };
        for (std::size_t i = 0; i < answer_.candidates.size(); ++i) {
            const std::optional<Trial>& trial = answer_.candidates[i].tried;
            if (!trial || !broken_limit(*trial, question_.limits).empty()) continue;
            if (!best || rank(*trial) < rank(*answer_.candidates[*best].tried)) best = i;
        }
        return best;
    }

    // Single runs say only which are worth to be measured together with the one chosen.
    void compare_with_best() {
        const std::size_t best = *best_tried();
        const Trial& least = *answer_.candidates[best].tried;
        std::vector<std::size_t> rows{*answer_.chosen};
        for (std::size_t i = 0; i < answer_.candidates.size(); ++i) {
            const std::optional<Trial>& trial = answer_.candidates[i].tried;
            if (!trial || i == *answer_.chosen || !broken_limit(*trial, question_.limits).empty()) continue;
            if (question_.limits.budget_ms ? i == best : trial->cost_ms <= noise * least.cost_ms) rows.push_back(i);
        }
        std::vector<Settings> settings;
        for (const std::size_t i : rows) settings.push_back(answer_.candidates[i].settings);
        const std::vector<double> costs = median_costs(settings);
        const auto at =
            question_.limits.budget_ms ? std::prev(costs.end()) : std::min_element(costs.begin(), costs.end());
        answer_.best_of_full = rows[static_cast<std::size_t>(at - costs.begin())];
        answer_.times_best = costs.front() / *at;
    }

    void choose_broadphase() {
        const Candidate& chosen = answer_.candidates[*answer_.chosen];
        const double time = screened_share * question_.time;
        const std::uint64_t hash = measure(chosen.settings, time).hash;
        std::vector<Settings> settings;
        std::vector<BroadphaseTime> failed;
        for (const std::string& name : plugins_.names(StageKind::broadphase)) {
            Settings with = chosen.settings;
            with.emplace_back("broadphase.plugin", name);
            const Trial trial = measure(with, time);
            const bool same = trial.failure.empty() && trial.hash == hash;
            if (same) {
                settings.push_back(with);
                answer_.broadphases.push_back({name, 0, {}});
            } else {
                failed.push_back({name, 0, trial.failure.empty() ? "another trajectory" : trial.failure});
            }
        }
        const std::vector<double> costs = median_costs(settings);
        for (std::size_t i = 0; i < costs.size(); ++i) answer_.broadphases[i].cost_ms = costs[i];
        std::sort(answer_.broadphases.begin(), answer_.broadphases.end(),
                  [](const BroadphaseTime& a, const BroadphaseTime& b) { return a.cost_ms < b.cost_ms; });
        Settings with = chosen.settings;
        if (!answer_.broadphases.empty()) {
            with.emplace_back("broadphase.plugin", answer_.broadphases.front().plugin);
            answer_.chosen_cost_ms = answer_.broadphases.front().cost_ms;
        }
        answer_.broadphases.insert(answer_.broadphases.end(), failed.begin(), failed.end());
        answer_.pipeline = Simulation(load(with), plugins_, host_, 1).pipeline();
    }

    void look_for_ten_times() {
        const Trial& chosen = answer_.candidates[*answer_.chosen].known();
        answer_.by_penetration = chosen.drift <= rounding_drift;
        Limits limits = question_.limits;
        limits.budget_ms.reset();
        if (!answer_.by_penetration)
            limits.drift = chosen.drift / 10;
        else if (chosen.penetration > 0)
            limits.penetration = chosen.penetration / 10;
        else
            return;
        answer_.ten_times = cheapest(limits);
    }

    const Question& question_;
    const PluginLibrary& plugins_;
    Host& host_;
    double scene_dt_;
    Answer answer_;
};

}  // namespace

std::string broken_limit(const Trial& trial, const Limits& limits) {
    if (!trial.failure.empty()) return trial.failure;
    if (trial.escaped > 0) return std::to_string(trial.escaped) + " escaped";
    if (trial.stuck > 0) return std::to_string(trial.stuck) + " stuck";
    if (!std::isfinite(trial.drift)) return "energy is not finite";
    if (limits.drift && trial.drift > *limits.drift) return "drift " + number(trial.drift);
    if (limits.penetration && trial.penetration > *limits.penetration) return number(trial.penetration) + " m deep";
    if (trial.missed > limits.missed) return std::to_string(trial.missed) + " missed";
    if (trial.false_hits > limits.false_hits) return std::to_string(trial.false_hits) + " false hits";
    if (limits.budget_ms && trial.cost_ms > *limits.budget_ms) return number(trial.cost_ms) + " ms";
    return {};
}

Answer search(const Question& question, const PluginLibrary& plugins, Host& host) {
    return Search(question, plugins, host).run();
}

}  // namespace kolize::cli
