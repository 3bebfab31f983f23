// Explode: a body that the rule is about ends its life in an explosion at the first thing it touches.
//
// Every dynamic body of a contact that fits the rule's `when` gives two events: an explosion where it touches, and its
// removal, carried out by the framework after the stage. A body with many contacts explodes once, at the first of them
// in canonical order. Where only the overlap is known the explosion is at the body's centre of mass. What was hit is
// not moved. A rule without `when` fits every body.
#include <kolize/plugin.h>

namespace {

using namespace kolize;

class Explode final : public Response {
public:
    void respond(const ResponseInput& input, World& world, ResponseOutput& output) override {
        exploded_.assign(world.size(), 0);
        for (std::size_t i = 0; i < input.contacts.size(); ++i) {
            const Contact& c = input.contacts[i];
            if (input.hit[i] & 1) explode(c.a, c.arm_a, world, output);
            if (input.hit[i] & 2) explode(c.b, c.arm_b, world, output);
        }
    }

private:
    void explode(std::uint32_t body, const Vec3& arm, const World& world, ResponseOutput& output) {
        if (world.is_static[body] || exploded_[body]) return;
        exploded_[body] = 1;
        const Vec3 place = world.position[body] + arm;  // the arm is zero where only the overlap is known
        output.events.push_back({EventKind::explosion, body, place});
        output.events.push_back({EventKind::removal, body, world.position[body]});
    }

    std::vector<std::uint8_t> exploded_;  // per body of the world, in this call
};

}  // namespace

KOLIZE_PLUGIN(Explode, .name = "explode", .summary = "bodies that fit the rule are removed in an explosion",
              .source = "behaviour of games; no physics in it", .cost = "One look at each contact.",
              .accuracy = "Exact as to who explodes; the place is as good as the narrowphase's contact point.",
              .choose = "For missiles: [[response]] plugin = \"explode\", when = { kind = \"missile\" }.",
              .capabilities = {.needs = Detail::overlap, .uses = Detail::overlap})
