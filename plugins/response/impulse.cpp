// Impulse response: rigid bodies bounce off each other and turn, without friction.
//
// What     A contact that approaches gets the impulse that sends its normal velocity back, times the restitution, with
//          the full inertia of both bodies. Contacts that share bodies are answered by sequential reflection: the one
//          that approaches fastest is reflected, again and again, until none approaches. They are answered one by one
//          and never averaged: a body that touches at several places cannot be let in at one of them.
// Source   One contact: Mirtich, "Impulse-based dynamic simulation of rigid body systems", 1996, 3.2; Hecker, "Physics,
//          part 3: collision response", 1997. Many: Vouga, Smith, Kaufman, Tamstorf, Grinspun, "All's well that ends
//          well: guaranteed resolution of simultaneous rigid body impact", ACM TOG 36(4), 2017 (it ends after finitely
//          many reflections if the bodies can part at all).
// Cost     Per impulse one scan over the speeds of its island (the contacts linked through moving bodies). A handful of
//          impulses an island is usual.
// Accuracy With restitution 1 kinetic energy is kept to rounding, whatever the contact points, normals and inertia,
//          because the impulse and the velocity change use the same inverse mass matrix. Momentum and angular momentum
//          of a pair of dynamic bodies always are. Where several outcomes are lawful (one ball hits two at once) the
//          order of reflections decides. Below restitution 1 many contacts converge geometrically, and may be left
//          unresolved.
// Choose   for bodies whose rotation matters. For balls that only bounce, simple_bounce is cheaper.
#include <kolize/plugin.h>

#include <algorithm>

namespace {

using namespace kolize;

constexpr std::uint32_t none = ~0u;
constexpr double relative_tolerance = 1e-12;  // approach below this share of the speeds at hand is rounding

// A dynamic body that has a contact in this call.
struct Body {
    std::uint32_t id = 0;      // in the world
    std::uint32_t parent = 0;  // union-find forest of the islands, by index into bodies_
    Mat3 inverse_inertia;      // world axes; the one that both K and the velocity change are made from
};

// A contact as the rows J of the constraint and M^-1 J^T of the velocity change.
struct Row {
    Contact* contact = nullptr;
    Vec3 moment_a = Vec3::Zero();  // arm x normal
    Vec3 moment_b = Vec3::Zero();
    Vec3 turn_a = Vec3::Zero();  // change of angular velocity per unit impulse
    Vec3 turn_b = Vec3::Zero();
    double k = 0;  // J M^-1 J^T: normal velocity per unit impulse, 1/kg
    double restitution = 1;
};

struct IslandMember {
    std::uint32_t island = 0;
    std::uint32_t contact = 0;
    friend auto operator<=>(const IslandMember&, const IslandMember&) = default;
};

double approach_speed(const Row& row, const World& world) {
    const Contact& c = *row.contact;
    return c.normal.dot(world.velocity[c.b] - world.velocity[c.a]) + row.moment_b.dot(world.angular_velocity[c.b]) -
           row.moment_a.dot(world.angular_velocity[c.a]);
}

// The speeds that the approach speed is a difference of.
double speed_scale(const Contact& c, const World& world) {
    return world.velocity[c.a].norm() + world.angular_velocity[c.a].norm() * c.arm_a.norm() +
           world.velocity[c.b].norm() + world.angular_velocity[c.b].norm() * c.arm_b.norm();
}

// Sends the row's normal velocity back; returns the kinetic energy lost, J.
double reflect(Row& row, double speed, World& world) {
    Contact& c = *row.contact;
    const double impulse = -(1 + row.restitution) * speed / row.k;
    world.velocity[c.a] -= impulse * world.inverse_mass[c.a] * c.normal;
    world.velocity[c.b] += impulse * world.inverse_mass[c.b] * c.normal;
    world.angular_velocity[c.a] -= impulse * row.turn_a;
    world.angular_velocity[c.b] += impulse * row.turn_b;
    c.impulse += impulse;
    return (1 - row.restitution * row.restitution) * speed * speed / (2 * row.k);
}

bool share_dynamic_body(const Contact& c, const Contact& d, const World& world) {
    const auto touches_d = [&](std::uint32_t body) { return !world.is_static[body] && (body == d.a || body == d.b); };
    return touches_d(c.a) || touches_d(c.b);
}

class Impulse final : public Response {
public:
    static void parameters(Parameters<Impulse>& p) {
        p.add("max_impulses", &Impulse::max_impulses_)
            .range(1, 1e6)
            .doc("Impulses per contact after which the rest of an island is left unresolved.");
    }

