// kolize bench response FOLDER: the contacts of a run, put to any response.
#include "bench.h"

#include "workload/calls.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>
#include <set>

namespace kolize::cli {
namespace {

using Clock = std::chrono::steady_clock;

// One object for each rule of the workload, as in the run: they may remember.
struct Variant {
    PlannedVariant plan;
    std::vector<StagePtr<Response>> stages;
    std::vector<std::uint8_t> made_it;  // by rule: this part of the workload is of a run with it
    std::vector<double> milliseconds;   // one a call and round
    double energy_off = 0;              // share of the energy at hand, largest of any call, by size
    double fastest_m_s = 0;             // of the approaches that are left
    std::uint64_t contacts = 0, approaching = 0, unresolved = 0, removed = 0;
    bool same = true;  // did what was done then, bit for bit

    bool made_any() const { return std::find(made_it.begin(), made_it.end(), 1) != made_it.end(); }
};

std::set<std::uint32_t> bodies_in(const ResponseCall& call) {
    std::set<std::uint32_t> bodies;
    for (const Contact& contact : call.contacts) bodies.insert({contact.a, contact.b});
    return bodies;
}

double energy_of(const World& world, const std::set<std::uint32_t>& bodies) {
    double sum = 0;
    for (const std::uint32_t body : bodies) sum += world.kinetic_energy(body);
    return sum;
}

// m/s, beyond what the contact may keep; 0 where that is rounding.
double approach_left(const Contact& c, const ResponseInput& input, const World& world) {
    const Vec3 a = world.velocity_at(c.a, c.arm_a), b = world.velocity_at(c.b, c.arm_b);
    const double left = -c.normal.dot(b - a) - input.allowed_approach(c);
    return left > 1e-9 * (a.norm() + b.norm()) ? left : 0;
}

// Whether the contacts say as much as the response needs.
bool suffices(const CallWorkload& workload, const Capabilities& capabilities) {
    if (capabilities.needs == Detail::overlap) return true;
    for (const Call& call : workload.calls)
        if (const auto* what = std::get_if<ResponseCall>(&call.what))
            for (const Contact& contact : what->contacts)
                if (contact.normal.isZero(0)) return false;
    return true;
}

// Each call with the world as it stood: a copy, in which a response may do what it likes.
class Replay {
public:
    explicit Replay(const CallWorkload& workload) : workload_(workload) {}

    template <class Visit>
    void run(Variant& variant, Visit&& visit) {
        World recorded = workload_.scene.world, world = recorded;
        for (const StagePtr<Response>& stage : variant.stages) stage->restore({});
        std::vector<Contact> contacts;
        for (const Call& call : workload_.calls) {
            for (const BodyChange& change : call.changes) apply(change, recorded);
            for (const RuleMemory& memory : call.memory)
                if (variant.made_it[memory.rule]) variant.stages[memory.rule]->restore(memory.words);
            const auto* what = std::get_if<ResponseCall>(&call.what);
            if (!what) continue;
            take_state(recorded, world);
            contacts = what->contacts;
            visit(*what, ResponseInput{contacts, what->hit, what->dt, what->settle}, world);
        }
    }

private:
    static void take_state(const World& from, World& to) {
        to.position = from.position;
        to.orientation = from.orientation;
        to.velocity = from.velocity;
        to.angular_velocity = from.angular_velocity;
        to.removed = from.removed;
        to.asleep = from.asleep;
    }

