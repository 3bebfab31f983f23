// [recording]: what was put into a run, and what came out of its steps.
#include "exact_numbers.h"
#include "parts.h"

#include <charconv>
#include <sstream>

namespace kolize::config {
namespace {

// The lines of a text that begins on the line after its opening quotes.
template <class Read>
void for_lines(TableReader& reader, const std::string& key, const Read& read) {
    const toml::node& node = reader.require(key);
    const SourceLocation begin = location(node);
    const auto value = node.value_exact<std::string>();  // it may be empty
    std::istringstream text(value ? *value : reader.text(key, ""));
    int number = begin.line;
    for (std::string line; std::getline(text, line);) {
        ++number;
        if (!line.empty()) read(line, SourceLocation{begin.file, number, 0});
    }
}

// The words of one line, read in turn.
class Words {
public:
    Words(const std::string& line, const SourceLocation& where) : text_(line), where_(where) {}

    std::string word(const char* wanted) {
        std::string word;
        if (!(text_ >> word)) refuse(wanted, "the line ends");
        return word;
    }
    std::uint64_t index(const char* wanted) {
        const std::string text = word(wanted);
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size()) refuse(wanted, "there is '" + text + "'");
        return value;
    }
    double number() {
        const std::string text = word("a number such as 0x1.8p+1");
        double value = 0;
        if (!parse_exact(text, value) || !std::isfinite(value))
            refuse("a finite number such as 0x1.8p+1", "there is '" + text + "'");
        return value;
    }
    Vec3 vector() {
        const double x = number(), y = number(), z = number();
        return {x, y, z};
    }
    Quat quaternion() {
        const double w = number();
        const Vec3 v = vector();
        return {w, v.x(), v.y(), v.z()};
    }
    void finish() {
        if (std::string more; text_ >> more) refuse("the end of the line", "there is '" + more + "'");
    }
    [[noreturn]] void refuse(const std::string& wanted, const std::string& is) const {
        throw Error(where_, wanted + " is wanted where " + is);
    }

private:
    std::istringstream text_;
    SourceLocation where_;
};

std::uint32_t dynamic_body(Words& words, const World& world) {
    const std::uint64_t body = words.index("the number of a body");
    if (body >= world.size() || world.is_static[body])
        words.refuse("the number of a dynamic body", "there is " + std::to_string(body));
    return static_cast<std::uint32_t>(body);
}

Input read_place(Words& words, const World& world) {
    PlaceInput place{dynamic_body(words, world), {}};
    place.state.position = words.vector();
    place.state.orientation = words.quaternion();
    place.state.velocity = words.vector();
    place.state.angular_velocity = words.vector();
    if (!(std::abs(place.state.orientation.norm() - 1) <= 1e-9))
        words.refuse("a quaternion of length 1",
                     "there is one of length " + to_string(Value(place.state.orientation.norm())));
    return place;
}

Input read_forces(Words& words) {
    const Vec3 gravity = words.vector(), wind = words.vector();
    const double drag = words.number();
    if (drag < 0) words.refuse("a drag that is not below 0", "there is " + to_string(Value(drag)));
    return ForcesInput{{gravity, wind, drag}};
}

Input read_input(Words& words, const World& world, const std::vector<PipelineConfig>& pipelines) {
    const std::string what = words.word("the kind of an input");
    if (what == "forces") return read_forces(words);
    if (what == "place") return read_place(words, world);
    if (what == "remove") return RemoveInput{dynamic_body(words, world)};
    if (what == "load") {
        const std::uint32_t body = dynamic_body(words, world);
        const Vec3 force = words.vector();
        return LoadInput{body, force, words.vector()};
    }
    if (what != "pipeline") words.refuse("forces, load, place, remove or pipeline", "there is '" + what + "'");
    const std::uint64_t number = words.index("the number of a pipeline");
    if (number >= pipelines.size())
        words.refuse("one of the " + std::to_string(pipelines.size()) + " [[recording.pipeline]], counted from 0,",
                     "there is " + std::to_string(number));
    return PipelineInput{pipelines[number]};
}

std::uint64_t read_hash(const std::string& line, const SourceLocation& where) {
    std::uint64_t hash = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), hash, 16);
    if (error != std::errc() || end != line.data() + line.size() || line.size() != 16)
        throw Error(where, "16 hexadecimal digits are wanted where there is '" + line + "'");
    return hash;
}

}  // namespace

void read_recording(const toml::table& config, const PluginDefaults& defaults, Recording& recording) {
    const toml::table& table = config::table(config, "recording");
    TableReader reader(table, "[recording]");
    std::vector<PipelineConfig> pipelines;
    for (const toml::table* pipeline : tables(table, "pipeline"))
        pipelines.push_back(read_pipeline(*pipeline, defaults));
    reader.has("pipeline");
    const std::uint64_t first = recording.start.capsule_step.value_or(0);
    std::uint64_t latest = first;
    for_lines(reader, "inputs", [&](const std::string& line, const SourceLocation& where) {
        Words words(line, where);
        const std::uint64_t step = words.index("the number of a step");
        if (step < latest) words.refuse("a step from " + std::to_string(latest), "there is " + std::to_string(step));
        latest = step;
        recording.inputs.push_back({step, read_input(words, recording.start.world, pipelines)});
        words.finish();
    });
    for_lines(reader, "hashes", [&](const std::string& line, const SourceLocation& where) {
        recording.hashes.push_back(read_hash(line, where));
    });
    reader.finish();
}

}  // namespace kolize::config
