#include "pipeline.h"

#include "room.h"

#include <algorithm>
#include <stdexcept>

namespace kolize {

namespace {

std::uint8_t hit_bits(const std::vector<std::string>& wanted, const std::string& a, const std::string& b) {
    const auto named = [&](const std::string& kind) {
        return wanted.empty() || std::find(wanted.begin(), wanted.end(), kind) != wanted.end();
    };
    return static_cast<std::uint8_t>(named(a) | named(b) << 1);
}

std::string pair_text(const Pair& pair) { return std::to_string(pair.a) + " and " + std::to_string(pair.b); }

}  // namespace

Pipeline::Pipeline(const Scene& scene, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps)
    : world(scene.world),
      broadphase_plugin(
          &plugins.require(StageKind::broadphase, scene.pipeline.broadphase.plugin, scene.pipeline.broadphase.where)),
      narrowphase_plugin(&plugins.require(StageKind::narrowphase, scene.pipeline.narrowphase.plugin,
                                          scene.pipeline.narrowphase.where)),
      broadphase(plugins.make<Broadphase>(scene.pipeline.broadphase, host)),
      narrowphase(plugins.make<Narrowphase>(scene.pipeline.narrowphase, host)),
      host_(host),
      integrator_name_(scene.pipeline.step.integrator),
      integrator_(make_integrator(scene.pipeline.step.integrator)),
      first_step_(scene.capsule_step.value_or(0)),
      scene_bodies_(scene.world.size()),
      rooms_(scene.rooms),
      expected_steps_(expected_steps),
      ledger_config_(scene.pipeline.ledger) {
    for (const ResponseRule& rule : scene.pipeline.responses)
        rules.push_back({&plugins.require(StageKind::response, rule.stage.plugin, rule.stage.where),
                         plugins.make<Response>(rule.stage, host),
                         rule.kinds,
                         Detail::overlap,
                         {},
                         {},
                         {},
                         {}});
    try {
        walls = wall_kind(scene.pipeline.walls, narrowphase_plugin->descriptor->capabilities.shape_kinds,
                          scene.rooms.size());
    } catch (const std::invalid_argument& e) {
        if (!scene.rooms.empty())
            throw Error(scene.pipeline.narrowphase.where,
                        "narrowphase '" + scene.pipeline.narrowphase.plugin + "' " + e.what());
    }
    for (std::size_t i = 0; i < scene.rooms.size() && !scene.capsule_step; ++i)
        add_walls(world, scene.rooms[i], walls, i);
    negotiate(scene.pipeline, plugins);
    if (scene.pipeline.model.bounding_spheres) use_bounding_spheres();
    restore_memory(scene);
    narrowphase->prepare(world);
    if (scene.pipeline.cull != "none") cull_.emplace(scene.pipeline.cull, world);
    number_rows();
    reserve();
    measure.start(world, scene.rooms, expected_steps);
    if (scene.pipeline.ledger.check) ledger.emplace(scene.pipeline.ledger, world);
}

// Room for a dense crowd, so that a new record of contacts in a long run costs no allocation.
void Pipeline::reserve() {
    const std::size_t usual_pairs = 16 * world.size(), usual_contacts = 4 * usual_pairs;
    for (auto* list : {&pairs, &found_, &routed_}) list->reserve(usual_pairs);
    detail_.reserve(usual_pairs);
    rule_.reserve(usual_pairs);
    contacts.rows.reserve(usual_contacts);
    for (Rule& rule : rules) {
        rule.contacts.reserve(usual_contacts);
        rule.rows.reserve(usual_contacts);
        rule.hit.reserve(usual_contacts);
        rule.before.reserve(2 * usual_contacts);
    }
    events.reserve(2 * world.size());
    one_pair_.rows.reserve(256);
    before_.reserve(world.size());
    is_partner_.reserve(world.size());
}

void Pipeline::number_rows() {
    ++generation_;
    rows_.clear();
    unbounded_.clear();
    row_is_static_.clear();
    row_is_reference_.clear();
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        if (world.removed[body]) continue;
        if (world.shape_of(body).kind == ShapeKind::half_space) {
            unbounded_.push_back(body);
            continue;
        }
        rows_.push_back(body);
        row_is_static_.push_back(world.is_static[body]);
        row_is_reference_.push_back(world.is_reference[body]);
    }
    if (std::find(row_is_reference_.begin(), row_is_reference_.end(), 1) == row_is_reference_.end())
        row_is_reference_.clear();
    row_of_.assign(world.size(), no_row);
    for (std::uint32_t row = 0; row < rows_.size(); ++row) row_of_[rows_[row]] = row;
    bounds_.resize(rows_.size());
    for (std::size_t row = 0; row < rows_.size(); ++row) bounds_[row] = world_bounds(world, rows_[row]);
}

