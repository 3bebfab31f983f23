#include "trace.h"

#include "common.h"

#include <nlohmann/json.hpp>

#include <chrono>

namespace kolize::cli {

namespace {

// Microseconds, as the format wants them, to the nanosecond: rounding must not push an event out of its step.
std::string microseconds(Span::Clock::duration time) {
    const auto count = std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
    const std::string digits = std::to_string(count % 1000);
    return std::to_string(count / 1000) + '.' + std::string(3 - digits.size(), '0') + digits;
}

}  // namespace

Trace::Trace(std::filesystem::path file, const Simulation& simulation)
    : file_(std::move(file)), part_(file_.string() + ".part"), simulation_(simulation), start_(Span::Clock::now()) {
    out_.open(part_);
    if (!out_) throw Error("trace '" + file_.string() + "' cannot be written: '" + part_.string() + "' cannot be made");
    out_ << R"({"displayTimeUnit":"ns","otherData":)"
         << Json{{"command", command_line()}, {"host", host_block()}}.dump() << R"(,"traceEvents":[
{"ph":"M","pid":1,"tid":1,"name":"process_name","args":{"name":"kolize"}},
{"ph":"M","pid":1,"tid":1,"name":"thread_name","args":{"name":"pipeline"}})";
}

Trace::~Trace() {
    try {
        if (!is_finished_) finish();
    } catch (const Error&) {  // the run has failed, and says why itself
    }
}

void Trace::finish() {
    is_finished_ = true;
    out_ << "\n]}\n";
    out_.close();
    std::error_code error;
    if (out_) std::filesystem::rename(part_, file_, error);
    if (!out_ || error) throw Error("trace '" + file_.string() + "' could not be written to its end");
}

void Trace::write_event(const char* phase, const char* name, Span::Clock::time_point time) {
    out_ << ",\n{\"ph\":\"" << phase << R"(","pid":1,"tid":1,"ts":)" << microseconds(time - start_) << R"(,"name":")"
         << name << '"';
}

void Trace::ended(const Span& span) {
    write_event("X", span.stage, span.begin);
    out_ << R"(,"dur":)" << microseconds(span.end - span.begin) << R"(,"args":{"plugin":")" << span.plugin << '"';
    if (span.stage == std::string_view("step")) {
        out_ << R"(,"step":)" << simulation_.step_number() - 1;
        step_end_ = span.end;
    }
    out_ << "}}";
}

void Trace::broadphase_found(const BroadphaseInput&, std::span<const Pair> pairs) { pairs_ += pairs.size(); }

void Trace::narrowphase_found(const NarrowphaseInput&, bool, const Contacts& contacts) {
    contacts_ += contacts.rows.size();
    triangle_tests_ += contacts.triangle_tests;
}

void Trace::write_counter(const char* name, double value) {
    write_event("C", name, step_end_);
    out_ << R"(,"args":{"value":)" << Json(value).dump() << "}}";
}

void Trace::step_ended(std::uint64_t, const World&) {
    write_counter("broadphase pairs", static_cast<double>(std::exchange(pairs_, 0)));
    write_counter("contacts", static_cast<double>(std::exchange(contacts_, 0)));
    write_counter("triangle tests", static_cast<double>(std::exchange(triangle_tests_, 0)));
    const Reading reading = simulation_.reading();
    write_counter("energy J", reading.energy_J);
    write_counter("energy drift", reading.energy_drift);
    for (const Event& event : simulation_.events()) {
        write_event("i", event.kind == EventKind::explosion ? "explosion" : "removal", step_end_);
        out_ << R"(,"s":"t","args":{"body":)" << event.body << "}}";
    }
}

}  // namespace kolize::cli
