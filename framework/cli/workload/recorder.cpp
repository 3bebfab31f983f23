#include "recorder.h"

#include "empty_folder.h"

#include <kolize/capsule.h>

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <charconv>
#include <cstring>

namespace kolize::cli {
namespace {

std::string exact(const Vec3& v) { return exact_text(v.x()) + ' ' + exact_text(v.y()) + ' ' + exact_text(v.z()); }

std::string hex_word(std::uint64_t word) {
    char digits[16];
    return {digits, std::to_chars(digits, digits + sizeof digits, word, 16).ptr};
}

}  // namespace

StepRange parse_step_range(const std::string& text) {
    StepRange range;
    std::uint64_t* const parts[] = {&range.from, &range.to, &range.every};
    std::string_view rest = text;
    for (std::size_t i = 0; i < std::size(parts); ++i) {
        const std::string_view part = rest.substr(0, rest.find(':'));
        if (!part.empty()) {
            const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), *parts[i]);
            if (error != std::errc() || end != part.data() + part.size()) break;
        }
        rest.remove_prefix(part.size());
        if (rest.empty() && range.every > 0 && range.from < range.to) return range;
        if (!rest.empty()) rest.remove_prefix(1);
    }
    throw Error("--workload-steps " + text +
                ": FROM:TO:EVERY is wanted, numbers of steps from 0, such as 100:200 or ::10; TO itself is left out");
}

void add_workload_options(CLI::App& command, WorkloadOptions& options) {
    CLI::Option* folder = command.add_option("--save-workload", options.folder,
                                             "Empty folder to keep the inputs of the stages in, for kolize bench");
    command.add_option("--workload-steps", options.steps, "FROM:TO:EVERY, the steps that are kept; all if left out")
        ->needs(folder);
}

WorkloadRecorder::WorkloadRecorder(const WorkloadOptions& options, const Simulation& simulation)
    : folder_(options.folder), range_(parse_step_range(options.steps)), simulation_(simulation) {
    make_empty_folder(folder_);
    write_text(capsule_text(simulation.capture(), "the world in which the calls begin"), folder_ / world_file);
    calls_.open(folder_ / calls_file);
    line("# kolize calls 1; see docs/workloads.md");
    const World& world = simulation.world();
    for (std::uint32_t body = 0; body < world.size(); ++body) written_.push_back(kept(world, body));
}

bool WorkloadRecorder::Kept::operator==(const Kept& other) const {
    return std::memcmp(&numbers, &other.numbers, sizeof numbers) == 0 && removed == other.removed &&
           asleep == other.asleep;
}

WorkloadRecorder::Kept WorkloadRecorder::kept(const World& world, std::uint32_t body) {
    const BodyState s = world.state(body);
    const Quat& q = s.orientation;
    return {{s.position.x(), s.position.y(), s.position.z(), q.w(), q.x(), q.y(), q.z(), s.velocity.x(), s.velocity.y(),
             s.velocity.z(), s.angular_velocity.x(), s.angular_velocity.y(), s.angular_velocity.z()},
            world.removed[body],
            world.asleep[body]};
}

template <class... Words>
void WorkloadRecorder::line(const Words&... words) {
    std::size_t count = 0;
    ((pending_ << (count++ ? " " : "") << words), ...);
    pending_ << '\n';
}

void WorkloadRecorder::write_changes(const World& world) {
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        const Kept now = kept(world, body);
        if (now == written_[body]) continue;
        written_[body] = now;
        pending_ << "body " << body << ' ' << int(now.removed) << ' ' << int(now.asleep);
        for (const double number : now.numbers) pending_ << ' ' << exact_text(number);
        pending_ << '\n';
    }
}

void WorkloadRecorder::step_begins(std::uint64_t step, const World&) {
    records_ = range_.has(step);
    if (!records_) return;
    line("step", step);
    const std::vector<ResponseMemory> memory = simulation_.capture().memory;
    has_memory_.resize(memory.size());
    for (std::size_t rule = 0; rule < memory.size(); ++rule) {
        if (memory[rule].words.empty() && !has_memory_[rule]) continue;
        has_memory_[rule] = 1;
        pending_ << "memory " << rule;
        for (const std::uint64_t word : memory[rule].words) pending_ << ' ' << hex_word(word);
        pending_ << '\n';
    }
}

void WorkloadRecorder::broadphase_found(const BroadphaseInput& input, std::span<const Pair>) {
    if (!records_ || input.bounds.empty()) return;
    if (!boxes_ || input.generation != generation_) {
        if (boxes_) boxes_->finish();
        boxes_.emplace(folder_ / ("broadphase." + std::to_string(box_files_++) + ".npy"), input.bounds.size());
        generation_ = input.generation;
    }
    boxes_->add(input.bounds);
    ++box_frames_;
}

void WorkloadRecorder::narrowphase_found(const NarrowphaseInput& input, bool touching, const Contacts& contacts) {
    if (!records_ || input.pairs.empty()) return;
    if (touching) {
        ++touching_calls_;
        return;
    }
    write_changes(input.world);
    line("narrowphase");
    for (std::size_t i = 0; i < input.pairs.size(); ++i)
        line("pair", input.pairs[i].a, input.pairs[i].b, to_string(input.detail[i]));
    line("found", contacts.rows.size(), hex_word(hash_of(contacts.rows)));
    write_pending();
    ++narrowphase_calls_;
}

void WorkloadRecorder::response_begins(std::size_t rule, const ResponseInput& input, const World& world) {
    if (!records_) return;
    write_changes(world);
    line("response", rule, exact_text(input.dt), exact_text(input.settle));
    for (std::size_t i = 0; i < input.contacts.size(); ++i) {
        const Contact& c = input.contacts[i];
        line("contact", c.a, c.b, c.region, int(input.hit[i]), exact(c.normal), exact(c.arm_a), exact(c.arm_b),
             exact_text(c.depth));
    }
}

void WorkloadRecorder::response_ended(std::size_t, const ResponseInput& input, const World& world) {
    if (!records_) return;
    line("after", hex_word(hash_of(world, input.contacts)));
    write_pending();
    ++response_calls_;
}

void WorkloadRecorder::write_pending() {
    calls_ << pending_.view();
    pending_.str({});
}

void WorkloadRecorder::finish() {
    if (boxes_) boxes_->finish();
    write_pending();
    if (!calls_.flush()) throw Error("file '" + (folder_ / calls_file).string() + "' cannot be written");
}

Json WorkloadRecorder::json() const {
    return {{"folder", folder_.string()},
            {"box_frames", box_frames_},
            {"box_files", box_files_},
            {"narrowphase_calls", narrowphase_calls_},
            {"touching_calls_not_kept", touching_calls_},
            {"response_calls", response_calls_}};
}

std::string WorkloadRecorder::summary() const {
    std::string text = "workload in " + folder_.string() + ": " + std::to_string(box_frames_) + " frames of boxes in " +
                       std::to_string(box_files_) + " files, " + std::to_string(narrowphase_calls_) +
                       " calls of the narrowphase, " + std::to_string(response_calls_) + " of responses";
    if (touching_calls_) text += "; " + std::to_string(touching_calls_) + " calls for bodies that touch are not kept";
    return text;
}

}  // namespace kolize::cli