// ---------------------------------------------------------------------------------------------- stages

template <class Call, class Blame>
void Pipeline::run_stage(StageKind kind, const char* plugin, Call&& call, Blame&& blame) {
    const auto failed = [&](const std::string& what) { fail(to_string(kind), plugin, what + blame()); };
    if (ledger) ledger->before_stage(world);
    const auto start = StageClock::Clock::now();
    try {
        call();
    } catch (const std::exception& e) {
        failed(e.what());
    } catch (...) {
        failed("it threw something that is no std::exception");
    }
    const Phase phase = kind == StageKind::broadphase    ? Phase::broadphase
                        : kind == StageKind::narrowphase ? Phase::narrowphase
                                                         : Phase::response;
    const auto end = StageClock::Clock::now();
    measure.clock.add(phase, end - start);
    if (!observers.empty()) show([&](Observer& o) { o.ended({to_string(kind), plugin, start, end}); });
    if (ledger && kind != StageKind::response) ledger->after_search(world, kind, plugin);
}

void Pipeline::begin_step(double dt) {
    events.clear();
    if (ledger) ledger->begin_step(step_number(), static_cast<double>(step_number()) * dt);
}

void Pipeline::end_step(double dt) {
    require_finite_world();
    measure.end_step(world, dt);
}

void Pipeline::moved(std::uint32_t body, const BodyState& before, const BodyState& after, double time) {
    require_finite_motion(body, after);
    if (ledger) ledger->after_motion(world, body, before, after, time, "integrator", integrator_name_);
    measure.moved(world, body, before, after, time);
}

void Pipeline::integrate(double dt) {
    const bool watched = ledger || measure.watches_motion();
    before_.clear();
    for (std::uint32_t body = 0; watched && body < world.size(); ++body) before_.push_back(world.state(body));
    const auto start = StageClock::Clock::now();
    integrator_->advance(world, dt, host_);
    const auto end = StageClock::Clock::now();
    measure.clock.add(Phase::integrate, end - start);
    if (!observers.empty()) show([&](Observer& o) { o.ended({"integrate", integrator_name_.c_str(), start, end}); });
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        if (world.is_static[body] || world.removed[body]) continue;
        const BodyState after = world.state(body);
        watched ? moved(body, before_[body], after, dt) : require_finite_motion(body, after);
    }
}

void Pipeline::detect() {
    update_bounds();
    find_pairs();
    route_pairs();
    if (cull_) cull_pairs();
    find_contacts();
}

void Pipeline::update_bounds() {
    constexpr std::size_t grain = 1024;
    host_.parallel_for(rows_.size(), grain, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            if (!row_is_static_[row]) bounds_[row] = world_bounds(world, rows_[row]);
    });
}

void Pipeline::find_pairs() {
    found_.clear();
    run_stage(
        StageKind::broadphase, broadphase_plugin->descriptor->name,
        [&] {
            broadphase->find_pairs(broadphase_input(), found_);
            for (const Pair& pair : found_)
                if (!(pair.a < pair.b && pair.b < rows_.size()))
                    throw std::runtime_error("it reported the pair " + pair_text(pair) + " of " +
                                             std::to_string(rows_.size()) +
                                             " rows; a pair is two rows, the lower one first");
        },
        [] { return std::string(); });
    if (!observers.empty()) show([&](Observer& o) { o.broadphase_found(broadphase_input(), found_); });
    pairs.clear();
    for (const Pair& pair : found_) pairs.push_back({rows_[pair.a], rows_[pair.b]});
    add_half_space_pairs();
    std::sort(pairs.begin(), pairs.end());
    if (const auto twice = std::adjacent_find(pairs.begin(), pairs.end()); twice != pairs.end())
        fail("broadphase", broadphase_plugin->descriptor->name,
             "it reported the bodies " + pair_text(*twice) + " twice");
    measure.pairs += pairs.size();
}

