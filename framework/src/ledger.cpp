#include "ledger.h"

#include <algorithm>
#include <cstring>

namespace kolize {
namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

// The first row in which two columns differ in any bit, or their size.
template <class T>
std::size_t first_difference(const std::vector<T>& a, const std::vector<T>& b) {
    if (std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()), a.size() * sizeof(T)) == 0)
        return a.size();
    std::size_t row = 0;
    while (std::memcmp(static_cast<const void*>(&a[row]), static_cast<const void*>(&b[row]), sizeof(T)) == 0) ++row;
    return row;
}

double distance(double a, double b) { return std::abs(a - b); }
double distance(const Vec3& a, const Vec3& b) { return (a - b).norm(); }
double distance(const Quat& a, const Quat& b) { return (a.coeffs() - b.coeffs()).norm(); }

}  // namespace

std::string body_text(const World& world, std::uint32_t body) {
    const std::string& name = world.name[body];
    return std::to_string(body) + (name.empty() ? "" : " '" + name + "'");
}

std::string to_string(const LedgerBreak& broken, const World& world) {
    std::string where;
    for (const std::uint32_t body : broken.bodies)
        where +=
            (where.empty() ? (broken.bodies.size() > 1 ? ", bodies " : ", body ") : " and ") + body_text(world, body);
    const bool is_depth = broken.quantity == "penetration";
    const std::string unit = broken.unit.empty() ? "" : " " + broken.unit;
    return "the ledger breaks at step " + std::to_string(broken.step) + " (" + number(broken.time) + " s), " +
           broken.stage + " '" + broken.plugin + "'" + where + ": " + broken.quantity +
           (is_depth ? " of " : " off by ") + number(broken.value) + unit + ", the limit is " + number(broken.limit) +
           unit;
}

Ledger::Ledger(const LedgerConfig& limits, const World& world) : limits_(limits), received_(world.size()) {
    involved_.reserve(world.size());
}

void Ledger::begin_step(std::uint64_t step, double time) {
    step_ = step;
    time_ = time;
}

void Ledger::record(const std::string& stage, const std::string& plugin, std::vector<std::uint32_t> bodies,
                    const std::string& quantity, const std::string& unit, const Balance& balance) {
    if (!break_)
        break_ = {step_, time_, stage, plugin, std::move(bodies), quantity, unit, std::abs(balance.off), balance.limit};
}

void Ledger::after_motion(const World& world, std::uint32_t body, const BodyState& before, const BodyState& after,
                          double time, const char* stage, const std::string& name) {
    if (break_) return;
    const MotionBalance balance = balance_of_motion(world, body, before, after, time, limits_);
    const auto check = [&](const Balance& entry, const char* quantity, const char* unit) {
        if (!entry.holds()) record(stage, name, {body}, quantity, unit, entry);
    };
    check(balance.energy, "energy", "J");
    check(balance.momentum, "momentum", "N s");
    check(balance.angular_momentum, "angular momentum", "N m s");
}

void Ledger::before_stage(const World& world) {
    if (break_) return;
    before_.position = world.position;  // assignment re-uses the buffers
    before_.velocity = world.velocity;
    before_.angular_velocity = world.angular_velocity;
    before_.inverse_inertia = world.inverse_inertia;
    before_.orientation = world.orientation;
    before_.inverse_mass = world.inverse_mass;
    before_.is_static = world.is_static;
    before_.removed = world.removed;
}

// What no stage may change: broadphase and narrowphase nothing at all, a response only velocities.
void Ledger::check_untouched(const World& world, const std::string& stage, const char* plugin) {
    const auto check = [&](const auto& then, const auto& now, const char* quantity, const char* unit) {
        const std::size_t row = first_difference(then, now);
        if (row < then.size())
            record(stage, plugin, {static_cast<std::uint32_t>(row)}, quantity, unit,
                   {distance(then[row], now[row]), 0});
    };
    check(before_.position, world.position, "position", "m");
    check(before_.orientation, world.orientation, "orientation", "");
    check(before_.inverse_mass, world.inverse_mass, "inverse mass", "1/kg");
    check(before_.inverse_inertia, world.inverse_inertia, "inverse inertia", "1/(kg m^2)");
    check(before_.is_static, world.is_static, "mark as static", "");
    check(before_.removed, world.removed, "mark as removed", "");
    if (stage == "response") return;
    check(before_.velocity, world.velocity, "velocity", "m/s");
    check(before_.angular_velocity, world.angular_velocity, "angular velocity", "rad/s");
}

void Ledger::after_search(const World& world, StageKind stage, const char* plugin) {
    if (!break_) check_untouched(world, to_string(stage), plugin);
}

void Ledger::check_depths(std::span<const Contact> contacts, const char* narrowphase) {
    if (break_) return;
    for (const Contact& c : contacts)
        if (const Balance depth{c.depth, limits_.penetration}; !depth.holds())
            record("narrowphase", narrowphase, {c.a, c.b}, "penetration", "m", depth);
}

void Ledger::after_response(const World& world, std::span<const Contact> contacts, double dissipated_J, bool settling,
                            const char* plugin) {
    if (break_) return;
    check_untouched(world, "response", plugin);
    book(world, contacts);
    check_rest(world, plugin);
    check_energy(world, contacts, dissipated_J, settling, plugin);
    for (const std::uint32_t body : involved_) check_momenta(world, contacts, body, plugin);
}

