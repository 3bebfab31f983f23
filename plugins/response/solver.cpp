// Solver: resting contact with Coulomb friction and restitution, all contacts of a step together.
//
// Every contact gets an impulse along its normal, lambda >= 0, that leaves no approach (or sends an impact back by the
// restitution), and one across it within the friction cone, |friction| <= mu lambda, that leaves no slip. Islands
// (contacts that are linked through moving bodies) are answered apart, each in one of two ways:
//   sequential  projected Gauss-Seidel, contact by contact
//   direct      the normal impulses of the island from its linear complementarity problem, in turns with Gauss-Seidel
//               for friction: knows no bad mass ratios
// Both begin with the impulses of the last step: a contact is recognised by its place on body A.
//
// The framework moves bodies first and looks for contacts then, so what rests has fallen for one step when it comes
// here. Where an island only rests, its impulses are taken to have acted all along the step, and positions follow: a
// pile at rest stays where it is to rounding. Contacts are let in to the depth `slop`, where they are found again in
// the next step; of what is deeper a share goes in every step, without making velocity. At a time of impact, where
// nothing overlaps, only velocities change.
//
// An island whose bodies have all been slower than sleep_speed for sleep_time is laid to sleep; what touches a sleeping
// body wakes it.
#include <kolize/complementarity.h>
#include <kolize/plugin.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace {

using namespace kolize;

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

struct Moving {
    std::uint32_t id = 0;
    std::uint32_t parent = 0;             // union-find forest of the islands
    double inverse_mass = 0;              // 1/kg
    Mat3 inverse_inertia = Mat3::Zero();  // world axes, 1/(kg m^2)
    // m/s and rad/s; m and rad while positions are put right
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
    std::size_t first_axis = 0;  // that touches it, of a direct solution
    bool pushed = false;
    bool rests = false;  // it moves as its island's impulses say

    Vec3 velocity_at(const Vec3& arm) const { return velocity + angular_velocity.cross(arm); }
    void push(const Vec3& arm, const Vec3& impulse) {
        velocity += inverse_mass * impulse;
        angular_velocity += inverse_inertia * arm.cross(impulse);
        pushed = true;
    }
};

struct Row {
    std::uint32_t contact = 0;   // into the input
    std::uint32_t a = 0, b = 0;  // into the moving bodies; 0 stands for all static ones
    Vec3 normal, tangent[2];
    Vec3 arm_a, arm_b;
    double k = 0;          // normal velocity per unit impulse, 1/kg
    double slip_step = 0;  // likewise, the same in all directions
    Mat2 slip_inverse;     // impulse per unit of slip
    Vec2 coupling;         // normal velocity per unit friction
    double friction = 0;   // coefficient
    double depth = 0;      // m, when found
    double slop = 0;       // m, the depth at which it rests
    double target = 0;     // least normal velocity, m/s
    bool rests = false;    // approaches no faster than what the forces of the step make of rest
    bool sticks = false;   // while the island is solved directly
    double lambda = 0;     // N s
    Vec2 lambda_t = Vec2::Zero();

    const Vec3& direction(int i) const { return i == 0 ? normal : tangent[i - 1]; }
    double& impulse(int i) { return i == 0 ? lambda : lambda_t[i - 1]; }
    double impulse(int i) const { return i == 0 ? lambda : lambda_t[i - 1]; }
    Vec3 directed(double along, const Vec2& across) const {
        return along * normal + across[0] * tangent[0] + across[1] * tangent[1];
    }
};

// What is kept of a contact from one step to the next.
struct Memory {
    Pair pair;
    Vec3 place;    // of the contact, in the frame of body A, m
    Vec3 impulse;  // on B, world axes, N s
};

