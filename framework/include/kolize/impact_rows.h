// The equations of frictionless impacts, for responses that give impulses along contact normals: every contact is a row
// over the velocities of its two bodies, and rows that share moving bodies stand together in islands.
//
// With u the velocities of A and B, a row is J = (-n, -r_a x n, n, r_b x n): J u is the normal velocity of the contact,
// negative where the bodies approach, and an impulse p changes u by p M^-1 J^T. Kinetic energy is kept whatever the
// points, normals and inertia, because k = J M^-1 J^T and the change of u come from the same M^-1: Mirtich,
// "Impulse-based dynamic simulation of rigid body systems", 1996, 3.2. The arithmetic is symmetric in A and B to the
// last bit: a row says the same when the two bodies change names.
#pragma once

#include <kolize/response.h>

namespace kolize {

struct ImpactRow {
    static constexpr std::uint32_t fixed = ~0u;

    Contact* contact = nullptr;
    std::uint32_t moving_a = fixed;  // number of the body among those that the contacts move; `fixed` if it is static
    std::uint32_t moving_b = fixed;
    Vec3 moment_a = Vec3::Zero();  // arm x normal, m; zero for a static body
    Vec3 moment_b = Vec3::Zero();
    Vec3 turn_a = Vec3::Zero();  // change of angular velocity per unit impulse, 1/(kg m)
    Vec3 turn_b = Vec3::Zero();
    double inverse_mass_a = 0;  // 1/kg
    double inverse_mass_b = 0;
    double k = 0;            // normal velocity per unit impulse, 1/kg; > 0
    double restitution = 1;  // of the two materials
    double allowed = 0;      // approach that the contact may keep, m/s: see ResponseInput::allowed_approach

    bool moves(std::uint32_t body) const { return body == moving_a || body == moving_b; }
    // J u, m/s.
    double normal_velocity(const World& world) const {
        const std::uint32_t a = contact->a, b = contact->b;
        return contact->normal.dot(world.velocity[b] - world.velocity[a]) +
               (moment_b.dot(world.angular_velocity[b]) - moment_a.dot(world.angular_velocity[a]));
    }
    // The speeds that the normal velocity is a difference of, m/s: what its rounding is measured by.
    double speed_scale(const World& world) const {
        const Contact& c = *contact;
        return (world.velocity[c.a].norm() + world.angular_velocity[c.a].norm() * c.arm_a.norm()) +
               (world.velocity[c.b].norm() + world.angular_velocity[c.b].norm() * c.arm_b.norm());
    }
    // Gives the impulse, N s, to both bodies and adds it to the contact's.
    void push(double impulse, World& world) const {
        Contact& c = *contact;
        world.velocity[c.a] -= impulse * inverse_mass_a * c.normal;
        world.velocity[c.b] += impulse * inverse_mass_b * c.normal;
        world.angular_velocity[c.a] -= impulse * turn_a;
        world.angular_velocity[c.b] += impulse * turn_b;
        c.impulse += impulse;
    }
};

// All contacts of one call. Made again for every call; keeps its memory.
class KOLIZE_API ImpactRows {
public:
    struct Island {
        std::uint32_t begin = 0;  // into rows()
        std::uint32_t end = 0;
    };

    // Sets the impulses of all contacts to 0. The rows point into the input and are good as long as it is.
    void build(const ResponseInput& input, const World& world);

    // Islands in the order of their first contact; the rows of an island in canonical order. Contacts of two static
    // bodies, or of two whose inverse mass along the contact is 0, have no row.
    std::span<const ImpactRow> rows() const { return rows_; }
    std::span<const Island> islands() const { return islands_; }
    std::uint32_t moving_bodies() const { return static_cast<std::uint32_t>(bodies_.size()); }
    // Indices of the rows that the moving body has a part in, ascending; none for ImpactRow::fixed.
    std::span<const std::uint32_t> rows_of(std::uint32_t moving) const {
        if (moving == ImpactRow::fixed) return {};
        return {rows_of_body_.data() + first_of_body_[moving], rows_of_body_.data() + first_of_body_[moving + 1]};
    }

private:
    struct Body {
        std::uint32_t id = 0;      // in the world
        std::uint32_t parent = 0;  // union-find forest of the islands, by number among the moving bodies
        Mat3 rotation;             // body frame to world
    };
    struct Member {
        std::uint32_t island = 0;
        std::uint32_t contact = 0;
        friend auto operator<=>(const Member&, const Member&) = default;
    };

    void reserve(std::size_t world_size);
    void find_islands(const ResponseInput& input, const World& world);
    std::uint32_t moving(std::uint32_t body, const World& world);
    std::uint32_t root(std::uint32_t moving);
    void unite(std::uint32_t a, std::uint32_t b);
    ImpactRow make_row(Contact& contact, const World& world) const;
    double add_rotation(std::uint32_t moving, const Vec3& inverse_inertia, const Vec3& moment, Vec3& turn) const;
    void list_rows_of_bodies();

    std::vector<std::uint32_t> number_;  // per body of the world: its place in bodies_, or `fixed`
    std::vector<Body> bodies_;
    std::vector<Member> members_;  // sorted: the contacts of an island side by side
    std::vector<ImpactRow> rows_;
    std::vector<Island> islands_;
    std::vector<std::uint32_t> first_of_body_;  // into rows_of_body_; one more than bodies
    std::vector<std::uint32_t> rows_of_body_;
};

}  // namespace kolize
