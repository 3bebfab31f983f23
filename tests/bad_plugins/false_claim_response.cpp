// Bounces bodies off each other as smooth spheres do; its descriptor claims what it does not keep, or it does what its
// descriptor does not say. CLAIM says what.
#include <kolize/plugin.h>

namespace {

using namespace kolize;

enum class Claim {
    friction,
    moves,
    rests,
    sleeps,
    no_friction,
    no_moves,
    no_sleeps,
    no_allocations,
    uses,
    symmetry,
    any_mass,
    any_speed
};
constexpr Claim claim = Claim::CLAIM;

class Liar final : public Response {
public:
    void respond(const ResponseInput& input, World& world, ResponseOutput& output) override {
        if (claim == Claim::no_allocations) wasted_ = std::make_unique<int>(1);
        for (Contact& c : input.contacts) {
            const double speed = c.normal.dot(world.velocity[c.b] - world.velocity[c.a]);
            if (speed < 0) bounce(c, speed, world, output);
        }
    }

private:
    void bounce(Contact& c, double speed, World& world, ResponseOutput& output) {
        const double before = world.kinetic_energy(c.a) + world.kinetic_energy(c.b);
        c.impulse = -(1 + world.restitution(c.a, c.b)) * speed / (world.inverse_mass[c.a] + world.inverse_mass[c.b]);
        if (claim == Claim::any_mass && c.impulse < 1e-6) c.impulse = 0;
        if (claim == Claim::any_speed && world.velocity[c.b].norm() > 4) c.impulse *= 0.9;
        push(c.a, -c.impulse * c.normal, world);
        push(c.b, c.impulse * c.normal, world);
        if (!world.is_static[c.b]) spoil(c.b, world);
        output.dissipated_J += before - world.kinetic_energy(c.a) - world.kinetic_energy(c.b);
    }

    static void push(std::uint32_t body, const Vec3& impulse, World& world) {
        world.velocity[body] += world.inverse_mass[body] * impulse;
    }

    static void spoil(std::uint32_t body, World& world) {
        if (claim == Claim::no_friction) world.angular_velocity[body] *= 1 - world.materials[0].friction;
        if (claim == Claim::no_moves) world.position[body].y() += 0.01;
        if (claim == Claim::no_sleeps) world.asleep[body] = 1;
        if (claim == Claim::symmetry) world.angular_velocity[body] += 0.1 * world.velocity[body];
    }

    std::unique_ptr<int> wasted_;
};

}  // namespace

KOLIZE_PLUGIN(Liar, .name = CLAIM_NAME, .summary = "claims what it does not keep", .source = "none",
              .capabilities = {.needs = Detail::normal,
                               .uses = claim == Claim::uses ? Detail::overlap : Detail::normal,
                               .moves = claim == Claim::moves,
                               .rests = claim == Claim::rests,
                               .sleeps = claim == Claim::sleeps,
                               .friction = claim == Claim::friction,
                               .bounding_spheres = true})