class Solver final : public Response {
public:
    static void parameters(Parameters<Solver>& p) {
        p.add("method", &Solver::method_)
            .choices({"auto", "sequential", "direct"})
            .doc("How the impulses of an island are found; auto: direct up to direct_rows contacts.");
        p.add("direct_rows", &Solver::direct_rows_)
            .range(0, 1000)
            .doc("auto: most contacts of an island that is solved directly; the cost grows with the cube.");
        p.add("iterations", &Solver::iterations_)
            .range(1, 1e6)
            .doc("Most passes over the contacts of an island in a step; an impact gets up to a hundred times as many.");
        p.add("tolerance", &Solver::tolerance_)
            .range(0, 1)
            .doc("Passes end when no velocity changes by more than this share of the fastest one at a contact.");
        p.add("warm_start", &Solver::warm_start_).doc("Begin with the impulses of the last step.");
        p.add("slop", &Solver::slop_)
            .range(0, 1)
            .doc("Depth at which contacts rest, as a share of the smaller body's radius.");
        p.add("push", &Solver::push_).range(0, 1).doc("Share of a deeper overlap that is taken away in a step.");
        p.add("sleep_time", &Solver::sleep_time_)
            .unit("s")
            .range(0, 1e9)
            .doc("How long an island must have been slow before it sleeps; 0: nothing sleeps.");
        p.add("sleep_speed", &Solver::sleep_speed_)
            .unit("m/s")
            .range(0, 1e9)
            .doc("Slower than this, at the farthest point of a body, counts as slow.");
    }

    void respond(const ResponseInput& input, World& world, ResponseOutput& output) override {
        load(input, world);
        const double before = kinetic_energy(world);
        if (overlaps_ && warm_start_) recall(input, world);
        for (const Island& island : islands_) solve(island);
        output.unresolved += count_unresolved();
        store(input, world);
        output.dissipated_J += before - kinetic_energy(world);
        if (!overlaps_) return;
        remember(input, world);
        put_right(input.dt, world);
        if (sleep_time_ > 0) lay_to_sleep(input.dt, world, output);
    }

    void save(std::vector<std::uint64_t>& words) const override {
        const auto add = [&](const Vec3& v) {
            for (const double x : v) words.push_back(std::bit_cast<std::uint64_t>(x));
        };
        words.push_back(memory_.size());
        for (const Memory& m : memory_) {
            words.push_back(std::uint64_t(m.pair.a) << 32 | m.pair.b);
            add(m.place);
            add(m.impulse);
        }
        for (const double time : slow_for_) words.push_back(std::bit_cast<std::uint64_t>(time));
    }

    void restore(std::span<const std::uint64_t> words) override {
        memory_.clear();
        slow_for_.clear();
        if (words.empty()) return;
        constexpr std::size_t size = 7;  // words of a contact
        const std::uint64_t count = words[0];
        if (count > (words.size() - 1) / size) throw std::invalid_argument("the solver's memory is cut short");
        const auto vector = [](const std::uint64_t* w) {
            return Vec3(std::bit_cast<double>(w[0]), std::bit_cast<double>(w[1]), std::bit_cast<double>(w[2]));
        };
        for (const std::uint64_t* w = &words[1]; memory_.size() < count; w += size) {
            const Pair pair{static_cast<std::uint32_t>(*w >> 32), static_cast<std::uint32_t>(*w)};
            const Memory m{pair, vector(w + 1), vector(w + 4)};
            if (!(pair.a < pair.b) || !m.place.allFinite() || !m.impulse.allFinite() ||
                (!memory_.empty() && pair < memory_.back().pair))
                throw std::invalid_argument("the solver's memory is not what a solver remembers");
            memory_.push_back(m);
        }
        for (const std::uint64_t word : words.subspan(1 + size * count)) {
            slow_for_.push_back(std::bit_cast<double>(word));
            if (!(slow_for_.back() >= 0)) throw std::invalid_argument("the solver's memory has a time below 0");
        }
    }

private:
    struct Island {
        std::uint32_t begin, end;  // into rows_
        bool direct = false;
        bool rests = true;  // all of it
    };

    // An unknown of a direct solution.
    struct Axis {
        std::uint32_t row;  // of the island
        int direction;      // 0: normal, 1, 2: tangents
        double scale;
        std::uint32_t body[2];
        Vec3 along, moment[2], turning[2];  // turning: angular velocity per unit impulse
    };

    // ---------------------------------------------------------------- contacts to rows

