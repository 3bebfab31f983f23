#include "judges.h"

#include "disagreement.h"
#include "empty_folder.h"

#include <kolize/capsule.h>

#include <CLI/CLI.hpp>

#include <algorithm>

namespace kolize::cli {

// What one narrowphase said in one call, pair by pair of the input; no rows and not asked where it was not.
struct Judges::Testimony {
    std::vector<std::uint8_t> asked;
    std::vector<Detail> detail;
    std::vector<std::span<const Contact>> rows;  // into contacts, or into the driver's
    Contacts contacts;
    double seconds = 0;
    std::uint64_t failures = 0;
    std::string exception;  // of the call, or ""
};

namespace {

// Of the bodies that move, or of all where none does.
double median_radius(const World& world) {
    std::vector<double> moving, all;
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        if (world.removed[body] || world.shape_of(body).kind == ShapeKind::half_space) continue;
        all.push_back(world.shape_of(body).radius);
        if (!world.is_static[body]) moving.push_back(all.back());
    }
    return median(moving.empty() ? std::move(all) : std::move(moving));
}

// The driver's contact model, where the judge has the same choice.
StageConfig judge_config(const std::string& name, const StageConfig& driver, const PluginLibrary& library) {
    StageConfig config{name, {"--judge"}, {}};
    const Parameter* parameter = library.require(StageKind::narrowphase, name, config.where).parameters.find("contact");
    const auto contact = driver.settings.find("contact");
    if (parameter && contact != driver.settings.end() && parameter->complaint(contact->second.value).empty())
        config.settings["contact"] = contact->second;
    return name == driver.plugin ? driver : config;
}

const Contact& deepest(std::span<const Contact> rows) {
    return *std::max_element(rows.begin(), rows.end(),
                             [](const Contact& x, const Contact& y) { return x.depth < y.depth; });
}

// Throws std::runtime_error.
void require_sense(std::span<const Contact> rows, Detail detail) {
    for (const Contact& row : rows)
        if (detail != Detail::overlap && !(std::abs(row.normal.norm() - 1) <= 1e-6 && std::isfinite(row.depth)))
            throw std::runtime_error("it reported a contact of bodies " + std::to_string(row.a) + " and " +
                                     std::to_string(row.b) + " without a direction or a depth");
}

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

// Of contacts that are as deep as the deepest, but for rounding, the one that lies best counts: which of several alike
// comes first is no merit.
double least_angle(std::span<const Contact> truth, const Contact& said) {
    const double least_depth = deepest(truth).depth * (1 - 1e-6);
    double angle = std::numbers::pi;
    for (const Contact& row : truth)
        if (row.depth >= least_depth) angle = std::min(angle, angle_between(row.normal, said.normal));
    return angle;
}

}  // namespace

void add_judge_options(CLI::App& command, JudgeOptions& options) {
    command
        .add_option("--judge", options.plugins,
                    "Narrowphases that answer beside the one that drives, as A,B,...; the first is taken for the truth")
        ->delimiter(',')
        ->allow_extra_args(false);
    command.add_option("--disagreements", options.disagreements,
                       "Folder for capsules of what driver and judges disagree on, for kolize check");
    command.add_option("--keep", options.keep, "Capsules of each narrowphase in that folder at most")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
}

Judges::Judges(const JudgeOptions& options, const PipelineConfig& pipeline, const PluginLibrary& library, Host& host)
    : options_(options), library_(library), host_(host), pipeline_(pipeline) {
    const StageConfig& driver = pipeline.narrowphase;
    std::vector<std::string> names = options.plugins;
    if (names.empty()) names.emplace_back("exact");
    const auto add = [&](const StageConfig& config, Role role) {
        witnesses_.emplace_back(config, library, host);
        verdicts_.emplace_back().plugin = config.plugin;
        verdicts_.back().role = role;
    };
    add(driver, Role::driver);
    for (const std::string& name : names)
        add(judge_config(name, driver, library), witnesses_.size() == 1 ? Role::truth : Role::judge);
    if (!options.disagreements.empty()) make_empty_folder(options.disagreements);
}

void Judges::step_begins(std::uint64_t step, const World&) { step_ = step; }

void Judges::ended(const Span& span) {
    if (span.stage != std::string_view(to_string(StageKind::narrowphase))) return;
    if (span.plugin != verdicts_.front().plugin)
        throw std::runtime_error("the run goes on with narrowphase '" + std::string(span.plugin) +
                                 "', and judges hold for one driver only, '" + verdicts_.front().plugin + "'");
    last_ = span;
}

void Judges::prepare(const World& world) {
    if (prepared_for_ == world.shapes.data()) return;
    for (Witness& witness : witnesses_) witness.prepare(world);
    median_radius_ = median_radius(world);
    prepared_for_ = world.shapes.data();
}

void Judges::narrowphase_found(const NarrowphaseInput& input, bool touching, const Contacts& contacts) {
    if (touching) {
        ++touching_calls_;
        return;
    }
    if (input.pairs.empty()) return;
    ++calls_;
    prepare(input.world);
    const Testimony driver = driver_said(input, contacts), truth = ask(1, input, input.detail);
    count(0, driver);
    count(1, truth);
    judge(0, input, truth, driver);
    for (std::size_t who = 2; who < witnesses_.size(); ++who) {
        const Detail most = witnesses_[who].gives();
        const bool gives_less = most < witnesses_[1].gives();
        const Testimony said = ask(who, input, truth.detail);
        count(who, said);
        judge(who, input, gives_less ? ask(1, input, said.detail) : truth, said);
    }
}

