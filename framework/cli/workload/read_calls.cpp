#include "calls.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>

namespace kolize::cli {
namespace {

// The words of one line. Throws std::invalid_argument.
class Words {
public:
    explicit Words(std::string_view line) : rest_(line) {}

    std::string_view word() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
        const std::string_view found = rest_.substr(0, rest_.find(' '));
        if (found.empty()) throw std::invalid_argument("the line is cut short");
        rest_.remove_prefix(found.size());
        return found;
    }
    bool more() const { return rest_.find_first_not_of(' ') != std::string_view::npos; }
    double number() {
        const std::string_view text = word();
        double value = 0;
        const auto [end, error] =
            std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::hex);
        if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
            throw std::invalid_argument("a number such as 1.8p+1 is wanted, not '" + std::string(text) + "'");
        return value;
    }
    std::uint64_t whole(int base = 10) {
        const std::string_view text = word();
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
        if (error != std::errc() || end != text.data() + text.size())
            throw std::invalid_argument("a whole number is wanted, not '" + std::string(text) + "'");
        return value;
    }
    std::uint32_t below(std::size_t limit, const char* what) {
        const std::uint64_t value = whole();
        if (value >= limit)
            throw std::invalid_argument("there are " + std::to_string(limit) + " " + what + ", no number " +
                                        std::to_string(value));
        return static_cast<std::uint32_t>(value);
    }
    Vec3 vector() {
        const double x = number(), y = number(), z = number();
        return {x, y, z};
    }
    Quat quaternion() {
        const double w = number(), x = number(), y = number(), z = number();
        const Quat q(w, x, y, z);
        if (!(std::abs(q.norm() - 1) <= 1e-3)) throw std::invalid_argument("an orientation must have the length 1");
        return q;
    }
    void finish() const {
        if (more()) throw std::invalid_argument("the line is too long");
    }

private:
    std::string_view rest_;
};

Detail detail_named(std::string_view name) {
    for (const Detail detail : {Detail::overlap, Detail::normal, Detail::manifold})
        if (name == to_string(detail)) return detail;
    throw std::invalid_argument("a detail is overlap, normal or manifold, not '" + std::string(name) + "'");
}

class Reader {
public:
    explicit Reader(CallWorkload& workload) : workload_(workload), world_(workload.scene.world) {}

    // Throws std::invalid_argument.
    void read(std::string_view line) {
        Words words(line);
        const std::string_view key = words.word();
        if (key == "step")
            read_step(words);
        else if (key == "memory")
            read_memory(words);
        else if (key == "body")
            read_body(words);
        else if (key == "narrowphase")
            begin(NarrowphaseCall{});
        else if (key == "pair")
            read_pair(words);
        else if (key == "found")
            read_found(words);
        else if (key == "response")
            read_response(words);
        else if (key == "contact")
            read_contact(words);
        else if (key == "after")
            open<ResponseCall>().hash = words.whole(16), is_open_ = false;
        else
            throw std::invalid_argument("no line begins with '" + std::string(key) + "'");
        words.finish();
    }
    void finish() const {
        if (is_open_) throw std::invalid_argument("the last call is cut short");
    }

private:
    template <class What>
    void begin(const What& what) {
        if (is_open_) throw std::invalid_argument("the call before is cut short");
        call_.what = what;
        workload_.calls.push_back(std::move(call_));
        call_ = {call_.step, {}, {}, {}};
        is_open_ = true;
    }
    template <class What>
    What& open() {
        What* const what = is_open_ ? std::get_if<What>(&workload_.calls.back().what) : nullptr;
        if (!what) throw std::invalid_argument("the line belongs to no such call");
        return *what;
    }

    void read_step(Words& words) {
        const std::uint64_t step = words.whole();
        if (step < call_.step) throw std::invalid_argument("steps must not decrease");
        call_.step = step;
    }

    void read_memory(Words& words) {
        RuleMemory& memory = call_.memory.emplace_back();
        memory.rule = words.below(workload_.scene.pipeline.responses.size(), "rules");
        while (words.more()) memory.words.push_back(words.whole(16));
    }

    void read_body(Words& words) {
        BodyChange& change = call_.changes.emplace_back();
        change.body = words.below(world_.size(), "bodies");
        change.removed = words.below(2, "marks") != 0;
        change.asleep = words.below(2, "marks") != 0;
        change.state.position = words.vector();
        change.state.orientation = words.quaternion();
        change.state.velocity = words.vector();
        change.state.angular_velocity = words.vector();
    }

    Pair read_bodies(Words& words) {
        const std::uint32_t a = words.below(world_.size(), "bodies"), b = words.below(world_.size(), "bodies");
        if (a >= b) throw std::invalid_argument("of two bodies the lower one stands first");
        if (world_.is_static[a] && world_.is_static[b]) throw std::invalid_argument("both bodies are static");
        return {a, b};
    }

    void read_pair(Words& words) {
        NarrowphaseCall& call = open<NarrowphaseCall>();
        const Pair pair = read_bodies(words);
        if (!call.pairs.empty() && !(call.pairs.back() < pair))
            throw std::invalid_argument("pairs must stand in order, each once");
        call.pairs.push_back(pair);
        call.detail.push_back(detail_named(words.word()));
    }

    void read_found(Words& words) {
        NarrowphaseCall& call = open<NarrowphaseCall>();
        if (call.pairs.empty()) throw std::invalid_argument("the call has no pairs");
        call.found = words.whole();
        call.hash = words.whole(16);
        is_open_ = false;
    }

    void read_response(Words& words) {
        ResponseCall call;
        call.rule = words.below(workload_.scene.pipeline.responses.size(), "rules");
        call.dt = words.number();
        call.settle = words.number();
        if (!(call.dt >= 0) || !(call.settle >= 0)) throw std::invalid_argument("times must not be below 0");
        begin(call);
    }

    void read_contact(Words& words) {
        ResponseCall& call = open<ResponseCall>();
        Contact contact;
        const Pair pair = read_bodies(words);
        contact.a = pair.a;
        contact.b = pair.b;
        contact.region = static_cast<std::uint32_t>(words.whole());
        contact.rule = static_cast<std::uint32_t>(call.rule);
        const std::uint32_t hit = words.below(4, "combinations of two bodies");
        contact.normal = words.vector();
        if (!contact.normal.isZero(0) && !(std::abs(contact.normal.norm() - 1) <= 1e-6))
            throw std::invalid_argument("a normal must have the length 1, or 0 where it is not known");
        contact.arm_a = words.vector();
        contact.arm_b = words.vector();
        contact.depth = words.number();
        call.contacts.push_back(contact);
        call.hit.push_back(static_cast<std::uint8_t>(hit));
    }

    CallWorkload& workload_;
    const World& world_;
    Call call_;             // that comes next
    bool is_open_ = false;  // the last call is not yet complete
};

}  // namespace

CallWorkload read_calls(const std::filesystem::path& folder, const PluginLibrary& plugins) {
    CallWorkload workload;
    workload.scene = load_scene(folder / world_file, {{}, {}, {}}, plugins);
    const std::filesystem::path file = folder / calls_file;
    std::ifstream stream(file);
    if (!stream) throw Error("workload '" + file.string() + "' cannot be read");
    SourceLocation where{file.string(), 0, 0};
    Reader reader(workload);
    std::string line;
    try {
        while (++where.line, std::getline(stream, line))
            if (!line.empty() && line[0] != '#') reader.read(line);
        reader.finish();
    } catch (const std::invalid_argument& error) {
        throw Error(where, error.what());
    }
    return workload;
}

}  // namespace kolize::cli