    void load(const ResponseInput& input, World& world) {
        if (number_.size() < world.size()) reserve(world.size());
        bodies_.clear();
        bodies_.emplace_back();
        rows_.clear();
        islands_.clear();
        order_.clear();
        fastest_ = 0;
        overlaps_ = false;
        for (const Contact& c : input.contacts) {
            overlaps_ |= input.settle == 0 && c.depth > 0;
            const std::uint32_t a = moving(c.a, world), b = moving(c.b, world);
            if (!a || !b) continue;
            unite(a, b);
            wake(c, world);
        }
        for (std::uint32_t i = 0; i < input.contacts.size(); ++i) {
            Contact& c = input.contacts[i];
            c.impulse = 0;
            c.friction = c.couple = Vec3::Zero();
            const std::uint32_t body = number_[world.is_static[c.a] ? c.b : c.a];
            if (body) order_.push_back({root(body), i});
        }
        std::sort(order_.begin(), order_.end());
        std::uint32_t last = 0;
        for (const auto& [island, contact] : order_) {
            if (!add_row(contact, input, world)) continue;
            const auto row = static_cast<std::uint32_t>(rows_.size() - 1);
            if (island != last) islands_.push_back({row, row});
            last = island;
            islands_.back().end = row + 1;
            islands_.back().rests &= rows_[row].rests;
        }
        for (Island& island : islands_) {
            const auto count = static_cast<int>(island.end - island.begin);
            island.direct = method_ == "direct" || (method_ == "auto" && count <= direct_rows_);
        }
        for (std::size_t i = 1; i < bodies_.size(); ++i) number_[bodies_[i].id] = 0;
        before_ = bodies_;
    }

    // Once, for a crowd in which every body touches several others: later records cost no allocation.
    void reserve(std::size_t world_size) {
        number_.resize(world_size, 0);
        bodies_.reserve(world_size + 1);
        before_.reserve(world_size + 1);
        islands_.reserve(world_size);
        rows_.reserve(32 * world_size);
        order_.reserve(32 * world_size);
        memory_.reserve(32 * world_size);
        next_memory_.reserve(32 * world_size);
        slow_for_.reserve(world_size);
        axes_.reserve(3 * static_cast<std::size_t>(direct_rows_));
        kept_.reserve(static_cast<std::size_t>(direct_rows_));
        problem_.reserve(3 * static_cast<std::size_t>(direct_rows_));
    }

    // The body's place among those that move; 0 if it is static.
    std::uint32_t moving(std::uint32_t id, const World& world) {
        if (world.is_static[id]) return 0;
        if (number_[id] != 0) return number_[id];
        number_[id] = static_cast<std::uint32_t>(bodies_.size());
        Moving& body = bodies_.emplace_back();
        body.id = id;
        body.parent = number_[id];
        body.inverse_mass = world.inverse_mass[id];
        body.inverse_inertia = world.world_inverse_inertia(id);
        body.velocity = world.velocity[id];
        body.angular_velocity = world.angular_velocity[id];
        return number_[id];
    }

    std::uint32_t root(std::uint32_t i) {
        while (bodies_[i].parent != i) i = bodies_[i].parent = bodies_[bodies_[i].parent].parent;
        return i;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        const auto [first, second] = std::minmax({root(a), root(b)});
        bodies_[second].parent = first;
    }

    // Two that sleep are no pair: one of them is awake.
    void wake(const Contact& c, World& world) {
        for (const std::uint32_t body : {c.a, c.b}) {
            if (world.asleep[body] && body < slow_for_.size()) slow_for_[body] = 0;
            world.asleep[body] = 0;
        }
    }

