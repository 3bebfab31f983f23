// Responses: one heavy body and one light one with contacts between them, against the laws that every response claims.
#include "stability/study.h"

#include <kolize/response.h>

#include <algorithm>

namespace kolize::cli::stability {
namespace {

constexpr int rounds = 20;

enum { mass_ratio, conditioning, contacts, arm, loss };
enum class Output { energy, momentum, parting };

struct Impact {
    World world;
    std::vector<Contact> contacts;
};

void add_body(World& world, double mass, double thinness, const Vec3& position, const Vec3& velocity, Dice& dice) {
    BodyDescription body;
    body.mass = mass;
    body.position = position;
    body.orientation = dice.rotation();
    body.velocity = velocity;
    if (!velocity.isZero(0)) body.angular_velocity = dice.direction();
    const std::uint32_t id = world.add(body);
    // A rod's: of physical bodies only the smallest moment can be small alone.
    world.inverse_inertia[id] = Vec3(thinness, 1, 1.2) / (0.4 * mass);
}

// The light body comes down, turning, on the heavy one, which is at rest: all energy is the light one's. The contact
// points lie around the line between their centres.
Impact make(const Point& point, Dice& dice) {
    Impact made;
    World& world = made.world;
    world.materials.push_back({"material", 1 - value(point, loss), 0, 1000});
    world.shapes.push_back(make_box("box", Vec3::Ones()));
    add_body(world, value(point, mass_ratio), value(point, conditioning), -Vec3::UnitY(), Vec3::Zero(), dice);
    add_body(world, 1, value(point, conditioning), Vec3::UnitY(), Vec3(0.3, -3, 0.2), dice);
    const long count = std::lround(value(point, contacts));
    for (long i = 0; i < count; ++i) {
        Contact& c = made.contacts.emplace_back();
        c.b = 1;
        c.region = static_cast<std::uint32_t>(i);
        c.normal = (Vec3::UnitY() + 0.05 * dice.direction()).normalized();
        const Vec3 place = value(point, arm) * Vec3(dice.between(-1, 1), 0, dice.between(-1, 1));
        c.arm_a = place - world.position[0];
        c.arm_b = place - world.position[1];
    }
    return made;
}

double energy(const World& world) { return world.kinetic_energy(0) + world.kinetic_energy(1); }

Vec3 momentum(const World& world) {
    return world.velocity[0] / world.inverse_mass[0] + world.velocity[1] / world.inverse_mass[1];
}

// About the point between the two, where they were hit.
Vec3 angular_momentum(const World& world, const Impact& start) {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t body : {0u, 1u})
        sum += world.angular_momentum(body) +
               start.world.position[body].cross(world.velocity[body]) / world.inverse_mass[body];
    return sum;
}

double scale_of_momentum(const World& world) {
    return world.velocity[0].norm() / world.inverse_mass[0] + world.velocity[1].norm() / world.inverse_mass[1];
}

double scale_of_angular_momentum(const World& world, const Impact& start, double impulse_arm) {
    double sum = impulse_arm;
    for (const std::uint32_t body : {0u, 1u})
        sum += world.angular_momentum(body).norm() +
               start.world.position[body].norm() * world.velocity[body].norm() / world.inverse_mass[body];
    return sum;
}

Outcome judge_energy(const World& before, const World& after, double dissipated) {
    const double start = energy(before), lost = start - energy(after);
    if (lost < -1e-11 * start) return {Failure::wrong, "it makes " + number(-lost / start) + " of the energy anew"};
    if (!(std::abs(lost - dissipated) <= 1e-11 * start))
        return {Failure::inaccurate, "the energy that is lost and the one it tells differ by " +
                                         number(std::abs(lost - dissipated) / start) + " of the whole"};
    return {};
}

Outcome judge_momentum(const Impact& start, const World& after, const std::vector<Contact>& rows, bool turns) {
    const double off =
        (momentum(after) - momentum(start.world)).norm() / (scale_of_momentum(start.world) + scale_of_momentum(after));
    if (!(off <= 1e-12)) return {Failure::inaccurate, "momentum is off by " + number(off) + " of the whole"};
    if (!turns) return {};
    double impulse_arm = 0;
    for (const Contact& c : rows) impulse_arm += c.impulse * (c.arm_a.norm() + c.arm_b.norm());
    const double turn_off =
        (angular_momentum(after, start) - angular_momentum(start.world, start)).norm() /
        (scale_of_angular_momentum(start.world, start, impulse_arm) + scale_of_angular_momentum(after, start, 0));
    if (!(turn_off <= 1e-12))
        return {Failure::inaccurate, "angular momentum is off by " + number(turn_off) + " of the whole"};
    return {};
}

Outcome judge_parting(const Impact& start, const World& after, bool turns, std::uint64_t unresolved) {
    double fastest = 0, approach = 0;
    for (const Contact& c : start.contacts) {
        const auto relative = [&](const World& world) -> Vec3 {
            if (!turns) return world.velocity[1] - world.velocity[0];
            return world.velocity_at(1, c.arm_b) - world.velocity_at(0, c.arm_a);
        };
        fastest = std::max({fastest, relative(start.world).norm(), relative(after).norm()});
        approach = std::max(approach, -c.normal.dot(relative(after)));
    }
    if (approach <= 1e-9 * fastest) return {};
    const std::string what = "contacts still approach at " + number(approach / fastest) + " of the fastest speed";
    if (unresolved > 0)
        return {Failure::refused, what + ", and it tells " + std::to_string(unresolved) + " unresolved"};
    return {Failure::inaccurate, what};
}

Outcome probe(const Context& context, const Subject& subject, const Point& point, Output output) {
    const bool turns = !subject.plugin->descriptor->capabilities.bounding_spheres;
    Dice dice(context.seed);
    for (int round = 0; round < rounds; ++round) {
        const Impact start = make(point, dice);
        Impact after = start;
        const std::vector<std::uint8_t> hit(start.contacts.size(), 3);
        std::vector<Event> events;
        ResponseOutput told{events};
        const auto stage = context.plugins.make<Response>(subject.config, context.host);
        stage->respond({after.contacts, hit, 1.0 / 60}, after.world, told);
        for (const std::uint32_t body : {0u, 1u})
            if (!after.world.velocity[body].allFinite() || !after.world.angular_velocity[body].allFinite())
                return {Failure::not_finite, "a velocity is not finite"};
        after.world.orientation = start.world.orientation;  // parting what overlaps is no part of it
        const Outcome outcome = output == Output::energy ? judge_energy(start.world, after.world, told.dissipated_J)
                                : output == Output::momentum
                                    ? judge_momentum(start, after.world, after.contacts, turns)
                                    : judge_parting(start, after.world, turns, told.unresolved);
        if (!outcome.holds()) return outcome;
    }
    return {};
}

}  // namespace

