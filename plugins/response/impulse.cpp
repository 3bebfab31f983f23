// Impulse response: rigid bodies bounce off each other and turn, without friction.
//
// A contact that approaches gets the impulse that sends its normal velocity back, times the restitution, with the full
// inertia of both bodies. Contacts that share bodies are answered again and again until none approaches, never
// averaged: a body that touches at several places cannot be let in at one of them. Where one body hits several at once
// physics leaves the outcome open, and `order` decides:
//   sequential  one contact at a time, the one that approaches fastest. Of approaches that are the same to the last bit
//               the first in canonical order: nothing else depends on how bodies are numbered. It ends after finitely
//               many reflections if the bodies can part at all (Vouga et al.).
//   symmetric   all that approach, along the joint impulse that would stop them together (generalized reflections,
//               Smith et al.). Keeps the symmetry of a scene, and no two contacts change places when bodies are
//               numbered otherwise.
// Below restitution 1 bounces between several contacts become ever smaller. When a thousandth of the speed is left, or
// max_impulses is reached, the rest of the approach is stopped in one inelastic impact (Moreau). Restitution 0 is that
// impact alone.
#include <kolize/joint_impulse.h>
#include <kolize/plugin.h>

#include <algorithm>
#include <numeric>

namespace {

using namespace kolize;

constexpr double relative_tolerance = 1e-12;  // approach below this share of the speeds at hand is rounding
constexpr double worth_a_bounce = 1e-3;       // share of the first speed below which bounces end in rest
constexpr int most_stops = 64;                // inelastic impacts of an island: one, and what rounding left of it

// The least of a row of numbers that change one at a time: a tournament tree.
class Least {
public:
    void reserve(std::size_t count) {
        values_.reserve(count);
        winners_.reserve(2 * count);
    }
    void add(double value) { values_.push_back(value); }
    void clear() { values_.clear(); }
    // Once all are added.
    void play() {
        winners_.resize(2 * values_.size());
        std::iota(winners_.begin() + values_.size(), winners_.end(), 0);
        for (std::size_t node = values_.size(); node-- > 1;) play(node);
    }
    void set(std::size_t i, double value) {
        values_[i] = value;
        for (std::size_t node = (i + values_.size()) / 2; node > 0; node /= 2) play(node);
    }
    // The first of equals.
    std::size_t index() const { return winners_[1]; }
    double value() const { return values_[index()]; }

private:
    void play(std::size_t node) {
        const std::uint32_t a = winners_[2 * node], b = winners_[2 * node + 1];
        const bool b_wins = values_[b] < values_[a] || (values_[b] == values_[a] && b < a);
        winners_[node] = b_wins ? b : a;
    }

    std::vector<double> values_;
    // Node i has met node i + 1 in node i / 2, up to the root 1. The leaves are behind: value i at count + i.
    std::vector<std::uint32_t> winners_;
};

class Impulse final : public Response {
public:
    static void parameters(Parameters<Impulse>& p) {
        p.add("order", &Impulse::order_)
            .choices({"sequential", "symmetric"})
            .doc("Contacts that approach at once: the fastest first, or all of them together.");
        p.add("max_impulses", &Impulse::max_impulses_)
            .range(1, 1e6)
            .doc("Impulses per contact before the rest of an island is stopped (at restitution 1: given up).");
    }

    void respond(const ResponseInput& input, World& world, ResponseOutput& output) override {
        if (reserved_ < world.size()) reserve(world.size());
        rows_.build(input, world);
        for (const ImpactRows::Island& island : rows_.islands()) {
            Task task = begin(island, world, output);
            if (input.settle > 0)
                bring_to_rest(task);
            else
                bounce(task);
            task.output.unresolved += find_approaching(task);
        }
    }

private:
    // An island, and what is known of it at the beginning.
    struct Task {
        ImpactRows::Island island;
        World& world;
        ResponseOutput& output;
        double limit = 0;  // normal velocities below this approach, m/s
        std::size_t impulses_left = 0;
        bool elastic = true;  // restitution is 1 everywhere
    };

    // Once, for a crowd in which every body touches several others: later records cost no allocation.
    void reserve(std::size_t world_size) {
        reserved_ = world_size;
        speeds_.reserve(32 * world_size);
        chosen_.reserve(32 * world_size);
        joint_.reserve(32 * world_size, world_size);
    }

    Task begin(const ImpactRows::Island& island, World& world, ResponseOutput& output) const {
        Task task{island, world, output};
        double scale = 0, liveliest = 0;
        for (const ImpactRow& row : rows(task)) {
            scale = std::max(scale, row.speed_scale(task.world));
            liveliest = std::max(liveliest, row.restitution);
            task.elastic = task.elastic && row.restitution == 1;
        }
        task.limit = -relative_tolerance * scale;
        task.impulses_left = bounces(liveliest) * rows(task).size();
        return task;
    }

    void bounce(Task& task) {
        order_ == "symmetric" ? reflect_together(task) : reflect_in_turn(task);
        if (task.impulses_left == 0 && !task.elastic) bring_to_rest(task);
    }

    void bring_to_rest(Task& task) {
        for (int i = 0; i < most_stops && find_approaching(task) > 0; ++i) stop(task);
    }

    std::span<const ImpactRow> rows(const Task& task) const {
        return rows_.rows().subspan(task.island.begin, task.island.end - task.island.begin);
    }