    bool add_row(std::uint32_t contact, const ResponseInput& input, const World& world) {
        const Contact& c = input.contacts[contact];
        const auto mu = [&](std::uint32_t body) { return world.materials[world.material[body]].friction; };
        Row row;
        row.contact = contact;
        row.a = number_[c.a];
        row.b = number_[c.b];
        row.normal = c.normal;
        row.tangent[0] = c.normal.unitOrthogonal();
        row.tangent[1] = c.normal.cross(row.tangent[0]);
        row.arm_a = c.arm_a;
        row.arm_b = c.arm_b;
        row.friction = std::sqrt(mu(c.a) * mu(c.b));
        set_masses(row);
        if (!(row.k > 0)) return false;
        row.depth = c.depth;
        row.slop = slop_ * std::min(world.shape_of(c.a).radius, world.shape_of(c.b).radius);
        set_target(row, c, input, world);
        rows_.push_back(row);
        return true;
    }

    void set_target(Row& row, const Contact& c, const ResponseInput& input, const World& world) {
        const double approach = -row.normal.dot(velocity(row));
        const auto pull = [&](std::uint32_t body) {  // m/s that forces give in a step
            if (world.is_static[body] || world.asleep[body]) return 0.0;
            return input.dt * (world.forces.gravity + world.inverse_mass[body] * world.constant_force[body]).norm();
        };
        row.rests = overlaps_ && approach <= 2 * std::max(pull(c.a), pull(c.b));
        fastest_ = std::max({fastest_, std::abs(approach), overlaps_ ? pull(c.a) : 0, overlaps_ ? pull(c.b) : 0});
        if (row.rests)  // What its depth would be if its bodies had kept their distance decides: it may sink to the
                        // slop.
            row.target = -push_ * std::max(0.0, row.slop - c.depth + approach * acting_time(input.dt)) / input.dt;
        else if (input.settle > 0)
            row.target = -input.allowed_approach(c);
        else
            row.target = world.restitution(c.a, c.b) * std::max(0.0, approach);
    }

    // Forces that act all along a step have moved a body by half of what their velocity would.
    static double acting_time(double dt) { return 0.5 * dt; }

    void set_masses(Row& row) const {
        const Moving &a = bodies_[row.a], &b = bodies_[row.b];
        // Columns: normal and tangents, as moments of the two arms. answer(i, j) is the velocity along i per impulse
        // along j.
        const int axes = row.friction > 0 ? 3 : 1;
        Mat3 moment_a, moment_b;
        for (int i = 0; i < axes; ++i) {
            moment_a.col(i) = row.arm_a.cross(row.direction(i));
            moment_b.col(i) = row.arm_b.cross(row.direction(i));
        }
        const auto answer = [&](int i, int j) {
            return moment_a.col(i).dot(a.inverse_inertia * moment_a.col(j)) +
                   moment_b.col(i).dot(b.inverse_inertia * moment_b.col(j));
        };
        row.k = (a.inverse_mass + b.inverse_mass) * row.normal.squaredNorm() + answer(0, 0);
        if (axes == 1) return;
        const double mass = a.inverse_mass + b.inverse_mass, across = answer(1, 2);
        Mat2 slip;
        slip << mass + answer(1, 1), across, across, mass + answer(2, 2);
        row.slip_inverse = slip.inverse();
        row.slip_step = 1 / slip.trace();  // not beyond the stiffest direction
        row.coupling = {answer(0, 1), answer(0, 2)};
    }

    Vec3 velocity(const Row& row) const {
        return bodies_[row.b].velocity_at(row.arm_b) - bodies_[row.a].velocity_at(row.arm_a);
    }
    void apply(const Row& row, const Vec3& impulse) {
        if (row.a) bodies_[row.a].push(row.arm_a, -impulse);
        if (row.b) bodies_[row.b].push(row.arm_b, impulse);
    }

    std::span<Row> rows_of(const Island& island) {
        return std::span(rows_).subspan(island.begin, island.end - island.begin);
    }

    // ---------------------------------------------------------------- impulses

    void solve(const Island& island) {
        const double enough = tolerance_ * fastest_;
        if (sweep(island) <= enough) return;
        // Impacts know no last step to begin with, and what has no direct answer has not converged: they get many
        // passes.
        int most = overlaps_ ? iterations_ : 100 * iterations_;
        if (island.direct && island.end - island.begin > 1) {
            keep(island);
            if (!solve_directly(island, enough)) {
                put_back(island);
                most = std::max(most, 10 * iterations_);
            }
        }
        for (int i = 1; i < most; ++i)
            if (sweep(island) <= enough) return;
    }

