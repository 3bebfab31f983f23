// The broadphase that chooses: what it takes, and that its choice never shows in the results.
#include "framework/scenes.h"

#include <kolize/plugin_library.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

// Time passes only as its broadphases say.
class Clock final : public Host {
public:
    int threads() const override { return 1; }
    double now() const override { return time; }
    void warn(std::string_view) override {}
    double time = 0;

protected:
    void run_chunks(std::size_t count, std::size_t grain, ChunkFunction function, void* context) override {
        for (std::size_t i = 0; i * grain < count; ++i)
            function(context, i, i * grain, std::min(count, (i + 1) * grain));
    }
};

struct Timed final : Broadphase {
    Timed(Clock& c, double t, double s, std::size_t& w) : clock(c), seconds_a_row(t), seconds_a_pair(s), worst(w) {}
    void find_pairs(const BroadphaseInput& input, std::vector<Pair>& pairs) override {
        const auto rows = static_cast<double>(input.bounds.size());
        clock.time += seconds_a_row * rows + seconds_a_pair * rows * rows;
        worst = std::max(worst, input.bounds.size());
        pairs.push_back({0, 1});
    }
    Clock& clock;
    double seconds_a_row, seconds_a_pair;
    std::size_t& worst;
};

struct Choice final : BroadphaseChoice {
    explicit Choice(Clock& c) : clock(c) {}
    std::size_t size() const override { return 3; }
    const char* name(std::size_t i) const override { return i == 0 ? "quadratic" : i == 1 ? "slow" : "fast"; }
    std::shared_ptr<Broadphase> make(std::size_t i) const override {
        return std::make_shared<Timed>(clock, i == 0 ? 1e-9 : i == 1 ? 3e-7 : 2e-7, i == 0 ? 1e-9 : 0, largest[i]);
    }
    Clock& clock;
    mutable std::size_t largest[3] = {0, 0, 0};  // number of rows that each one has seen
};

std::vector<Aabb> row_of_boxes(std::size_t count) {
    std::vector<Aabb> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back({Vec3(double(i), 0, 0), Vec3(double(i) + 0.5, 1, 1)});
    return boxes;
}

}  // namespace

TEST_CASE("auto takes what is fastest for the number of boxes at hand", "[broadphase]") {
    Clock clock;
    const auto choice = std::make_shared<Choice>(clock);
    const auto chooser = plugins().make<Broadphase>(stage("auto"), clock);
    chooser->choose_from(choice);
    std::vector<Pair> pairs;
    const auto run = [&](std::size_t rows) {
        const std::vector<Aabb> boxes = row_of_boxes(rows);
        const std::vector<std::uint8_t> is_static(rows, 0);
        for (int call = 0; call < 40; ++call) {
            pairs.clear();
            chooser->find_pairs({boxes, is_static, rows}, pairs);
            CHECK(pairs == std::vector<Pair>{{0, 1}});
        }
        return chooser->report();
    };
    CHECK(run(50).starts_with("chose quadratic for 50 boxes"));
    CHECK(run(100000).starts_with("chose fast for 100000 boxes"));
    CHECK(choice->largest[0] < 20000);
    CHECK(run(60).starts_with("chose quadratic for 60 boxes"));
}

TEST_CASE("A run with auto ends in the state that it has with brute force", "[broadphase]") {
    std::uint64_t hash = 0;
    for (const char* plugin : {"brute_force", "auto"}) {
        Scene scene = gas(make_box("box", Vec3::Constant(0.4)), 4, 1.4, 7);
        scene.pipeline.broadphase = stage(plugin);
        const auto host = make_host(1);
        Simulation simulation(scene, plugins(), *host, 1);
        for (int step = 0; step < 200; ++step) simulation.step();
        if (hash == 0) hash = simulation.result().state_hash;
        CHECK(simulation.result().state_hash == hash);
        CHECK(simulation.broadphase().report.empty() == (std::string(plugin) == "brute_force"));
    }
}
