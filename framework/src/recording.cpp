#include <kolize/recording.h>

#include "toml_writer.h"

namespace kolize {
namespace {

// One line for each input: the step, what it is, and its numbers.
class InputLines {
public:
    explicit InputLines(Writer& out) : out_(out) {}

    void add(const TimedInput& timed) {
        head_ = std::to_string(timed.step) + " ";
        std::visit(*this, timed.input);
    }
    void operator()(const ForcesInput& input) {
        const Forces& forces = input.forces;
        out_.line(head_ + "forces " + hex(forces.gravity) + " " + hex(forces.wind) + " " + hex(forces.drag));
    }
    void operator()(const LoadInput& input) {
        out_.line(head_ + "load " + std::to_string(input.body) + " " + hex(input.force) + " " + hex(input.torque));
    }
    void operator()(const PlaceInput& input) {
        const BodyState& s = input.state;
        out_.line(head_ + "place " + std::to_string(input.body) + " " + hex(s.position) + " " + hex(s.orientation) +
                  " " + hex(s.velocity) + " " + hex(s.angular_velocity));
    }
    void operator()(const RemoveInput& input) { out_.line(head_ + "remove " + std::to_string(input.body)); }
    void operator()(const PipelineInput&) { out_.line(head_ + "pipeline " + std::to_string(pipelines_++)); }

private:
    Writer& out_;
    std::string head_;
    std::size_t pipelines_ = 0;  // they stand in tables of their own, in this order
};

std::string hash_text(std::uint64_t hash) {
    constexpr const char* digits = "0123456789abcdef";
    std::string text(16, '0');
    for (std::size_t i = 0; i < 16; ++i) text[15 - i] = digits[hash >> (4 * i) & 15];
    return text;
}

}  // namespace

std::string recording_text(const Recording& recording) {
    const std::string three_quotes(3, '"');
    Writer out;
    out.line("# Played again to the same bits: kolize run --replay THIS_FILE");
    out.plain("schema", std::int64_t(1));
    write_pipeline(out, recording.start.pipeline, "");
    write_render(out, recording.start.render, recording.start.world);
    write_world(out, recording.start, "");
    out.table("[recording]");
    out.line("inputs = " + three_quotes);
    InputLines lines(out);
    for (const TimedInput& input : recording.inputs) lines.add(input);
    out.line(three_quotes);
    out.line("hashes = " + three_quotes);
    for (const std::uint64_t hash : recording.hashes) out.line(hash_text(hash));
    out.line(three_quotes);
    for (const TimedInput& timed : recording.inputs)
        if (const auto* input = std::get_if<PipelineInput>(&timed.input)) {
            out.table("[[recording.pipeline]]");
            write_pipeline(out, input->pipeline, "recording.pipeline.");
        }
    return out.text();
}

}  // namespace kolize