// A half-space has no finite box; its plane is the exact test against one.
bool Pipeline::reaches_behind(const Aabb& box, std::uint32_t wall) const {
    const Vec3 normal = world.orientation[wall] * world.shape_of(wall).normal;
    const Vec3 lowest = (normal.array() > 0).select(box.min, box.max);
    return normal.dot(lowest - world.position[wall]) <= 0;
}

void Pipeline::add_half_space_pairs() {
    for (const std::uint32_t wall : unbounded_)
        for (std::size_t row = 0; row < rows_.size(); ++row)
            if (!row_is_static_[row] && reaches_behind(bounds_[row], wall))
                pairs.push_back({std::min(wall, rows_[row]), std::max(wall, rows_[row])});
}

void Pipeline::route_pairs() {
    routed_.clear();
    detail_.clear();
    rule_.clear();
    for (const Pair& pair : pairs) route(pair);
}

bool Pipeline::route(const Pair& pair) {
    const auto rests = [&](std::uint32_t body) { return world.is_static[body] || world.asleep[body]; };
    if (rests(pair.a) && rests(pair.b)) return false;
    const std::uint32_t rule = rule_of_kinds_[world.kind[pair.a] * world.kinds.size() + world.kind[pair.b]];
    if (rule == no_rule) return false;
    routed_.push_back(pair);
    detail_.push_back(rules[rule].detail);
    rule_.push_back(rule);
    return true;
}

void Pipeline::cull_pairs() {
    const auto start = StageClock::Clock::now();
    cull_->place(world, routed_, host_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < routed_.size(); ++i) {
        if (cull_->certainly_apart(routed_[i])) continue;
        routed_[kept] = routed_[i];
        detail_[kept] = detail_[i];
        rule_[kept++] = rule_[i];
    }
    routed_.resize(kept);
    detail_.resize(kept);
    rule_.resize(kept);
    measure.clock.add(Phase::narrowphase, StageClock::Clock::now() - start);
}

void Pipeline::find_contacts() {
    contacts.clear();
    run_stage(
        StageKind::narrowphase, narrowphase_plugin->descriptor->name,
        [&] {
            narrowphase->find_contacts({world, routed_, detail_}, contacts);
        },
        [&] { return blamed_pair(routed_, detail_); });
    std::size_t i = 0;  // rows and pairs stand in the same order
    for (Contact& contact : contacts.rows) {
        const Pair pair{contact.a, contact.b};
        while (i < routed_.size() && routed_[i] < pair) ++i;
        const bool any = i < routed_.size();
        require_fit(contact, any ? routed_[i] : Pair{}, any ? detail_[i] : Detail::overlap, false);
        contact.rule = rule_[i];
    }
    if (!observers.empty()) show([&](Observer& o) { o.narrowphase_found({world, routed_, detail_}, false, contacts); });
    measure.contacts += contacts.rows.size();
    measure.triangle_tests += contacts.triangle_tests;
    measure.failures += contacts.failures;
}

void Pipeline::respond(double dt, double settle) {
    const std::size_t first_event = events.size();
    for (Rule& rule : rules) {
        rule.contacts.clear();
        rule.rows.clear();
        rule.hit.clear();
        rule.before.clear();
    }
    for (std::size_t i = 0; i < contacts.rows.size(); ++i) {
        const Contact& c = contacts.rows[i];
        Rule& rule = rules[c.rule];
        rule.contacts.push_back(c);
        rule.rows.push_back(i);
        for (const std::uint32_t body : {c.a, c.b}) rule.before.push_back(world.state(body));
        rule.hit.push_back(hit_bits(rule.kinds, world.kinds[world.kind[c.a]], world.kinds[world.kind[c.b]]));
    }
    for (Rule& rule : rules)
        if (!rule.contacts.empty()) respond_with(rule, dt, settle);
    measure.events += events.size() - first_event;
    remove_bodies();
}

