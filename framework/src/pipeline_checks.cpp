// Nothing that is not a number leaves the stage that made it, and a stage that fails is named with the pair it failed
// over.
#include "pipeline.h"

#include <stdexcept>

namespace kolize {
namespace {

// A sum of finite numbers times zero is zero.
bool is_finite(const Vec3& v) { return 0 * v.x() + 0 * v.y() + 0 * v.z() == 0; }
bool is_finite(const Quat& q) { return 0 * q.w() + 0 * q.x() + 0 * q.y() + 0 * q.z() == 0; }

// Nullptr if there is none.
const char* unusable_quantity(const BodyState& state) {
    if (!is_finite(state.position)) return "position";
    if (!is_finite(state.orientation)) return "orientation";
    if (!is_finite(state.velocity)) return "velocity";
    return is_finite(state.angular_velocity) ? nullptr : "angular velocity";
}

std::string not_finite(const World& world, const char* quantity, std::uint32_t body) {
    return std::string("the ") + quantity + " of body " + body_text(world, body) + " is not finite";
}

std::string pair_blame(const World& world, std::uint32_t a, std::uint32_t b) {
    return " (bodies " + body_text(world, a) + " and " + body_text(world, b) + ")";
}

// What contact.h promises of a row; a plugin that claims more than it gives is found out here.
std::string complaint(const Contact& c, Detail detail, bool touching) {
    if (!c.normal.allFinite() || !c.arm_a.allFinite() || !c.arm_b.allFinite() || !std::isfinite(c.depth))
        return "a value that is not finite";
    if (detail == Detail::overlap) return "";
    if (!(std::abs(c.normal.norm() - 1) < 1e-6))
        return "a normal of length " + std::to_string(c.normal.norm()) + ", not 1";
    if (touching != (c.depth <= 0))
        return "a depth of " + std::to_string(c.depth) + " m, which is " + (touching ? "above" : "not above") + " 0";
    return "";
}

template <class Call>
bool throws(Call&& call) {
    try {
        call();
    } catch (...) {
        return true;
    }
    return false;
}

}  // namespace

void Pipeline::fail(const char* stage, const std::string& plugin, const std::string& what) const {
    throw std::runtime_error(std::string(stage) + " '" + plugin + "' failed at step " + std::to_string(step_number()) +
                             ": " + what);
}

void Pipeline::require_fit(const Contact& contact, const Pair& asked, Detail detail, bool touching) const {
    const Pair pair{contact.a, contact.b};
    const std::string wrong =
        pair == asked ? complaint(contact, detail, touching) : "a pair that was not asked for, or out of order";
    if (!wrong.empty())
        fail(
            "narrowphase", narrowphase_plugin->descriptor->name,
            "its contact of the bodies " + std::to_string(pair.a) + " and " + std::to_string(pair.b) + " has " + wrong);
}

void Pipeline::require_finite_motion(std::uint32_t body, const BodyState& after) const {
    if (const char* quantity = unusable_quantity(after))
        fail("integrator", integrator_name_, not_finite(world, quantity, body));
}

void Pipeline::refuse_path(std::uint32_t body, const BodyState& end) const {
    require_finite_motion(body, end);
    fail("integrator", integrator_name_,
         "the way of body " + body_text(world, body) + " in one step is longer than can be computed with");
}

void Pipeline::refuse_motion(const std::string& what) const { fail("integrator", integrator_name_, what); }

void Pipeline::require_finite_response(const Rule& rule, double dissipated_J, std::size_t first_event) const {
    const auto refuse = [&](const std::string& what) { fail("response", rule.plugin->descriptor->name, what); };
    for (const Contact& c : rule.contacts) {
        if (!is_finite(c.total_impulse()) || !is_finite(c.couple))
            refuse("the impulse of a contact is not finite" + pair_blame(world, c.a, c.b));
        for (const std::uint32_t body : {c.a, c.b})
            if (const char* quantity = unusable_quantity(world.state(body)))
                refuse(not_finite(world, quantity, body) + pair_blame(world, c.a, c.b));
    }
    if (!std::isfinite(dissipated_J)) refuse("the energy that it says it took is not finite");
    for (std::size_t i = first_event; i < events.size(); ++i) {
        const std::uint32_t body = events[i].body;
        if (body >= world.size())
            refuse("it reports an event of body " + std::to_string(body) + "; there are " +
                   std::to_string(world.size()) + ", counted from 0");
        if (!is_finite(events[i].position))
            refuse("the place of its event of body " + body_text(world, body) + " is not finite");
    }
}

// What integrator and responses write where they may is looked at when they do.
void Pipeline::require_finite_world() const {
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        const char* const quantity = unusable_quantity(world.state(body));
        if (!quantity) continue;
        std::string plugins;
        for (const Rule& rule : rules)
            plugins += (plugins.empty() ? "" : "' or '") + std::string(rule.plugin->descriptor->name);
        fail("response", plugins, not_finite(world, quantity, body) + ", and it is in none of the contacts");
    }
}

void Pipeline::require_times(std::span<const Pair> some_pairs, double from, std::span<const double> times) const {
    for (std::size_t i = 0; i < times.size(); ++i)
        if (!(times[i] >= from))  // true for NaN
            fail("narrowphase", narrowphase_plugin->descriptor->name,
                 "its time of impact is " + std::to_string(times[i]) + " s, before the " + std::to_string(from) +
                     " s from which it was asked" + pair_blame(world, some_pairs[i].a, some_pairs[i].b));
}

// The answer for a pair does not depend on the others: the first that fails by itself is the one.
std::string Pipeline::blamed_pair(std::span<const Pair> some_pairs, std::span<const Detail> detail) const {
    Contacts found;
    for (std::size_t i = 0; i < some_pairs.size(); ++i)
        if (throws([&] { narrowphase->find_contacts({world, some_pairs.subspan(i, 1), detail.subspan(i, 1)}, found); }))
            return pair_blame(world, some_pairs[i].a, some_pairs[i].b);
    return "";
}

// Likewise for a contact; a response that fails only over several of them together stays without a pair.
std::string Pipeline::blamed_pair(const Rule& rule, double dt) const {
    World trial = world;
    std::vector<Event> no_events;
    ResponseOutput output{no_events};
    for (std::size_t i = 0; i < rule.contacts.size(); ++i) {
        Contact contact = rule.contacts[i];
        trial.set_state(contact.a, rule.before[2 * i]);
        trial.set_state(contact.b, rule.before[2 * i + 1]);
        if (throws([&] { rule.stage->respond({{&contact, 1}, {&rule.hit[i], 1}, dt}, trial, output); }))
            return pair_blame(world, contact.a, contact.b);
    }
    return "";
}

}  // namespace kolize
