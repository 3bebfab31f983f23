#include "framework/scenes.h"
#include "framework/solids.h"
#include "narrowphase/solids.h"

#include <kolize/observer.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

double kinetic_energy(const World& world) {
    double sum = 0;
    for (std::uint32_t body = 0; body < world.size(); ++body) sum += world.kinetic_energy(body);
    return sum;
}

// Counts what is shown, and checks the order in which that comes.
class Notes final : public Observer {
public:
    void step_begins(std::uint64_t step, const World&) override {
        CHECK(step == steps_begun++);
        last_end_ = {};
    }
    void step_ended(std::uint64_t step, const World& world) override {
        CHECK(step == steps_ended++);
        last_world = world;
    }
    void ended(const Span& span) override {
        CHECK(span.begin <= span.end);
        if (span.stage == std::string("step")) {
            CHECK(span.begin <= first_begin_);
            CHECK(last_end_ <= span.end);
            first_begin_ = Span::Clock::time_point::max();
            return;
        }
        CHECK(last_end_ <= span.begin);
        first_begin_ = std::min(first_begin_, span.begin);
        last_end_ = span.end;
    }
    void broadphase_found(const BroadphaseInput& input, std::span<const Pair> found) override {
        pairs += found.size();
        for (const Pair& pair : found) CHECK(input.bounds[pair.a].overlaps(input.bounds[pair.b]));
    }
    void narrowphase_found(const NarrowphaseInput& input, bool, const Contacts& found) override {
        contacts += found.rows.size();
        CHECK(input.pairs.size() == input.detail.size());
    }
    void narrowphase_timed(const ImpactInput& input, std::span<const double> times) override {
        timed += times.size();
        CHECK(times.size() == input.pairs.size());
    }
    void response_begins(std::size_t rule, const ResponseInput& input, const World& world) override {
        CHECK(rule == 0);
        before_ = kinetic_energy(world);
        answered += input.contacts.size();
    }
    void response_ended(std::size_t, const ResponseInput&, const World& world) override {
        CHECK(kinetic_energy(world) == Approx(before_));  // the bodies are elastic
    }

    std::uint64_t steps_begun = 0, steps_ended = 0, pairs = 0, contacts = 0, timed = 0, answered = 0;
    World last_world;

private:
    Span::Clock::time_point first_begin_ = Span::Clock::time_point::max(), last_end_{};
    double before_ = 0;
};

}  // namespace

TEST_CASE("an observer sees every call of a run and changes nothing", "[observer]") {
    constexpr std::uint64_t steps = 200;
    for (const char* mode : {"discrete", "rollback", "bisection", "continuous"}) {
        CAPTURE(mode);
        Scene scene = gas(make_mesh("bar", u_bar()), 2, 3.8, 2);
        scene.pipeline.step.mode = mode;
        const RunResult alone = run(scene, steps);
        const auto host = make_host(1);
        Simulation simulation(scene, plugins(), *host, steps);
        Notes notes;
        simulation.watch(notes);
        for (std::uint64_t i = 0; i < steps; ++i) simulation.step();
        const RunResult watched = simulation.result();
        CHECK(watched.state_hash == alone.state_hash);
        CHECK(notes.steps_begun == steps);
        CHECK(notes.steps_ended == steps);
        CHECK(notes.contacts == watched.contacts);
        CHECK(notes.answered >= 20);
        CHECK(notes.last_world.position == simulation.world().position);
        CHECK((notes.timed > 0) == (mode == std::string("continuous")));
    }
}