Judges::Testimony Judges::driver_said(const NarrowphaseInput& input, const Contacts& contacts) const {
    const std::chrono::duration<double> time = last_.end - last_.begin;
    Testimony said;
    said.asked.assign(input.pairs.size(), 1);
    said.detail.assign(input.detail.begin(), input.detail.end());
    said.rows = rows_of_pairs(input.pairs, contacts.rows);
    said.seconds = time.count();
    said.failures = contacts.failures;
    return said;
}

Judges::Testimony Judges::ask(std::size_t who, const NarrowphaseInput& input, std::span<const Detail> at_most) const {
    const Witness& witness = witnesses_[who];
    const std::size_t count = input.pairs.size();
    Testimony said;
    said.asked.assign(count, 0);
    said.rows.resize(count);
    std::vector<Pair> pairs;
    std::vector<Detail> detail;
    for (std::size_t i = 0; i < count; ++i) {
        said.detail.push_back(std::min(at_most[i], witness.gives()));
        if (!witness.takes(input.world, input.pairs[i])) continue;
        said.asked[i] = 1;
        pairs.push_back(input.pairs[i]);
        detail.push_back(said.detail[i]);
    }
    if (pairs.empty()) return said;
    try {
        const auto start = Span::Clock::now();
        witness.stage().find_contacts({input.world, pairs, detail}, said.contacts);
        said.seconds = std::chrono::duration<double>(Span::Clock::now() - start).count();
        said.failures = said.contacts.failures;
        const auto rows = rows_of_pairs(pairs, said.contacts.rows);
        for (std::size_t i = 0; i < pairs.size(); ++i) require_sense(rows[i], detail[i]);
        for (std::size_t i = 0, next = 0; i < count; ++i)
            if (said.asked[i]) said.rows[i] = rows[next++];
    } catch (const std::exception& failure) {
        said.exception = failure.what();
        said.asked.assign(count, 0);
    }
    return said;
}

void Judges::count(std::size_t who, const Testimony& said) {
    Verdict& verdict = verdicts_[who];
    const auto asked = static_cast<std::uint64_t>(std::count(said.asked.begin(), said.asked.end(), 1));
    if (verdict.role == Role::truth) {  // of the others only pairs count that the truth was asked about
        verdict.asked += asked;
        verdict.not_asked += said.asked.size() - asked;
    }
    verdict.failures += said.failures;
    if (asked > 0) {
        verdict.call_us.add(1e6 * said.seconds);
        verdict.total_s += said.seconds;
    }
    if (said.exception.empty()) return;
    if (verdict.failed_calls++ == 0) verdict.first_failure = "step " + std::to_string(step_) + ": " + said.exception;
}

void Judges::judge(std::size_t who, const NarrowphaseInput& input, const Testimony& truth, const Testimony& said) {
    Verdict& verdict = verdicts_[who];
    for (std::size_t i = 0; i < input.pairs.size(); ++i) {
        if (!truth.asked[i] || !said.asked[i]) {
            ++verdict.not_asked;
            continue;
        }
        ++verdict.asked;
        const std::span<const Contact> right = truth.rows[i], rows = said.rows[i];
        const bool overlaps = !right.empty(), says = !rows.empty();
        ++(overlaps ? verdict.misses : verdict.false_hits).of;
        if (overlaps != says) {
            ++(overlaps ? verdict.misses : verdict.false_hits).count;
            keep(who, input, input.pairs[i], says);
        } else if (overlaps && std::min(truth.detail[i], said.detail[i]) >= Detail::normal) {
            const Contact& deep = deepest(rows);
            verdict.angle.add(least_angle(right, deep));
            if (truth.detail[i] == said.detail[i])
                verdict.depth.add(std::abs(deep.depth - deepest(right).depth) / median_radius_);
        }
    }
}

void Judges::keep(std::size_t who, const NarrowphaseInput& input, const Pair& pair, bool says) {
    ++disagreements_;
    if (options_.disagreements.empty() || verdicts_[who].kept >= options_.keep) return;
    ++verdicts_[who].kept;
    Witness& other = witnesses_[who];
    Scene scene = smallest_scene(input.world, pair, witnesses_[1], other, library_, host_);
    scene.pipeline.broadphase = pipeline_.broadphase;
    scene.pipeline.step = pipeline_.step;
    scene.pipeline.responses = {{{plugin_defaults().response, {}, {}}, {}}};
    scene.capsule_step = step_;
    const std::string bodies = std::to_string(pair.a) + " and " + std::to_string(pair.b);
    const auto word = [](bool overlap) { return overlap ? "overlap" : "apart"; };
    const std::string reason = "bodies " + bodies + " at step " + std::to_string(step_) + ": " + word(says) + " by " +
                               other.name() + ", " + word(!says) + " by " + witnesses_[1].name();
    const std::string name = std::to_string(kept_.size()) + "." + other.name() + ".step" + std::to_string(step_) +
                             ".bodies" + std::to_string(pair.a) + "-" + std::to_string(pair.b) + ".capsule.toml";
    kept_.push_back(std::filesystem::path(options_.disagreements) / name);
    write_text(capsule_text(scene, reason), kept_.back());
}

}  // namespace kolize::cli
