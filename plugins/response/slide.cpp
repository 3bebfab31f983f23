// Slide: bodies lose the velocity with which they approach, and slide on along each other.
//
// Off a static obstacle v' = v - (v.n) n. Two dynamic bodies go on with a common velocity along the line of centres;
// what is tangential is kept, and nothing turns. The restitution of the materials has no part in it. Contacts are
// answered in turn, pass by pass, until none approaches: in a corner of two walls a body slides along both.
#include <kolize/plugin.h>

namespace {

using namespace kolize;

constexpr double relative_tolerance = 1e-12;  // approach below this share of the speeds at hand is rounding

double normal_velocity(const Contact& c, const World& world) {
    return c.normal.dot(world.velocity[c.b] - world.velocity[c.a]);
}

bool is_approaching(const Contact& c, double allowed, const World& world) {
    return normal_velocity(c, world) + allowed <
           -relative_tolerance * (world.velocity[c.a].norm() + world.velocity[c.b].norm());
}

// Leaves the approach that is allowed. Returns the kinetic energy lost, J.
double stop_approach(Contact& c, double allowed, World& world) {
    const double speed = normal_velocity(c, world);
    const double k = (world.inverse_mass[c.a] + world.inverse_mass[c.b]) * c.normal.squaredNorm();
    const double impulse = -(speed + allowed) / k;
    world.velocity[c.a] -= impulse * world.inverse_mass[c.a] * c.normal;
    world.velocity[c.b] += impulse * world.inverse_mass[c.b] * c.normal;
    c.impulse += impulse;
    return (speed * speed - allowed * allowed) / (2 * k);
}

class Slide final : public Response {
public:
    static void parameters(Parameters<Slide>& p) {
        p.add("max_passes", &Slide::max_passes_)
            .range(1, 1e6)
            .doc("Passes over all contacts after which those that still approach are left unresolved.");
    }

    void respond(const ResponseInput& input, World& world, ResponseOutput& output) override {
        for (Contact& c : input.contacts) c.impulse = 0;
        bool changed = true;
        for (int pass = 0; changed && pass < max_passes_; ++pass) {
            changed = false;
            for (Contact& c : input.contacts) {
                const double allowed = input.allowed_approach(c);
                if (!is_approaching(c, allowed, world)) continue;
                output.dissipated_J += stop_approach(c, allowed, world);
                changed = true;
            }
        }
        if (!changed) return;
        for (const Contact& c : input.contacts)
            output.unresolved += is_approaching(c, input.allowed_approach(c), world);
    }

private:
    int max_passes_ = 64;
};

}  // namespace

KOLIZE_PLUGIN(
    Slide, .name = "slide", .summary = "bodies lose the speed of approach and slide on, without rotation",
    .source = "plastic collision of smooth spheres: Goldstein, Poole, Safko, Classical Mechanics, 3.11",
    .cost =
        "A few dozen operations a contact and pass. Passes over contacts that push each other end when nothing "
        "approaches by more than rounding, or at max_passes.",
    .accuracy =
        "Tangential velocity, and momentum of a dynamic pair, are kept to rounding; the energy that is lost is "
        "told to rounding. Dynamic bodies are taken as their bounding spheres and never turn.",
    .choose =
        "For players, cameras and whatever glides along walls. Take simple_bounce for what bounces, solver for "
        "what has friction and turns.",
    .capabilities = {.needs = Detail::normal, .uses = Detail::normal, .bounding_spheres = true})
