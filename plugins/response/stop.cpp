// Stop: what touches halts, as if it were glued together for a moment.
//
// A body that runs into a static obstacle stands still afterwards: no velocity, no spin. Two dynamic bodies go on as
// one rigid body would, with their momentum and angular momentum. Bodies that do not approach are left alone, so that
// whatever pushes a body off again can do so. Contacts are answered in turn, pass by pass, until none approaches. The
// restitution of the materials has no part in it.
//
// Gluing asks for an impulse J at the contact and a couple C that leave no relative velocity there and no relative
// spin: six linear equations. Dynamic bodies are taken as their bounding spheres, whose contacts lie on the line of
// centres; J then pushes along the normal as much as the approach asks for, whatever the spins are.
#include <kolize/plugin.h>

#include <Eigen/Cholesky>

namespace {

using namespace kolize;

constexpr double relative_tolerance = 1e-12;  // approach below this share of the speeds at hand is rounding

Mat3 cross_matrix(const Vec3& v) {
    Mat3 m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

// Of a body at a contact: how impulse and couple there become velocities.
struct Side {
    double inverse_mass;
    Mat3 inverse_inertia;  // world axes
    Mat3 arm;              // cross matrix of the arm along the normal

    Side(const World& world, std::uint32_t body, double reach, const Vec3& normal)
        : inverse_mass(world.inverse_mass[body]),
          inverse_inertia(world.world_inverse_inertia(body)),
          arm(cross_matrix(reach * normal)) {}
};

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

double normal_velocity(const Contact& c, const World& world) {
    return c.normal.dot(world.velocity[c.b] - world.velocity[c.a]);
}

bool is_approaching(const Contact& c, double allowed, const World& world) {
    return normal_velocity(c, world) + allowed <
           -relative_tolerance * (world.velocity[c.a].norm() + world.velocity[c.b].norm());
}

double kinetic_energy(const Contact& c, const World& world) {
    return world.kinetic_energy(c.a) + world.kinetic_energy(c.b);
}

// Leaves the approach that is allowed, and nothing else of the relative motion. Returns the kinetic energy lost, J.
double glue(Contact& c, double allowed, World& world) {
    const double before = kinetic_energy(c, world);
    const Side a(world, c.a, c.normal.dot(c.arm_a), c.normal), b(world, c.b, c.normal.dot(c.arm_b), c.normal);
    // (relative velocity, relative spin) = K (J, C): the arms turn J into a moment and spin into velocity.
    Mat6 k = Mat6::Zero();
    Vec6 unwanted;
    unwanted << world.velocity[c.b] - world.velocity[c.a] - b.arm * world.angular_velocity[c.b] +
                    a.arm * world.angular_velocity[c.a] + allowed * c.normal,
        world.angular_velocity[c.b] - world.angular_velocity[c.a];
    for (const Side* side : {&a, &b}) {
        k.topLeftCorner<3, 3>() +=
            side->inverse_mass * Mat3::Identity() - side->arm * side->inverse_inertia * side->arm;
        k.topRightCorner<3, 3>() -= side->arm * side->inverse_inertia;
        k.bottomLeftCorner<3, 3>() += side->inverse_inertia * side->arm;
        k.bottomRightCorner<3, 3>() += side->inverse_inertia;
    }
    const Vec6 glued = k.ldlt().solve(-unwanted);
    const Vec3 impulse = glued.head<3>(), couple = glued.tail<3>();
    world.velocity[c.a] -= a.inverse_mass * impulse;
    world.velocity[c.b] += b.inverse_mass * impulse;
    world.angular_velocity[c.a] -= a.inverse_inertia * (a.arm * impulse + couple);
    world.angular_velocity[c.b] += b.inverse_inertia * (b.arm * impulse + couple);
    const double push = c.normal.dot(impulse) / c.normal.squaredNorm();
    c.impulse += push;
    c.friction += impulse - push * c.normal;
    // The arms of the contact are what the couple is told to: of spheres they are the same.
    c.couple += couple;
    return before - kinetic_energy(c, world);
}

class Stop final : public Response {
public:
    static void parameters(Parameters<Stop>& p) {
        p.add("max_passes", &Stop::max_passes_)
            .range(1, 1e6)
            .doc("Passes over all contacts after which those that still approach are left unresolved.");
    }

    void respond(const ResponseInput& input, World& world, ResponseOutput& output) override {
        for (Contact& c : input.contacts) {
            c.impulse = 0;
            c.friction = c.couple = Vec3::Zero();
        }
        bool changed = true;
        for (int pass = 0; changed && pass < max_passes_; ++pass) {
            changed = false;
            for (Contact& c : input.contacts) {
                const double allowed = input.allowed_approach(c);
                if (!is_approaching(c, allowed, world)) continue;
                output.dissipated_J += glue(c, allowed, world);
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
    Stop, .name = "stop", .summary = "bodies that hit something halt: plastic impact that keeps nothing of the motion",
    .source = "perfectly plastic impact with sticking: Stronge, Impact Mechanics (2000), 3.5",
    .cost =
        "A linear system of six equations a contact that approaches, and pass. Passes over contacts that push each "
        "other end when nothing approaches by more than rounding, or at max_passes.",
    .accuracy =
        "A body that hits a static obstacle stands still to rounding. Momentum and angular momentum of a dynamic "
        "pair are kept to rounding, and the energy that is lost is told. Bodies are taken as bounding spheres.",
    .choose =
        "For what shall stick where it hits: darts, cameras, doors. Take slide for what goes on along the "
        "obstacle, solver for what comes to rest by friction.",
    .capabilities = {.needs = Detail::normal, .uses = Detail::normal, .bounding_spheres = true})