    // Half an answer of the direct method may be far worse than none.
    void keep(const Island& island) {
        kept_.clear();
        for (const Row& row : rows_of(island))
            kept_.push_back({row.lambda, row.lambda_t, {bodies_[row.a], bodies_[row.b]}});
    }
    void put_back(const Island& island) {
        for (std::uint32_t i = island.begin; i < island.end; ++i) {
            const Kept& kept = kept_[i - island.begin];
            rows_[i].lambda = kept.lambda;
            rows_[i].lambda_t = kept.lambda_t;
            bodies_[rows_[i].a] = kept.bodies[0];
            bodies_[rows_[i].b] = kept.bodies[1];
        }
    }

    // One pass of Gauss-Seidel. Returns the largest change of velocity at a contact, m/s.
    double sweep(const Island& island) {
        double largest = 0;
        for (Row& row : rows_of(island)) {
            const Vec3 relative = velocity(row);
            double normal_velocity = row.normal.dot(relative);
            Vec2 slipped = Vec2::Zero();
            if (row.friction > 0) {
                slipped = friction_change(row, relative);
                normal_velocity += row.coupling.dot(slipped);
            }
            const double lambda = std::max(0.0, row.lambda + (row.target - normal_velocity) / row.k);
            const double change = lambda - row.lambda;
            row.lambda = lambda;
            row.lambda_t += slipped;
            largest = std::max({largest, std::abs(change) * row.k, slipped.norm() * row.k});
            if (change != 0 || !slipped.isZero(0)) apply(row, row.directed(change, slipped));
        }
        return largest;
    }

    // To the impulse that stops the slip; where that leaves the cone, towards the point of its edge that is against the
    // slip: a step along the slip itself, because the metric of slip_inverse would turn it.
    static Vec2 friction_change(const Row& row, const Vec3& velocity) {
        const Vec2 slip(row.tangent[0].dot(velocity), row.tangent[1].dot(velocity));
        const double limit = row.friction * row.lambda;
        Vec2 wanted = row.lambda_t - row.slip_inverse * slip;
        if (wanted.norm() > limit) {
            wanted = row.lambda_t - row.slip_step * slip;
            if (const double length = wanted.norm(); length > limit) wanted *= limit / length;
        }
        return wanted - row.lambda_t;
    }

    // All impulses of the island at once. Friction sticks at first; where it leaves its cone it slides, as a given
    // impulse on the cone's edge, until it would stick again. In turns, until no cone is left any more; false if that
    // does not come to an end.
    bool solve_directly(const Island& island, double enough) {
        load_problem(island);
        for (Row& row : rows_of(island)) row.sticks = row.friction > 0;
        for (int turn = 0; turn < 8; ++turn) {
            if (!solve_problem(island)) return false;
            if (keep_to_cones(island, enough) <= enough) return true;
        }
        return false;
    }

    // Returns the largest change of velocity at a contact, m/s.
    double keep_to_cones(const Island& island, double enough) {
        double largest = 0;
        for (Row& row : rows_of(island)) {
            if (row.friction == 0) continue;
            const Vec2 change = friction_change(row, velocity(row));
            const double size = change.norm() * row.k;
            row.sticks = (row.lambda_t + change).norm() < row.friction * row.lambda * (1 - 1e-9);
            if (size <= enough) continue;
            row.lambda_t += change;
            apply(row, row.directed(0, change));
            largest = std::max(largest, size);
        }
        return largest;
    }