void Pipeline::respond_with(Rule& rule, double dt, double settle) {
    const char* const plugin = rule.plugin->descriptor->name;
    const std::size_t first_event = events.size();
    ResponseOutput output{events};
    if (ledger && settle == 0) ledger->check_depths(rule.contacts, narrowphase_plugin->descriptor->name);
    const ResponseInput input{rule.contacts, rule.hit, dt, settle};
    const std::size_t number = static_cast<std::size_t>(&rule - rules.data());
    if (!observers.empty()) show([&](Observer& o) { o.response_begins(number, input, world); });
    run_stage(
        StageKind::response, plugin, [&] { rule.stage->respond(input, world, output); },
        [&] { return blamed_pair(rule, dt); });
    if (!observers.empty()) show([&](Observer& o) { o.response_ended(number, input, world); });
    require_finite_response(rule, output.dissipated_J, first_event);
    const bool moves = rule.plugin->descriptor->capabilities.moves;
    if (moves) swap_places(rule);  // impulses are accounted for where they were given
    if (ledger) ledger->after_response(world, rule.contacts, output.dissipated_J, settle > 0, plugin);
    for (std::size_t i = 0; i < rule.contacts.size(); ++i) {
        Contact& row = contacts.rows[rule.rows[i]];
        row.impulse = rule.contacts[i].impulse;
        row.friction = rule.contacts[i].friction;
        row.couple = rule.contacts[i].couple;
    }
    measure.unresolved += output.unresolved;
    for (Contact& c : rule.contacts)
        if (settle > 0) c.depth = 0;  // it was no depth: nothing overlaps
    measure.after_response(world, rule.contacts, output.dissipated_J, rule.plugin->descriptor->capabilities.rests);
    if (moves) measure.change(world, [&] { swap_places(rule); });
}

// Exchanges the places that the rule's bodies have with those that they had before, or back again.
void Pipeline::swap_places(Rule& rule) {
    swapped_.assign(world.size(), 0);
    for (std::size_t i = 0; i < rule.before.size(); ++i) {
        const Contact& c = rule.contacts[i / 2];
        const std::uint32_t body = i % 2 ? c.b : c.a;
        if (swapped_[body]) continue;
        swapped_[body] = 1;
        std::swap(world.position[body], rule.before[i].position);
        std::swap(world.orientation[body], rule.before[i].orientation);
    }
}

void Pipeline::remove_bodies() {
    bool any = false;
    for (const Event& event : events) {
        if (event.kind != EventKind::removal || world.removed[event.body]) continue;
        measure.before_removal(world, event.body);
        world.removed[event.body] = 1;
        any = true;
    }
    if (any) wake_all();  // of what lay on them
    if (any) number_rows();
}

void Pipeline::find_impacts(std::span<const Pair> some_pairs, const Flow& flow, double from, double until,
                            std::span<double> times) {
    run_stage(
        StageKind::narrowphase, narrowphase_plugin->descriptor->name,
        [&] {
            narrowphase->find_impacts({world, flow, some_pairs, from, until}, times);
        },
        [] { return std::string(); });
    if (!observers.empty())
        show([&](Observer& o) { o.narrowphase_timed({world, flow, some_pairs, from, until}, times); });
    require_times(some_pairs, from, times);
}

bool Pipeline::add_contacts(std::size_t candidate, bool touching, double reach) {
    const Pair& pair = routed_[candidate];
    const NarrowphaseInput input{world, {&pair, 1}, {&detail_[candidate], 1}, reach};
    one_pair_.clear();
    run_stage(
        StageKind::narrowphase, narrowphase_plugin->descriptor->name,
        [&] {
            if (touching)
                narrowphase->find_touching(input, one_pair_);
            else
                narrowphase->find_contacts(input, one_pair_);
        },
        [&] { return " (bodies " + pair_text(pair) + ")"; });
    for (Contact& contact : one_pair_.rows) {
        require_fit(contact, pair, detail_[candidate], touching);
        contact.rule = rule_[candidate];
        contacts.rows.push_back(contact);
    }
    if (!observers.empty()) show([&](Observer& o) { o.narrowphase_found(input, touching, one_pair_); });
    measure.contacts += one_pair_.rows.size();
    measure.triangle_tests += one_pair_.triangle_tests;
    measure.failures += one_pair_.failures;
    return !one_pair_.rows.empty();
}

}  // namespace kolize
