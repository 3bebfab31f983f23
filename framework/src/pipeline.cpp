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
      integrator_(make_integrator(scene.pipeline.step.integrator)) {
    for (const ResponseRule& rule : scene.pipeline.responses)
        rules.push_back({&plugins.require(StageKind::response, rule.stage.plugin, rule.stage.where),
                         plugins.make<Response>(rule.stage, host),
                         rule.kinds,
                         Detail::overlap,
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
    for (std::size_t i = 0; i < scene.rooms.size(); ++i) add_walls(world, scene.rooms[i], walls, i);
    negotiate(scene.pipeline, plugins);
    use_bounding_spheres();
    narrowphase->prepare(world);
    number_rows();
    reserve();
    measure.start(world, scene.rooms, expected_steps);
}

// Room for a dense crowd, so that a new record of contacts in a long run costs no allocation.
void Pipeline::reserve() {
    const std::size_t usual_pairs = 8 * world.size(), usual_contacts = 4 * usual_pairs;
    for (auto* list : {&pairs, &found_, &routed_}) list->reserve(usual_pairs);
    detail_.reserve(usual_pairs);
    rule_.reserve(usual_pairs);
    contacts.rows.reserve(usual_contacts);
    for (Rule& rule : rules) {
        rule.contacts.reserve(usual_contacts);
        rule.rows.reserve(usual_contacts);
        rule.hit.reserve(usual_contacts);
    }
    events.reserve(2 * world.size());
}

void Pipeline::number_rows() {
    ++generation_;
    rows_.clear();
    unbounded_.clear();
    row_is_static_.clear();
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        if (world.removed[body]) continue;
        if (world.shape_of(body).kind == ShapeKind::half_space) {
            unbounded_.push_back(body);
            continue;
        }
        rows_.push_back(body);
        row_is_static_.push_back(world.is_static[body]);
    }
    bounds_.resize(rows_.size());
    for (std::size_t row = 0; row < rows_.size(); ++row) bounds_[row] = world_bounds(world, rows_[row]);
}

// ---------------------------------------------------------------------------------------------- stages

template <class Call>
void Pipeline::run_stage(StageKind kind, const char* plugin, Call&& call) {
    const auto failed = [&](const std::string& what) {
        throw std::runtime_error(std::string(to_string(kind)) + " '" + plugin + "' failed at step " +
                                 std::to_string(measure.steps) + ": " + what);
    };
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
    measure.clock.add(phase, StageClock::Clock::now() - start);
}

void Pipeline::begin_step() { events.clear(); }

void Pipeline::end_step(double dt) { measure.end_step(world, dt); }

void Pipeline::integrate(double dt) {
    measure.before_motion(world);
    const auto start = StageClock::Clock::now();
    integrator_->advance(world, dt, host_);
    measure.clock.add(Phase::integrate, StageClock::Clock::now() - start);
    measure.after_motion(world, dt);
}

void Pipeline::detect() {
    update_bounds();
    find_pairs();
    route_pairs();
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
    run_stage(StageKind::broadphase, broadphase_plugin->descriptor->name, [&] {
        broadphase->find_pairs({bounds_, row_is_static_, generation_}, found_);
        for (const Pair& pair : found_)
            if (!(pair.a < pair.b && pair.b < rows_.size()))
                throw std::runtime_error("it reported the pair " + pair_text(pair) + " of " +
                                         std::to_string(rows_.size()) +
                                         " rows; a pair is two rows, the lower one first");
    });
    pairs.clear();
    for (const Pair& pair : found_) pairs.push_back({rows_[pair.a], rows_[pair.b]});
    add_half_space_pairs();
    std::sort(pairs.begin(), pairs.end());
    if (const auto twice = std::adjacent_find(pairs.begin(), pairs.end()); twice != pairs.end())
        throw std::runtime_error("broadphase '" + std::string(broadphase_plugin->descriptor->name) +
                                 "' failed at step " + std::to_string(measure.steps) + ": it reported the bodies " +
                                 pair_text(*twice) + " twice");
    measure.pairs += pairs.size();
}

// A half-space has no finite box; its plane is the exact test against one.
void Pipeline::add_half_space_pairs() {
    for (const std::uint32_t wall : unbounded_) {
        const Vec3 normal = world.orientation[wall] * world.shape_of(wall).normal;
        for (std::size_t row = 0; row < rows_.size(); ++row) {
            if (row_is_static_[row]) continue;
            const Aabb& box = bounds_[row];
            const Vec3 lowest = (normal.array() > 0).select(box.min, box.max);
            if (normal.dot(lowest - world.position[wall]) <= 0)
                pairs.push_back({std::min(wall, rows_[row]), std::max(wall, rows_[row])});
        }
    }
}

void Pipeline::route_pairs() {
    routed_.clear();
    detail_.clear();
    rule_.clear();
    const std::size_t kinds = world.kinds.size();
    for (const Pair& pair : pairs) {
        const std::uint32_t rule = rule_of_kinds_[world.kind[pair.a] * kinds + world.kind[pair.b]];
        if (rule == no_rule) continue;
        routed_.push_back(pair);
        detail_.push_back(rules[rule].detail);
        rule_.push_back(rule);
    }
}

namespace {

// What contact.h promises of a row; a plugin that claims more than it gives is found out here.
std::string complaint(const Contact& c, Detail detail) {
    if (!c.normal.allFinite() || !c.arm_a.allFinite() || !c.arm_b.allFinite() || !std::isfinite(c.depth))
        return "a value that is not finite";
    if (detail == Detail::overlap) return "";
    if (!(std::abs(c.normal.norm() - 1) < 1e-6))
        return "a normal of length " + std::to_string(c.normal.norm()) + ", not 1";
    if (!(c.depth > 0)) return "a depth of " + std::to_string(c.depth) + " m, not above 0";
    return "";
}

}  // namespace

void Pipeline::find_contacts() {
    contacts.clear();
    run_stage(StageKind::narrowphase, narrowphase_plugin->descriptor->name, [&] {
        narrowphase->find_contacts({world, routed_, detail_}, contacts);
    });
    std::size_t i = 0;  // rows and pairs stand in the same order
    for (Contact& contact : contacts.rows) {
        const Pair pair{contact.a, contact.b};
        while (i < routed_.size() && routed_[i] < pair) ++i;
        const bool asked = i < routed_.size() && routed_[i] == pair;
        const std::string wrong =
            asked ? complaint(contact, detail_[i]) : "a pair that was not asked for, or out of order";
        if (!wrong.empty())
            throw std::runtime_error("narrowphase '" + std::string(narrowphase_plugin->descriptor->name) +
                                     "' failed at step " + std::to_string(measure.steps) +
                                     ": its contact of the bodies " + pair_text(pair) + " has " + wrong);
        contact.rule = rule_[i];
    }
    measure.contacts += contacts.rows.size();
    measure.triangle_tests += contacts.triangle_tests;
}

void Pipeline::respond(double dt) {
    const std::size_t first_event = events.size();
    for (Rule& rule : rules) {
        rule.contacts.clear();
        rule.rows.clear();
        rule.hit.clear();
    }
    for (std::size_t i = 0; i < contacts.rows.size(); ++i) {
        const Contact& c = contacts.rows[i];
        Rule& rule = rules[c.rule];
        rule.contacts.push_back(c);
        rule.rows.push_back(i);
        rule.hit.push_back(hit_bits(rule.kinds, world.kinds[world.kind[c.a]], world.kinds[world.kind[c.b]]));
    }
    for (Rule& rule : rules)
        if (!rule.contacts.empty()) respond_with(rule, dt);
    measure.events += events.size() - first_event;
    remove_bodies();
}

void Pipeline::respond_with(Rule& rule, double dt) {
    ResponseOutput output{events};
    run_stage(StageKind::response, rule.plugin->descriptor->name, [&] {
        rule.stage->respond({rule.contacts, rule.hit, dt}, world, output);
    });
    for (std::size_t i = 0; i < rule.contacts.size(); ++i)
        contacts.rows[rule.rows[i]].impulse = rule.contacts[i].impulse;
    measure.unresolved += output.unresolved;
    measure.after_response(world, rule.contacts, output.dissipated_J);
}

void Pipeline::remove_bodies() {
    bool any = false;
    for (const Event& event : events) {
        if (event.kind != EventKind::removal || world.removed[event.body]) continue;
        measure.before_removal(world, event.body);
        world.removed[event.body] = 1;
        any = true;
    }
    if (any) number_rows();
}

// ---------------------------------------------------------------------------------------------- for steppings

bool Pipeline::approaching() const {
    return std::any_of(contacts.rows.begin(), contacts.rows.end(), [&](const Contact& c) {
        if (rules[c.rule].detail == Detail::overlap) return true;
        const Vec3 a = world.velocity_at(c.a, c.arm_a), b = world.velocity_at(c.b, c.arm_b);
        // Below rounding of the two velocities the sign says nothing.
        return c.normal.dot(b - a) < -1e-12 * (a.norm() + b.norm());
    });
}

void Pipeline::save() {
    saved_.position = world.position;  // assignment re-uses the buffers
    saved_.velocity = world.velocity;
    saved_.angular_velocity = world.angular_velocity;
    saved_.orientation = world.orientation;
    measure.save();
}

void Pipeline::restore() {
    world.position = saved_.position;
    world.velocity = saved_.velocity;
    world.angular_velocity = saved_.angular_velocity;
    world.orientation = saved_.orientation;
    measure.restore();
}

void Pipeline::put_back(std::uint32_t body) {
    const Quat turned_back = saved_.orientation[body] * world.orientation[body].conjugate();
    world.angular_velocity[body] = turned_back * world.angular_velocity[body];
    world.position[body] = saved_.position[body];
    world.orientation[body] = saved_.orientation[body];
}

}  // namespace kolize