    // Of one contact, until its speed is not worth another one.
    std::size_t bounces(double restitution) const {
        if (restitution >= 1) return max_impulses_;
        return static_cast<std::size_t>(
            std::min<double>(max_impulses_, std::ceil(std::log(worth_a_bounce) / std::log(restitution))));
    }

    void reflect_in_turn(Task& task) {
        speeds_.clear();
        for (const ImpactRow& row : rows(task)) speeds_.add(row.normal_velocity(task.world));
        speeds_.play();
        for (; task.impulses_left > 0 && speeds_.value() < task.limit; --task.impulses_left) {
            const ImpactRow& hit = rows(task)[speeds_.index()];
            reflect(hit, speeds_.value(), task);
            for (const std::uint32_t i : rows_.rows_of(hit.moving_a)) update_speed(i, task);
            for (const std::uint32_t i : rows_.rows_of(hit.moving_b))
                if (hit.moving_a == ImpactRow::fixed || !rows_.rows()[i].moves(hit.moving_a)) update_speed(i, task);
        }
    }

    void update_speed(std::uint32_t i, const Task& task) {
        speeds_.set(i - task.island.begin, rows_.rows()[i].normal_velocity(task.world));
    }

    // The second impulse is what rounding left of the first: without it the error of k would add up where the same two
    // bodies meet thousands of times.
    void reflect(const ImpactRow& row, double speed, Task& task) {
        const double restitution = row.restitution;
        row.push(-(1 + restitution) * speed / row.k, task.world);
        row.push(-(row.normal_velocity(task.world) + restitution * speed) / row.k, task.world);
        task.output.dissipated_J += (1 - restitution * restitution) * speed * (speed / (2 * row.k));
    }

    void reflect_together(Task& task) {
        for (; task.impulses_left > 0 && find_approaching(task) > 0; --task.impulses_left) {
            const ImpactRow& first = rows_.rows()[chosen_.front()];
            if (chosen_.size() == 1) {
                reflect(first, first.normal_velocity(task.world), task);
                continue;
            }
            joint_.solve(rows_, chosen_, task.world);
            reflect_joint(restitution_of_joint(task.world), task);
        }
    }

    // Stops what approaches, and everything that this would make approach.
    void stop(Task& task) {
        chosen_.resize(rows(task).size());
        std::iota(chosen_.begin(), chosen_.end(), task.island.begin);
        joint_.solve(rows_, chosen_, task.world);
        reflect_joint(0, task);
    }

    // The rows of the island that approach, into chosen_; returns how many.
    std::size_t find_approaching(const Task& task) {
        chosen_.clear();
        for (std::uint32_t i = task.island.begin; i < task.island.end; ++i)
            if (rows_.rows()[i].normal_velocity(task.world) + rows_.rows()[i].allowed < task.limit)
                chosen_.push_back(i);
        return chosen_.size();
    }

    // Each row counts by the energy that its impulse takes.
    double restitution_of_joint(const World& world) const {
        double sum = 0, energy = 0;
        for (std::size_t i = 0; i < chosen_.size(); ++i) {
            const ImpactRow& row = rows_.rows()[chosen_[i]];
            const double share = joint_.impulse(i) * row.normal_velocity(world);
            sum += row.restitution * share;
            energy += share;
        }
        return energy < 0 ? sum / energy : 0;
    }

    void reflect_joint(double restitution, Task& task) {
        const double times = (1 + restitution) * joint_.factor();
        if (!(times > 0) || !std::isfinite(times)) return;
        for (std::size_t i = 0; i < chosen_.size(); ++i)
            rows_.rows()[chosen_[i]].push(times * joint_.impulse(i), task.world);
        task.output.dissipated_J += (1 - restitution * restitution) * joint_.energy();
    }

    std::string order_ = "sequential";
    int max_impulses_ = 64;

    std::size_t reserved_ = 0;  // bodies
    ImpactRows rows_;
    JointImpulse joint_;
    Least speeds_;                       // normal velocities of one island's rows, m/s; negative where bodies approach
    std::vector<std::uint32_t> chosen_;  // rows of rows_ that are answered together
};

}  // namespace

KOLIZE_PLUGIN(Impulse, .name = "impulse", .summary = "rigid bodies bounce and turn: frictionless impulses",
              .source =
                  "One contact: Mirtich, Impulse-based dynamic simulation of rigid body systems (1996), 3.2. "
                  "Sequential: Vouga et al., All's well that ends well, ACM TOG 36(4), 2017. Symmetric: Smith et al., "
                  "Reflections on simultaneous impact, ACM TOG 31(4), 2012. Inelastic: Moreau, Unilateral contact and "
                  "dry friction in finite freedom dynamics (1988)",
              .cost =
                  "Sequential: per impulse the contacts of the two bodies, times the logarithm of those of the island "
                  "(the contacts linked through moving bodies). Symmetric: per pass all contacts of the island, and a "
                  "linear system over those that approach. A handful of impulses or passes an island is usual.",
              .accuracy =
                  "With restitution 1 kinetic energy is kept to rounding, whatever the contact points, normals and "
                  "inertia; below 1 what is lost is reported to rounding. Momentum and angular momentum of a pair of "
                  "dynamic bodies are always kept.",
              .choose =
                  "For bodies that bounce and whose rotation matters. For balls that only bounce simple_bounce is "
                  "cheaper; for what rests or rubs take solver.",
              .capabilities = {.needs = Detail::normal, .uses = Detail::manifold})
