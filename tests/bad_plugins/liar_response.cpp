// Bounces bodies off each other as smooth spheres do, with one thing wrong that its parameter names.
#include <kolize/plugin.h>

#include <stdexcept>

namespace {

using namespace kolize;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class Liar final : public Response {
public:
    static void parameters(Parameters<Liar>& p) {
        p.add("lie", &Liar::lie_)
            .choices({"none", "gain", "loss", "credit", "silence", "spin", "shift", "bystander", "nan_velocity",
                      "nan_bystander", "nan_impulse", "nan_energy", "throw", "far_event"})
            .doc("What is wrong.");
    }

    void respond(const ResponseInput& input, World& world, ResponseOutput& output) override {
        for (Contact& c : input.contacts) {
            const double speed = c.normal.dot(world.velocity[c.b] - world.velocity[c.a]);
            if (speed < 0) bounce(c, speed, world, output);
        }
    }

private:
    void bounce(Contact& c, double speed, World& world, ResponseOutput& output) {
        const double mass = 1 / (world.inverse_mass[c.a] + world.inverse_mass[c.b]);
        const double restitution = lie_ == "gain" ? 1.5 : lie_ == "loss" ? 0.5 : 1;
        const double impulse = -(1 + restitution) * speed * mass;
        world.velocity[c.a] -= impulse * world.inverse_mass[c.a] * c.normal;
        world.velocity[c.b] += impulse * world.inverse_mass[c.b] * c.normal;
        c.impulse = lie_ == "silence" ? 0 : impulse;
        lie(c, world, output);
    }

    // About the dynamic body of the contact, which stands first in the tests' scenes.
    void lie(Contact& c, World& world, ResponseOutput& output) const {
        const auto last = static_cast<std::uint32_t>(world.size() - 1);
        if (lie_ == "credit") output.dissipated_J -= 3;
        if (lie_ == "spin") world.angular_velocity[c.a] = -world.angular_velocity[c.a];
        if (lie_ == "shift") world.position[c.a] -= 0.25 * c.normal;
        if (lie_ == "bystander") world.velocity[last] += Vec3(0, 0.5, 0);
        if (lie_ == "nan_velocity") world.velocity[c.a].y() = nan;
        if (lie_ == "nan_bystander") world.angular_velocity[last].z() = nan;
        if (lie_ == "nan_impulse") c.impulse = nan;
        if (lie_ == "nan_energy") output.dissipated_J = nan;
        if (lie_ == "throw" && c.b == 1) throw std::runtime_error("no luck today");
        if (lie_ == "far_event") output.events.push_back({EventKind::removal, last + 1, Vec3::Zero()});
    }

    std::string lie_ = "none";
};

}  // namespace

KOLIZE_PLUGIN(Liar, .name = "liar", .summary = "a bounce with one thing wrong", .source = "none",
              .capabilities = {.needs = Detail::normal, .uses = Detail::normal})
