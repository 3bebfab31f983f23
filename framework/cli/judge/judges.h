// Shadow judges: while one narrowphase drives a run, others answer for the same pairs in the same state, and what each
// of them says is held against the truth, which is the first of them.
#pragma once

#include "spread.h"
#include "witness.h"

#include "common.h"

#include <kolize/observer.h>

namespace kolize::cli {

// Of --judge, --disagreements and --keep.
struct JudgeOptions {
    std::vector<std::string> plugins;  // the first is the truth; `exact` where none is named
    std::string disagreements;         // folder, or ""
    int keep = 20;                     // disagreements of each at most

    bool wanted() const { return !plugins.empty() || !disagreements.empty(); }
};
void add_judge_options(CLI::App& command, JudgeOptions& options);

enum class Role { driver, truth, judge };

// What one narrowphase said, held against the truth.
struct Verdict {
    std::string plugin;
    Role role = Role::judge;
    std::uint64_t asked = 0;      // pairs
    std::uint64_t not_asked = 0;  // pairs whose shapes it or the truth does not take, or over which a call threw
    Rate misses;                  // of the pairs that overlap
    Rate false_hits;              // of those that do not
    std::uint64_t failures = 0;   // pairs over which its method failed, by its own count
    std::uint64_t failed_calls = 0;
    std::string first_failure;
    Spread angle;    // rad, between the normals of the deepest contacts
    Spread depth;    // between the depths of the deepest contacts, over the median body radius
    Spread call_us;  // of each call
    double total_s = 0;
    int kept = 0;  // disagreements
};

class Judges final : public Observer {
public:
    // The pipeline is the one in force. Judges take over the driver's contact model where they have it. Throws Error
    // for plugins that are not there. Library and host have to outlive the judges.
    Judges(const JudgeOptions& options, const PipelineConfig& pipeline, const PluginLibrary& library, Host& host);

    void step_begins(std::uint64_t step, const World& world) override;
    void ended(const Span& span) override;
    void narrowphase_found(const NarrowphaseInput& input, bool touching, const Contacts& contacts) override;

    // The driver, the truth, then the other judges in their order.
    const std::vector<Verdict>& verdicts() const { return verdicts_; }
    std::uint64_t disagreements() const { return disagreements_; }
    const std::vector<std::filesystem::path>& kept() const { return kept_; }

    void print(std::ostream& out) const;
    Json json() const;  // of the key "judges"

private:
    struct Testimony;

    void prepare(const World& world);
    Testimony driver_said(const NarrowphaseInput& input, const Contacts& contacts) const;
    Testimony ask(std::size_t who, const NarrowphaseInput& input, std::span<const Detail> at_most) const;
    void count(std::size_t who, const Testimony& said);
    void judge(std::size_t who, const NarrowphaseInput& input, const Testimony& truth, const Testimony& said);
    void keep(std::size_t who, const NarrowphaseInput& input, const Pair& pair, bool said);

    JudgeOptions options_;
    const PluginLibrary& library_;
    Host& host_;
    std::vector<Witness> witnesses_;  // a double of the driver, the truth, the others
    std::vector<Verdict> verdicts_;   // of each
    PipelineConfig pipeline_;
    const Shape* prepared_for_ = nullptr;
    double median_radius_ = 0;  // m
    std::uint64_t step_ = 0, calls_ = 0, touching_calls_ = 0;
    Span last_;  // of the driver
    std::uint64_t disagreements_ = 0;
    std::vector<std::filesystem::path> kept_;
};

}  // namespace kolize::cli
