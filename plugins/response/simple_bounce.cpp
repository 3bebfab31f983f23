// Simple bounce: bodies exchange momentum along the contact normal and do not turn.
//
// Off a static obstacle v' = v - (1 + e) (v.n) n. Two dynamic bodies exchange momentum along the line of centres, with
// their own masses; what is tangential is kept. Angular velocities stay as they are. Dynamic bodies are taken as their
// bounding spheres, for which this is exact. Contacts are answered in turn, pass by pass, until none approaches.
#include <kolize/plugin.h>

namespace {

using namespace kolize;

constexpr double relative_tolerance = 1e-12;  // approach below this share of the speeds at hand is rounding

bool is_approaching(const Contact& c, double allowed, const World& world) {
    const double speed = allowed + c.normal.dot(world.velocity[c.b] - world.velocity[c.a]);
    return speed < -relative_tolerance * (world.velocity[c.a].norm() + world.velocity[c.b].norm());
}

// Leaves the approach that is allowed, and of the rest what restitution sends back. Returns the kinetic energy lost, J.
double bounce(Contact& c, double restitution, double allowed, World& world) {
    const double speed = c.normal.dot(world.velocity[c.b] - world.velocity[c.a]);
    const double k = (world.inverse_mass[c.a] + world.inverse_mass[c.b]) * c.normal.squaredNorm();
    const double impulse = -((1 + restitution) * speed + allowed) / k;
    world.velocity[c.a] -= impulse * world.inverse_mass[c.a] * c.normal;
    world.velocity[c.b] += impulse * world.inverse_mass[c.b] * c.normal;
    c.impulse += impulse;
    return (1 - restitution * restitution) * speed * speed / (2 * k) - allowed * allowed / (2 * k);
}

class SimpleBounce final : public Response {
public:
    static void parameters(Parameters<SimpleBounce>& p) {
        p.add("max_passes", &SimpleBounce::max_passes_)
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
                const double restitution = input.settle > 0 ? 0 : world.restitution(c.a, c.b);
                output.dissipated_J += bounce(c, restitution, allowed, world);
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

KOLIZE_PLUGIN(SimpleBounce, .name = "simple_bounce",
              .summary = "smooth spheres: momentum along the normal, no rotation",
              .source =
                  "collision of smooth spheres: Goldstein, Poole, Safko, Classical Mechanics, 3.11; passes: "
                  "Guendelman, Bridson, Fedkiw, ACM TOG 22(3), 2003, 6",
              .cost = "A few dozen operations a contact and pass; one pass more than the longest chain of hits.",
              .accuracy =
                  "With restitution 1 kinetic energy, and momentum of a dynamic pair, are kept to rounding. Off-centre "
                  "hits of anything but a sphere are wrong: nothing turns.",
              .choose = "For balls, particles, and bodies whose rotation nobody looks at; impulse otherwise.",
              .capabilities = {.needs = Detail::normal, .uses = Detail::normal, .bounding_spheres = true})