BodyState Ledger::state_before(const World& world, std::uint32_t body) const {
    return {world.position[body], world.orientation[body], before_.velocity[body], before_.angular_velocity[body]};
}

// Sums what the contacts say that each body got, and links the bodies that pass it on: static ones do not.
void Ledger::book(const World& world, std::span<const Contact> contacts) {
    for (std::uint32_t body = 0; body < received_.size(); ++body) {
        received_[body] = {};
        received_[body].parent = body;
    }
    involved_.clear();
    for (const Contact& c : contacts) {
        const auto add = [&](std::uint32_t body, const Vec3& arm, double sign) {
            if (world.is_static[body]) return;
            Received& received = received_[body];
            if (!received.in_contact) involved_.push_back(body);
            received.in_contact = true;
            const Vec3 impulse = sign * c.total_impulse();
            received.impulse += impulse;
            received.moment += arm.cross(impulse) + sign * c.couple;
            received.impulses += impulse.norm();
            received.moments += arm.norm() * impulse.norm() + c.couple.norm();
        };
        add(c.a, c.arm_a, -1);
        add(c.b, c.arm_b, 1);
        if (!world.is_static[c.a] && !world.is_static[c.b]) link(c);
    }
    std::sort(involved_.begin(), involved_.end());
}

void Ledger::link(const Contact& c) {
    const auto [first, second] = std::minmax({root(c.a), root(c.b)});
    received_[second].parent = first;
}

std::uint32_t Ledger::root(std::uint32_t body) {
    while (received_[body].parent != body) body = received_[body].parent = received_[received_[body].parent].parent;
    return body;
}

// A body that is static or in none of the contacts keeps its velocities.
void Ledger::check_rest(const World& world, const char* plugin) {
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        if (received_[body].in_contact) continue;
        const Balance speed{distance(world.velocity[body], before_.velocity[body]), 0};
        const Balance spin{distance(world.angular_velocity[body], before_.angular_velocity[body]), 0};
        if (!speed.holds()) record("response", plugin, {body}, "velocity", "m/s", speed);
        if (!spin.holds()) record("response", plugin, {body}, "angular velocity", "rad/s", spin);
    }
}

namespace {

// The pair of the contact with the largest impulse among those that `wanted` takes; of equal ones the first.
template <class Wanted>
std::vector<std::uint32_t> main_pair(std::span<const Contact> contacts, Wanted&& wanted) {
    const Contact* main = nullptr;
    for (const Contact& c : contacts)
        if (wanted(c) && (!main || std::abs(c.impulse) > std::abs(main->impulse))) main = &c;
    return main ? std::vector{main->a, main->b} : std::vector<std::uint32_t>{};
}

}  // namespace

void Ledger::check_momenta(const World& world, std::span<const Contact> contacts, std::uint32_t body,
                           const char* plugin) {
    const Received& got = received_[body];
    const BodyState before = state_before(world, body), after = world.state(body);
    const double mass = 1 / world.inverse_mass[body];
    const Vec3 first = mass * before.velocity, last = mass * after.velocity;
    const Balance momentum{(last - first - got.impulse).norm(),
                           limits_.momentum * (first.norm() + last.norm() + got.impulses)};
    const Vec3 change = world.angular_momentum(body, after) - world.angular_momentum(body, before);
    const double scale = angular_scale(world, body, before) + angular_scale(world, body, after) + got.moments;
    const Balance angular{(change - got.moment).norm(), limits_.angular_momentum * scale};
    const auto check = [&](const Balance& entry, const char* quantity, const char* unit) {
        if (entry.holds()) return;
        const auto pair = main_pair(contacts, [&](const Contact& c) { return c.a == body || c.b == body; });
        record("response", plugin, pair, quantity, unit, entry);
    };
    check(momentum, "momentum", "N s");
    check(angular, "angular momentum", "N m s");
}

// The sum over all bodies has to fit what the response reports; the pair is looked for among the linked bodies whose
// energy changed most.
void Ledger::check_energy(const World& world, std::span<const Contact> contacts, double dissipated_J, bool settling,
                          const char* plugin) {
    double change = 0, limit = 0;
    for (const std::uint32_t body : involved_) {
        const BodyState before = state_before(world, body), after = world.state(body);
        const double first = world.kinetic_energy(body, before), last = world.kinetic_energy(body, after);
        change += last - first;
        limit += limits_.energy * (first + last) + energy_rounding(world, body, before) +
                 energy_rounding(world, body, after);
        received_[root(body)].gained_J += last - first;
    }
    const Balance negative{settling ? 0 : std::min(dissipated_J, 0.0), limit}, total{change + dissipated_J, limit};
    if (negative.holds() && total.holds()) return;
    const auto most = std::max_element(involved_.begin(), involved_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::abs(received_[a].gained_J) < std::abs(received_[b].gained_J);
    });
    const auto is_linked = [&](const Contact& c) {
        return most != involved_.end() && root(world.is_static[c.a] ? c.b : c.a) == root(*most);
    };
    record("response", plugin, main_pair(contacts, is_linked), "energy", "J", total.holds() ? negative : total);
}

}  // namespace kolize