    // Unknowns: the normal impulses, and two across each where there is friction; scaled to 1 on the diagonal.
    void load_problem(const Island& island) {
        const std::span<const Row> rows = rows_of(island);
        axes_.clear();
        for (const Row& row : rows) bodies_[row.a].first_axis = bodies_[row.b].first_axis = rows_.size() * 3;
        for (std::uint32_t i = 0; i < rows.size(); ++i)
            for (int d = 0; d < (rows[i].friction > 0 ? 3 : 1); ++d) add_axis(i, rows[i], d);
        problem_.resize(axes_.size());
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            const Axis& x = axes_[i];
            std::size_t first = i;
            for (const std::uint32_t body : x.body)
                if (body) first = std::min(first, bodies_[body].first_axis);
            for (std::size_t j = first; j <= i; ++j)
                if (const double k = coupling(x, axes_[j]); k != 0) problem_.set(i, j, k * x.scale * axes_[j].scale);
        }
        // Corners that lie in a plane but for rounding, and all stick, would pull against each other without a bound.
        constexpr double yields = 1e-9;
        for (std::size_t i = 0; i < axes_.size(); ++i)
            if (axes_[i].direction > 0) problem_.set(i, i, 1 + yields);
    }

    void add_axis(std::uint32_t number, const Row& row, int direction) {
        Axis& axis = axes_.emplace_back();
        axis.row = number;
        axis.direction = direction;
        axis.body[0] = row.a;
        axis.body[1] = row.b;
        axis.along = row.direction(direction);
        for (const int side : {0, 1}) {
            axis.moment[side] = (side ? row.arm_b : row.arm_a).cross(axis.along);
            axis.turning[side] = bodies_[axis.body[side]].inverse_inertia * axis.moment[side];
        }
        axis.scale = 1 / std::sqrt(coupling(axis, axis));
        for (const std::uint32_t body : axis.body)
            bodies_[body].first_axis = std::min(bodies_[body].first_axis, axes_.size() - 1);
    }

    // Velocity along one axis per unit impulse along the other, 1/kg.
    double coupling(const Axis& x, const Axis& y) const {
        double sum = 0;
        for (const int i : {0, 1})
            for (const int j : {0, 1}) {
                if (x.body[i] == 0 || x.body[i] != y.body[j]) continue;
                const double k = bodies_[x.body[i]].inverse_mass * x.along.dot(y.along) + x.moment[i].dot(y.turning[j]);
                sum += i == j ? k : -k;
            }
        return sum;
    }

    // False where no answer is found: the passes that follow do what they can.
    bool solve_problem(const Island& island) {
        using Kind = ComplementarityProblem::Kind;
        const std::span<Row> rows = rows_of(island);
        problem_.begin();
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            const Axis& axis = axes_[i];
            const Row& row = rows[axis.row];
            const double lack = (axis.direction ? 0 : row.target) - axis.along.dot(velocity(row));
            const Kind kind = axis.direction == 0 ? Kind::pushes : row.sticks ? Kind::holds : Kind::given;
            problem_.start(i, kind, row.impulse(axis.direction) / axis.scale, lack * axis.scale);
        }
        if (!problem_.solve()) return false;
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            const Axis& axis = axes_[i];
            Row& row = rows[axis.row];
            if (axis.direction > 0 && !row.sticks) continue;
            double& impulse = row.impulse(axis.direction);
            const double value = problem_.solution(i) * axis.scale, change = value - impulse;
            if (change == 0) continue;
            impulse = value;
            apply(row, change * axis.along);
        }
        return true;
    }

    // Contacts that still approach by a hundredth of the fastest velocity.
    std::uint64_t count_unresolved() const {
        return static_cast<std::uint64_t>(std::count_if(rows_.begin(), rows_.end(), [&](const Row& row) {
            return row.normal.dot(velocity(row)) < row.target - 0.01 * fastest_;
        }));
    }

    // What nothing pushed keeps its velocity to the last bit.
    void store(const ResponseInput& input, World& world) const {
        for (std::size_t i = 1; i < bodies_.size(); ++i) {
            const Moving& body = bodies_[i];
            if (!body.pushed) continue;
            world.velocity[body.id] = body.velocity;
            world.angular_velocity[body.id] = body.angular_velocity;
        }
        for (const Row& row : rows_) {
            Contact& c = input.contacts[row.contact];
            c.impulse = row.lambda;
            c.friction = row.directed(0, row.lambda_t);
        }
    }

    double kinetic_energy(const World& world) const {
        double sum = 0;
        for (std::size_t i = 1; i < bodies_.size(); ++i) sum += world.kinetic_energy(bodies_[i].id);
        return sum;
    }

    // Velocities become displacements, and impulses what makes them: the same equations.
    void put_right(double dt, World& world) {
        for (const Island& island : islands_)
            for (const Row& row : rows_of(island)) bodies_[row.a].rests = bodies_[row.b].rests = island.rests;
        for (std::size_t i = 1; i < bodies_.size(); ++i) {
            Moving& body = bodies_[i];
            const double time = body.rests ? acting_time(dt) : 0;
            body.velocity = time * (body.velocity - before_[i].velocity);
            body.angular_velocity = time * (body.angular_velocity - before_[i].angular_velocity);
        }
        fastest_ = 0;
        for (const Island& island : islands_)
            if (set_displacements(island)) solve(island);
        for (std::size_t i = 1; i < bodies_.size(); ++i) {
            const Moving& body = bodies_[i];
            if (!body.pushed) continue;
            world.position[body.id] += body.velocity;
            const double angle = body.angular_velocity.norm();
            if (angle == 0) continue;
            const Quat turn(Eigen::AngleAxisd(angle, body.angular_velocity / angle));
            world.orientation[body.id] = (turn * world.orientation[body.id]).normalized();
        }
    }

    // Of what is deeper than the slop a share is to go; the others may close up to it. Friction is left out where
    // bodies are about equally heavy: it costs twice the rest, and only a light body between heavy ones is squeezed out
    // without it. False if nothing is deeper.
    bool set_displacements(const Island& island) {
        constexpr double alike = 4;
        double lightest = 0, heaviest = infinity;
        for (const Row& row : rows_of(island))
            for (const std::uint32_t body : {row.a, row.b})
                if (body) {
                    lightest = std::max(lightest, bodies_[body].inverse_mass);
                    heaviest = std::min(heaviest, bodies_[body].inverse_mass);
                }
        bool deep = false;
        for (Row& row : rows_of(island)) {
            const double parted = row.normal.dot(velocity(row)), excess = row.depth - parted - row.slop;
            deep = deep || excess > 0.02 * row.slop;
            row.target = parted + (excess > 0 ? push_ : 1) * excess;
            if (lightest <= alike * heaviest) row.friction = 0;
            row.lambda = 0;
            row.lambda_t = Vec2::Zero();
            fastest_ = std::max(fastest_, excess);
        }
        return deep;
    }

    // ---------------------------------------------------------------- from step to step

    // Both lists are sorted by pair; of a pair's old contacts each new one takes the nearest.
    void recall(const ResponseInput& input, const World& world) {
        for (Row& row : rows_) {
            const Contact& c = input.contacts[row.contact];
            const Pair pair{c.a, c.b};
            auto old = std::lower_bound(memory_.begin(), memory_.end(), pair,
                                        [](const Memory& m, const Pair& p) { return m.pair < p; });
            constexpr double reach = 0.1;  // of the smaller body's radius
            const double radius = reach * std::min(world.shape_of(c.a).radius, world.shape_of(c.b).radius);
            const Vec3 place = world.orientation[c.a].conjugate() * c.arm_a;
            double nearest = radius * radius;
            for (; old != memory_.end() && old->pair == pair; ++old) {
                const double distance = (old->place - place).squaredNorm();
                if (distance >= nearest) continue;
                nearest = distance;
                row.lambda = std::max(0.0, row.normal.dot(old->impulse));
                row.lambda_t = {row.tangent[0].dot(old->impulse), row.tangent[1].dot(old->impulse)};
            }
            const double limit = row.friction * row.lambda, length = row.lambda_t.norm();
            if (length > limit) row.lambda_t *= limit / length;
            if (row.lambda > 0) apply(row, row.directed(row.lambda, row.lambda_t));
        }
    }

    // In the order of the contacts, which is by pair.
    void remember(const ResponseInput& input, const World& world) {
        order_.clear();
        for (std::uint32_t i = 0; i < rows_.size(); ++i) order_.push_back({rows_[i].contact, i});
        std::sort(order_.begin(), order_.end());
        next_memory_.clear();
        for (const auto& [contact, i] : order_) {
            const Row& row = rows_[i];
            const Contact& c = input.contacts[contact];
            next_memory_.push_back(
                {{c.a, c.b}, world.orientation[c.a].conjugate() * c.arm_a, row.directed(row.lambda, row.lambda_t)});
        }
        memory_.swap(next_memory_);
    }

    // ---------------------------------------------------------------- sleep

    void lay_to_sleep(double dt, World& world, ResponseOutput& output) {
        slow_for_.resize(world.size(), 0);
        for (std::size_t i = 1; i < bodies_.size(); ++i) {
            const std::uint32_t id = bodies_[i].id;
            const double speed =
                world.velocity[id].norm() + world.angular_velocity[id].norm() * world.shape_of(id).radius;
            slow_for_[id] = speed <= sleep_speed_ ? slow_for_[id] + dt : 0;
        }
        for (const Island& island : islands_) {
            double least = infinity;
            for_bodies(island, [&](std::uint32_t id) { least = std::min(least, slow_for_[id]); });
            if (least < sleep_time_) continue;
            for_bodies(island, [&](std::uint32_t id) {
                output.dissipated_J += world.kinetic_energy(id);
                world.velocity[id] = world.angular_velocity[id] = Vec3::Zero();
                world.asleep[id] = 1;
            });
        }
    }

    template <class Visit>
    void for_bodies(const Island& island, Visit&& visit) const {
        for (std::uint32_t i = island.begin; i < island.end; ++i)
            for (const std::uint32_t body : {rows_[i].a, rows_[i].b})
                if (body) visit(bodies_[body].id);
    }

    std::string method_ = "auto";
    int direct_rows_ = 64;
    int iterations_ = 10;
    double tolerance_ = 1e-5;
    bool warm_start_ = true;
    double slop_ = 1e-3;
    double push_ = 0.2;
    double sleep_time_ = 0;
    double sleep_speed_ = 0.01;

    std::vector<std::uint32_t> number_;                           // per body of the world: its place in bodies_, or 0
    std::vector<Moving> before_;                                  // as the call began
    std::vector<Moving> bodies_;                                  // the first one stands for all static bodies
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order_;  // root of the island, contact; or contact, row
    std::vector<Island> islands_;
    std::vector<Row> rows_;
    std::vector<Axis> axes_;  // the unknowns of problem_
    struct Kept {
        double lambda;
        Vec2 lambda_t;
        Moving bodies[2];
    };
    std::vector<Kept> kept_;  // of an island, before it is solved directly
    ComplementarityProblem problem_;
    bool overlaps_ = false;                     // a step to go through, not a time of impact
    double fastest_ = 0;                        // m/s
    std::vector<Memory> memory_, next_memory_;  // sorted by pair
    std::vector<double> slow_for_;              // per body of the world, s
};

}  // namespace

KOLIZE_PLUGIN(
    Solver, .name = "solver", .summary = "resting contact with friction, restitution, warm starting and sleep",
    .source =
        "Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988); Catto, Iterative dynamics "
        "with temporal coherence (2005); Judice and Pires 1994",
    .cost =
        "Sequential: some hundred operations a contact and pass; a pile at rest needs one or two passes a step. "
        "Direct: the cube of an island's contacts, small next to its use up to a few dozen.",
    .accuracy =
        "Friction cones are exact, not pyramids. A direct island leaves no approach to rounding, at any mass "
        "ratio; a sequential one what its passes leave, told as unresolved above a hundredth of the fastest "
        "approach. Momentum is kept to rounding. Overlaps up to the slop stay. Simultaneous bounces follow "
        "Newton's law contact by contact, which can make energy where several bodies hit each other at once.",
    .choose =
        "For whatever comes to rest, lies in heaps, or slides and rolls with friction. Take impulse where nothing "
        "rests and energy must be kept; simple_bounce for balls alone.",
    .capabilities = {.needs = Detail::normal,
                     .uses = Detail::manifold,
                     .moves = true,
                     .rests = true,
                     .sleeps = true,
                     .friction = true})