    const CallWorkload& workload_;
};

// Untimed: warms the variant up, and finds out what it does.
void look(Variant& variant, const CallWorkload& workload) {
    std::vector<Event> events;
    Replay(workload).run(variant, [&](const ResponseCall& call, const ResponseInput& input, World& world) {
        const std::set<std::uint32_t> bodies = bodies_in(call);
        const double before = energy_of(world, bodies);
        events.clear();
        ResponseOutput output{events};
        variant.stages[call.rule]->respond(input, world, output);
        const double after = energy_of(world, bodies), off = after + output.dissipated_J - before;
        if (before + after > 0) variant.energy_off = std::max(variant.energy_off, std::abs(off) / (before + after));
        variant.unresolved += output.unresolved;
        variant.contacts += call.contacts.size();
        if (variant.made_it[call.rule]) variant.same = variant.same && hash_of(world, input.contacts) == call.hash;
        std::set<std::uint32_t> gone;
        for (const Event& event : events)
            if (event.kind == EventKind::removal) gone.insert(event.body);
        variant.removed += gone.size();
        for (const Contact& contact : input.contacts) {
            if (gone.contains(contact.a) || gone.contains(contact.b)) continue;
            const double left = approach_left(contact, input, world);
            variant.approaching += left > 0;
            variant.fastest_m_s = std::max(variant.fastest_m_s, left);
        }
    });
}

void time_round(Variant& variant, const CallWorkload& workload) {
    std::vector<Event> events;
    Replay(workload).run(variant, [&](const ResponseCall& call, const ResponseInput& input, World& world) {
        events.clear();
        ResponseOutput output{events};
        const auto start = Clock::now();
        variant.stages[call.rule]->respond(input, world, output);
        variant.milliseconds.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    });
}

std::vector<Variant> make_variants(const BenchOptions& options, const CallWorkload& workload,
                                   const PluginLibrary& library, Host& host, std::vector<std::string>& left_out) {
    const bool named = names_plugin(options, StageKind::response);
    const std::vector<ResponseRule>& rules = workload.scene.pipeline.responses;
    std::vector<Variant> variants;
    for (PlannedVariant& plan : plan_variants(options, StageKind::response, plugin_defaults().response, library)) {
        if (!suffices(workload, plan.plugin->descriptor->capabilities)) {
            const std::string sentence =
                "response '" + plan.config.plugin + "' needs normals, which contacts of the workload do not have";
            if (named) throw Error(sentence);
            left_out.push_back(sentence);
            continue;
        }
        Variant& variant = variants.emplace_back(Variant{std::move(plan), {}, {}, {}});
        for (const ResponseRule& rule : rules) {
            variant.stages.push_back(library.make<Response>(variant.plan.config, host));
            variant.made_it.push_back(is_maker(rule.stage, *variant.plan.plugin, *variant.stages.back()));
        }
    }
    if (variants.empty()) throw Error("no response plugin was found that can take the workload");
    return variants;
}

// Round by round over all variants, so that a disturbance of the machine falls on all of them.
void measure(std::vector<Variant>& variants, const CallWorkload& workload, int repeat) {
    Progress progress("bench", variants.size() * static_cast<std::size_t>(repeat + 1));
    for (Variant& variant : variants) {
        look(variant, workload);
        progress.advance();
    }
    for (int round = 0; round < repeat; ++round)
        for (Variant& variant : variants) {
            time_round(variant, workload);
            progress.advance();
        }
}

void print_variants(const std::vector<Variant>& variants) {
    Table table({"variant", "median ms", "p95 ms", "contacts", "approaching", "fastest m/s", "unresolved", "energy off",
                 "removed", "as recorded"});
    for (const Variant& v : variants)
        table.add({v.plan.name(), number(median(v.milliseconds)), number(quantile(v.milliseconds, 0.95)),
                   std::to_string(v.contacts), std::to_string(v.approaching), number(v.fastest_m_s),
                   std::to_string(v.unresolved), number(v.energy_off), std::to_string(v.removed),
                   v.made_any() ? (v.same ? "yes" : "NO") : "-"});
    table.print(std::cout);
}

Json to_json(const Variant& variant) {
    Json row{{"response", stage_json(*variant.plan.plugin, *variant.stages.front())},
             {"median_ms", median(variant.milliseconds)},
             {"p95_ms", quantile(variant.milliseconds, 0.95)},
             {"contacts", variant.contacts},
             {"approaching", variant.approaching},
             {"fastest_approach_m_s", variant.fastest_m_s},
             {"unresolved", variant.unresolved},
             {"energy_off", variant.energy_off},
             {"removed", variant.removed}};
    if (variant.made_any()) row["as_recorded"] = variant.same;
    return row;
}

std::size_t count_calls(const CallWorkload& workload) {
    return static_cast<std::size_t>(std::count_if(workload.calls.begin(), workload.calls.end(), [](const Call& call) {
        return std::holds_alternative<ResponseCall>(call.what);
    }));
}

}  // namespace

int bench_response(const BenchOptions& options) {
    if (!std::filesystem::is_directory(options.workload))
        throw Error("workload '" + options.workload + "' is not a folder; kolize run SCENE --save-workload writes one");
    const PluginLibrary library = open_plugins(options.plugin_path, {});
    const CallWorkload workload = read_calls(options.workload, library);
    const std::size_t calls = count_calls(workload);
    if (calls == 0) throw Error("workload '" + options.workload + "' has no call of a response");
    const std::unique_ptr<Host> host = make_host(options.threads);
    std::vector<std::string> left_out;
    std::vector<Variant> variants = make_variants(options, workload, library, *host, left_out);
    measure(variants, workload, options.repeat);
    if (options.json != "-") {
        std::cout << options.workload << ": " << calls << " calls, " << options.repeat << " rounds\n\n";
        print_variants(variants);
        for (const std::string& sentence : left_out) std::cout << "left out: " << sentence << '\n';
    }
    if (!options.json.empty()) {
        Json json = bench_json(options, StageKind::response);
        json["calls"] = calls;
        json["variants"] = Json::array();
        for (const Variant& variant : variants) json["variants"].push_back(to_json(variant));
        json["left_out"] = left_out;
        write_json(json, options.json);
    }
    return std::all_of(variants.begin(), variants.end(), [](const Variant& v) { return v.same; }) ? 0 : 1;
}

}  // namespace kolize::cli