std::vector<Study> response_studies(const Context& context, const std::vector<Subject>& subjects) {
    std::vector<Subject> asked;
    std::vector<std::string> left_out;
    for (const Subject& subject : subjects)
        if (subject.plugin->descriptor->capabilities.needs != Detail::overlap)
            asked.push_back(subject);
        else
            left_out.push_back(subject.name + ": it knows no normals, and so changes no motion by a law");
    const auto study = [&](const char* name, const char* question, Output output) {
        return Study{"response",
                     name,
                     std::string("A light body hits a heavy one, 20 times: ") + question,
                     {{"mass_ratio", "", "the heavy body over the light one", 0, 15, 0},
                      {"conditioning", "", "the largest moment of inertia over the smallest", 0, 12, 0},
                      {"contacts", "", "between the two", 0, 1.8, 0.6},
                      {"arm", "m", "of contacts from the line between the centres, 1 m away", -1, 6, -1},
                      {"loss", "", "1 less the restitution", 0, -16, -300}},
                     asked,
                     [context, output](const Subject& subject, const Point& point) {
                         return probe(context, subject, point, output);
                     },
                     left_out};
    };
    return {
        study("energy",
              "no energy is made, and what is lost is told, to 1e-11 of the whole. Oracle: the energies before and "
              "after.",
              Output::energy),
        study("momentum",
              "momentum, and where bodies turn angular momentum, stay to 1e-12 of the whole. Oracle: the sums before "
              "and after.",
              Output::momentum),
        study("parting",
              "no contact approaches afterwards by more than 1e-9 of the fastest, or it is told. Oracle: the "
              "velocities at the contacts.",
              Output::parting)};
}

}  // namespace kolize::cli::stability
