// kolize bench narrowphase FOLDER: the calls of a run, put to any narrowphase.
#include "bench.h"

#include "judge/witness.h"
#include "workload/calls.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>

namespace kolize::cli {
namespace {

using Clock = std::chrono::steady_clock;
using Overlaps = std::vector<std::uint8_t>;  // by pair of the whole workload, in order

constexpr const char* truth_name = "exact";

struct Variant {
    PlannedVariant plan;
    Witness witness;
    bool made_it = false;                   // the workload is of a run with it
    std::vector<double> milliseconds = {};  // one a call and round
    std::uint64_t contacts = 0, overlapping = 0, failures = 0;
    Overlaps overlaps = {};
    std::uint64_t false_positives = 0, false_negatives = 0;
    bool same = true;  // found what was found then, bit for bit
};

// The calls of the narrowphase, one after another, with the world as it stood.
template <class Visit>
void replay(const CallWorkload& workload, Visit&& visit) {
    World world = workload.scene.world;
    for (const Call& call : workload.calls) {
        for (const BodyChange& change : call.changes) apply(change, world);
        if (const auto* what = std::get_if<NarrowphaseCall>(&call.what)) visit(*what, world);
    }
}

std::vector<Detail> detail_for(const NarrowphaseCall& call, Narrowphase& stage) {
    std::vector<Detail> detail = call.detail;
    for (Detail& one : detail) one = std::min(one, stage.gives());
    return detail;
}

// Shapes of all bodies that any call is about, each by one body that has it.
std::vector<std::uint32_t> bodies_of_shapes(const CallWorkload& workload) {
    const World& world = workload.scene.world;
    std::vector<std::uint8_t> seen(world.shapes.size(), 0);
    std::vector<std::uint32_t> bodies;
    replay(workload, [&](const NarrowphaseCall& call, const World&) {
        for (const Pair& pair : call.pairs)
            for (const std::uint32_t body : {pair.a, pair.b})
                if (!seen[world.shape[body]]) {
                    seen[world.shape[body]] = 1;
                    bodies.push_back(body);
                }
    });
    return bodies;
}

std::optional<std::string> complaint(const Witness& witness, const World& world,
                                     const std::vector<std::uint32_t>& bodies) {
    for (const std::uint32_t body : bodies)
        if (!witness.takes(world, {body, body}))
            return "narrowphase '" + witness.name() + "' does not take shapes of kind " +
                   to_string(world.shape_of(body).kind) + ", such as that of body " + std::to_string(body) + " '" +
                   world.name[body] + "'";
    return std::nullopt;
}

std::vector<Variant> make_variants(const BenchOptions& options, const CallWorkload& workload,
                                   const PluginLibrary& library, Host& host, std::vector<std::string>& left_out) {
    const bool named = names_plugin(options, StageKind::narrowphase);
    const std::vector<std::uint32_t> bodies = bodies_of_shapes(workload);
    std::vector<Variant> variants;
    for (PlannedVariant& plan :
         plan_variants(options, StageKind::narrowphase, plugin_defaults().narrowphase, library)) {
        Witness witness(plan.config, library, host);
        if (const auto sentence = complaint(witness, workload.scene.world, bodies)) {
            if (named) throw Error(*sentence);
            left_out.push_back(*sentence);
            continue;
        }
        witness.prepare(workload.scene.world);
        Variant& variant = variants.emplace_back(Variant{std::move(plan), std::move(witness)});
        variant.made_it = is_maker(workload.scene.pipeline.narrowphase, *variant.plan.plugin, variant.witness.stage());
    }
    if (variants.empty()) throw Error("no narrowphase plugin was found that takes all shapes of the workload");
    return variants;
}

void add_overlaps(const NarrowphaseCall& call, const Contacts& contacts, Overlaps& overlaps) {
    for (const auto& rows : rows_of_pairs(call.pairs, contacts.rows)) overlaps.push_back(!rows.empty());
}

// Untimed: warms the variant up, and finds out what it says.
void listen(Variant& variant, const CallWorkload& workload) {
    Contacts contacts;
    replay(workload, [&](const NarrowphaseCall& call, const World& world) {
        const std::vector<Detail> detail = detail_for(call, variant.witness.stage());
        contacts.clear();
        variant.witness.stage().find_contacts({world, call.pairs, detail}, contacts);
        variant.contacts += contacts.rows.size();
        variant.failures += contacts.failures;
        variant.same = variant.same && contacts.rows.size() == call.found && hash_of(contacts.rows) == call.hash;
        add_overlaps(call, contacts, variant.overlaps);
    });
    variant.overlapping = static_cast<std::uint64_t>(std::count(variant.overlaps.begin(), variant.overlaps.end(), 1));
}

void time_round(Variant& variant, const CallWorkload& workload) {
    Contacts contacts;
    replay(workload, [&](const NarrowphaseCall& call, const World& world) {
        const std::vector<Detail> detail = detail_for(call, variant.witness.stage());
        contacts.clear();
        const auto start = Clock::now();
        variant.witness.stage().find_contacts({world, call.pairs, detail}, contacts);
        variant.milliseconds.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    });
}

// What the exact one says, 2 for pairs that it does not take; nothing where it is not found.
std::optional<Overlaps> truth_of(const CallWorkload& workload, const PluginLibrary& library, Host& host) {
    if (!library.find(StageKind::narrowphase, truth_name)) return std::nullopt;
    Witness truth({truth_name, {}, {}}, library, host);
    truth.prepare(workload.scene.world);
    Overlaps overlaps = {};
    Contacts contacts;
    replay(workload, [&](const NarrowphaseCall& call, const World& world) {
        for (std::size_t i = 0; i < call.pairs.size(); ++i) {
            const Detail detail = std::min(call.detail[i], truth.gives());
            contacts.clear();
            const bool takes = truth.takes(world, call.pairs[i]);
            if (takes) truth.stage().find_contacts({world, {&call.pairs[i], 1}, {&detail, 1}}, contacts);
            overlaps.push_back(!takes ? 2 : !contacts.rows.empty());
        }
    });
    return overlaps;
}

// Round by round over all variants, so that a disturbance of the machine falls on all of them.
void measure(std::vector<Variant>& variants, const CallWorkload& workload, const std::optional<Overlaps>& truth,
             int repeat) {
    Progress progress("bench", variants.size() * static_cast<std::size_t>(repeat + 1));
    for (Variant& variant : variants) {
        listen(variant, workload);
        for (std::size_t i = 0; truth && i < truth->size(); ++i) {
            variant.false_positives += variant.overlaps[i] && (*truth)[i] == 0;
            variant.false_negatives += !variant.overlaps[i] && (*truth)[i] == 1;
        }
        progress.advance();
    }
    for (int round = 0; round < repeat; ++round)
        for (Variant& variant : variants) {
            time_round(variant, workload);
            progress.advance();
        }
}

void print_variants(const std::vector<Variant>& variants, bool judged) {
    Table table({"variant", "gives", "median ms", "p95 ms", "pairs hit", "contacts", "false positives",
                 "false negatives", "as recorded"});
    for (const Variant& v : variants)
        table.add({v.plan.name(), to_string(v.witness.gives()), number(median(v.milliseconds)),
                   number(quantile(v.milliseconds, 0.95)), std::to_string(v.overlapping), std::to_string(v.contacts),
                   judged ? std::to_string(v.false_positives) : "-", judged ? std::to_string(v.false_negatives) : "-",
                   v.made_it ? (v.same ? "yes" : "NO") : "-"});
    table.print(std::cout);
}

Json to_json(const Variant& variant, bool judged) {
    Json row{{"narrowphase", stage_json(*variant.plan.plugin, variant.witness.stage())},
             {"median_ms", median(variant.milliseconds)},
             {"p95_ms", quantile(variant.milliseconds, 0.95)},
             {"overlapping_pairs", variant.overlapping},
             {"contacts", variant.contacts},
             {"failures", variant.failures}};
    if (judged) {
        row["false_positive"] = variant.false_positives;
        row["false_negative"] = variant.false_negatives;
    }
    if (variant.made_it) row["as_recorded"] = variant.same;
    return row;
}

}  // namespace

int bench_narrowphase_calls(const BenchOptions& options) {
    const PluginLibrary library = open_plugins(options.plugin_path, {});
    const CallWorkload workload = read_calls(options.workload, library);
    std::size_t calls = 0, pairs = 0;
    replay(workload, [&](const NarrowphaseCall& call, const World&) {
        ++calls;
        pairs += call.pairs.size();
    });
    if (calls == 0) throw Error("workload '" + options.workload + "' has no call of the narrowphase");
    const std::unique_ptr<Host> host = make_host(options.threads);
    std::vector<std::string> left_out;
    std::vector<Variant> variants = make_variants(options, workload, library, *host, left_out);
    const std::optional<Overlaps> truth = truth_of(workload, library, *host);
    measure(variants, workload, truth, options.repeat);
    if (options.json != "-") {
        std::cout << options.workload << ": " << calls << " calls, " << pairs << " pairs of bodies, " << options.repeat
                  << " rounds\n\n";
        print_variants(variants, truth.has_value());
        for (const std::string& sentence : left_out) std::cout << "left out: " << sentence << '\n';
        if (!truth) std::cout << "there is no narrowphase '" << truth_name << "' to tell which answers are wrong\n";
    }
    if (!options.json.empty()) {
        Json json = bench_json(options, StageKind::narrowphase);
        json["calls"] = calls;
        json["pairs"] = pairs;
        json["variants"] = Json::array();
        for (const Variant& variant : variants) json["variants"].push_back(to_json(variant, truth.has_value()));
        json["left_out"] = left_out;
        write_json(json, options.json);
    }
    return std::all_of(variants.begin(), variants.end(), [](const Variant& v) { return v.same || !v.made_it; }) ? 0 : 1;
}

}  // namespace kolize::cli