    void respond(const ResponseInput& input, World& world, ResponseOutput& output) override {
        find_islands(input, world);
        build_rows(input, world);
        for (std::size_t begin = 0, end = 0; begin < members_.size(); begin = end) {
            while (end < members_.size() && members_[end].island == members_[begin].island) ++end;
            resolve_island(begin, end, world, output);
        }
        for (const Body& body : bodies_) slot_[body.id] = none;
    }

private:
    // Contacts are linked where they share a dynamic body: static ones pass nothing on.
    void find_islands(const ResponseInput& input, const World& world) {
        if (slot_.size() < world.size()) reserve(world.size());
        bodies_.clear();
        members_.clear();
        for (const Contact& c : input.contacts) unite(slot_of(c.a, world), slot_of(c.b, world));
        for (std::uint32_t i = 0; i < input.contacts.size(); ++i) {
            const Contact& c = input.contacts[i];
            const std::uint32_t slot = slot_of(world.is_static[c.a] ? c.b : c.a, world);
            if (slot != none) members_.push_back({root(slot), i});
        }
        std::sort(members_.begin(), members_.end());
    }

    // Once, for a crowd in which every body touches several others: later records cost no allocation.
    void reserve(std::size_t world_size) {
        slot_.resize(world_size, none);
        bodies_.reserve(world_size);
        members_.reserve(32 * world_size);
        rows_.reserve(32 * world_size);
        speeds_.reserve(32 * world_size);
    }

    std::uint32_t slot_of(std::uint32_t body, const World& world) {
        if (world.is_static[body]) return none;
        if (slot_[body] == none) {
            slot_[body] = static_cast<std::uint32_t>(bodies_.size());
            bodies_.push_back({body, slot_[body], world.world_inverse_inertia(body)});
        }
        return slot_[body];
    }

    std::uint32_t root(std::uint32_t slot) {
        while (bodies_[slot].parent != slot) slot = bodies_[slot].parent = bodies_[bodies_[slot].parent].parent;
        return slot;
    }

    // The smaller root wins: an island is named after its first body in canonical order.
    void unite(std::uint32_t a, std::uint32_t b) {
        if (a == none || b == none) return;
        const auto [first, second] = std::minmax({root(a), root(b)});
        bodies_[second].parent = first;
    }

    void build_rows(const ResponseInput& input, const World& world) {
        rows_.clear();
        for (const IslandMember& member : members_) {
            Contact& c = input.contacts[member.contact];
            c.impulse = 0;
            Row& row = rows_.emplace_back();
            row.contact = &c;
            row.k = (world.inverse_mass[c.a] + world.inverse_mass[c.b]) * c.normal.squaredNorm();
            row.k += add_rotation(c.a, c.arm_a, c.normal, row.moment_a, row.turn_a);
            row.k += add_rotation(c.b, c.arm_b, c.normal, row.moment_b, row.turn_b);
            row.restitution = world.restitution(c.a, c.b);
        }
    }

    double add_rotation(std::uint32_t body, const Vec3& arm, const Vec3& normal, Vec3& moment, Vec3& turn) const {
        if (slot_[body] == none) return 0;
        moment = arm.cross(normal);
        turn = bodies_[slot_[body]].inverse_inertia * moment;
        return moment.dot(turn);
    }

    void resolve_island(std::size_t begin, std::size_t end, World& world, ResponseOutput& output) {
        speeds_.clear();
        double scale = 0;
        for (std::size_t i = begin; i < end; ++i) {
            speeds_.push_back(approach_speed(rows_[i], world));
            scale = std::max(scale, speed_scale(*rows_[i].contact, world));
        }
        const double limit = -relative_tolerance * scale;
        for (std::size_t left = static_cast<std::size_t>(max_impulses_) * (end - begin); left > 0; --left) {
            const auto fastest = std::min_element(speeds_.begin(), speeds_.end());
            if (!(*fastest < limit)) return;
            Row& hit = rows_[begin + (fastest - speeds_.begin())];
            output.dissipated_J += reflect(hit, *fastest, world);
            for (std::size_t i = begin; i < end; ++i)
                if (share_dynamic_body(*rows_[i].contact, *hit.contact, world))
                    speeds_[i - begin] = approach_speed(rows_[i], world);
        }
        output.unresolved += std::count_if(speeds_.begin(), speeds_.end(), [&](double s) { return s < limit; });
    }

    int max_impulses_ = 64;

    std::vector<std::uint32_t> slot_;  // per body of the world: its place in bodies_, or none
    std::vector<Body> bodies_;
    std::vector<IslandMember> members_;  // sorted: the contacts of an island side by side, in canonical order
    std::vector<Row> rows_;              // as members_
    std::vector<double> speeds_;         // of one island's rows, m/s; negative where the bodies approach
};

}  // namespace

KOLIZE_PLUGIN(Impulse, .name = "impulse", .summary = "rigid bodies bounce and turn: frictionless impulses, one by one",
              .source = "Mirtich 1996, 3.2; Vouga et al. 2017, sequential reflection",
              .capabilities = {.needs = Detail::normal, .uses = Detail::manifold})
