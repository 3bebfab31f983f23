#include <kolize/impact_rows.h>

#include <algorithm>

namespace kolize {

void ImpactRows::build(const ResponseInput& input, const World& world) {
    find_islands(input, world);
    rows_.clear();
    islands_.clear();
    std::uint32_t island = ImpactRow::fixed;
    for (const Member& member : members_) {
        ImpactRow row = make_row(input.contacts[member.contact], world);
        row.allowed = input.allowed_approach(*row.contact);
        if (!(row.k > 0)) continue;
        if (member.island != island) islands_.push_back({static_cast<std::uint32_t>(rows_.size()), 0});
        island = member.island;
        rows_.push_back(row);
        islands_.back().end = static_cast<std::uint32_t>(rows_.size());
    }
    list_rows_of_bodies();
    for (const Body& body : bodies_) number_[body.id] = ImpactRow::fixed;
}

// Once, for a crowd in which every body touches several others: later records cost no allocation.
void ImpactRows::reserve(std::size_t world_size) {
    number_.resize(world_size, ImpactRow::fixed);
    bodies_.reserve(world_size);
    islands_.reserve(world_size);
    first_of_body_.reserve(world_size + 1);
    members_.reserve(32 * world_size);
    rows_.reserve(32 * world_size);
    rows_of_body_.reserve(64 * world_size);
}

// Contacts are linked where they share a dynamic body: static ones pass nothing on.
void ImpactRows::find_islands(const ResponseInput& input, const World& world) {
    if (number_.size() < world.size()) reserve(world.size());
    bodies_.clear();
    members_.clear();
    for (Contact& c : input.contacts) {
        c.impulse = 0;
        const std::uint32_t a = moving(c.a, world), b = moving(c.b, world);
        if (a != ImpactRow::fixed && b != ImpactRow::fixed) unite(a, b);
    }
    for (std::uint32_t i = 0; i < input.contacts.size(); ++i) {
        const Contact& c = input.contacts[i];
        const std::uint32_t body = number_[world.is_static[c.a] ? c.b : c.a];
        if (body != ImpactRow::fixed) members_.push_back({root(body), i});
    }
    std::sort(members_.begin(), members_.end());
}

std::uint32_t ImpactRows::moving(std::uint32_t body, const World& world) {
    if (world.is_static[body]) return ImpactRow::fixed;
    if (number_[body] == ImpactRow::fixed) {
        number_[body] = moving_bodies();
        bodies_.push_back({body, number_[body], world.orientation[body].toRotationMatrix()});
    }
    return number_[body];
}

std::uint32_t ImpactRows::root(std::uint32_t moving) {
    while (bodies_[moving].parent != moving) moving = bodies_[moving].parent = bodies_[bodies_[moving].parent].parent;
    return moving;
}

// The smaller root wins: an island is named after its first body in canonical order.
void ImpactRows::unite(std::uint32_t a, std::uint32_t b) {
    const auto [first, second] = std::minmax({root(a), root(b)});
    bodies_[second].parent = first;
}

ImpactRow ImpactRows::make_row(Contact& c, const World& world) const {
    ImpactRow row;
    row.contact = &c;
    row.moving_a = number_[c.a];
    row.moving_b = number_[c.b];
    if (row.moving_a != ImpactRow::fixed) row.moment_a = c.arm_a.cross(c.normal);
    if (row.moving_b != ImpactRow::fixed) row.moment_b = c.arm_b.cross(c.normal);
    const double rotation = add_rotation(row.moving_a, world.inverse_inertia[c.a], row.moment_a, row.turn_a) +
                            add_rotation(row.moving_b, world.inverse_inertia[c.b], row.moment_b, row.turn_b);
    row.inverse_mass_a = world.inverse_mass[c.a];
    row.inverse_mass_b = world.inverse_mass[c.b];
    row.k = (row.inverse_mass_a + row.inverse_mass_b) * c.normal.squaredNorm() + rotation;
    row.restitution = world.restitution(c.a, c.b);
    return row;
}

// Along the principal axes k is a sum of squares. With the world's inertia, large and small moments mixed, rounding
// would grow with their ratio; so it does with its root only.
double ImpactRows::add_rotation(std::uint32_t moving, const Vec3& inverse_inertia, const Vec3& moment,
                                Vec3& turn) const {
    if (moving == ImpactRow::fixed) return 0;
    const Mat3& rotation = bodies_[moving].rotation;
    const Vec3 principal = rotation.transpose() * moment;
    const Vec3 principal_turn = inverse_inertia.cwiseProduct(principal);
    turn = rotation * principal_turn;
    return principal.dot(principal_turn);
}

void ImpactRows::list_rows_of_bodies() {
    first_of_body_.assign(bodies_.size() + 1, 0);
    for (const ImpactRow& row : rows_)
        for (const std::uint32_t body : {row.moving_a, row.moving_b})
            if (body != ImpactRow::fixed) ++first_of_body_[body];
    // Each entry becomes the end of its body's rows, and moves to their begin as they are put in from the last one on.
    for (std::size_t i = 1; i < first_of_body_.size(); ++i) first_of_body_[i] += first_of_body_[i - 1];
    rows_of_body_.resize(first_of_body_.back());
    for (std::size_t i = rows_.size(); i-- > 0;)
        for (const std::uint32_t body : {rows_[i].moving_a, rows_[i].moving_b})
            if (body != ImpactRow::fixed) rows_of_body_[--first_of_body_[body]] = static_cast<std::uint32_t>(i);
}

}  // namespace kolize
