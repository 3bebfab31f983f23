// Pipelines as a whole: one body between the walls of a room, without losses, against its invariants.
#include "stability/study.h"

#include <kolize/observer.h>
#include <kolize/simulation.h>

#include <fstream>
#include <map>
#include <memory>

#include <unistd.h>

namespace kolize::cli::stability {
namespace {

constexpr double room_side = 6;  // m

constexpr const char* scene_text = R"(
[[material]]
name = "steel"
restitution = 1.0
friction = 0.0

[[shape]]
name = "brick"
kind = "box"
half_extents = [0.5, 0.3, 0.2]

[[body]]
shape = "brick"
material = "steel"
mass = 1.0

[[room]]
min = [-3, -3, -3]
max = [3, 3, 3]
thickness = 1
material = "steel"
)";

enum { duration, speed, distance };

// Ends a run in which the stages are called far more often than the steps can need.
class WorkLimit final : public Observer {
public:
    explicit WorkLimit(std::uint64_t most) : left_(most) {}
    void ended(const Span&) override {
        if (left_ > 0) --left_;
        if (left_ == 0) throw Hang("stages are called without end");
    }
    bool exceeded() const { return left_ == 0; }

private:
    std::uint64_t left_;
};

using Scenes = std::map<std::string, Scene>;  // by subject

Scene load(const Context& context, const Subject& subject) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("kolize-stability-" + std::to_string(getpid()) + ".toml");
    if (!(std::ofstream(file) << scene_text)) throw Error("'" + file.string() + "' cannot be written");
    const auto remove = [](const std::filesystem::path* path) { std::filesystem::remove(*path); };
    const std::unique_ptr<const std::filesystem::path, decltype(remove)> guard(&file, remove);
    SceneOptions options{subject.pipeline, {}, plugin_defaults()};
    if (subject.pipeline.empty()) options.set = {{"step.mode", subject.name}};
    return load_scene(file, options, context.plugins);
}

Outcome judge(const RunResult& result, double energy_drift, double path, double expected) {
    if (!std::isfinite(result.energy_final_J)) return {Failure::not_finite, "the energy is not finite"};
    if (result.escaped > 0) return {Failure::escaped, "the body leaves the room"};
    if (result.stuck > 0) return {Failure::stuck, "the body and a wall stay in contact"};
    if (!(path > 0.5 * expected))
        return {Failure::stuck, "the body goes " + number(path / expected) + " of the way that its speed makes"};
    if (energy_drift > 1e-6) return {Failure::inaccurate, "energy drifts by " + number(energy_drift) + " of the whole"};
    return {};
}

Outcome probe(const Context& context, const Scenes& scenes, const Subject& subject, const Point& point) {
    constexpr int crossings = 10;             // of the room
    constexpr std::uint64_t most_calls = 60;  // of stages, a step on average; five or six are usual
    Scene scene = scenes.at(subject.name);
    Dice dice(context.seed);
    const double dt = value(point, duration), pace = value(point, speed);
    const Vec3 shift = value(point, distance) * dice.direction();
    World& world = scene.world;
    world.position[0] += shift;
    world.velocity[0] = pace * dice.direction();
    world.angular_velocity[0] = 0.2 * pace * dice.direction();
    for (Room& room : scene.rooms) {
        room.min += shift;
        room.max += shift;
    }
    scene.pipeline.step.dt = dt;
    const auto steps = static_cast<std::uint64_t>(std::clamp(crossings * room_side / pace / dt, 50.0, 300.0));
    Simulation simulation(scene, context.plugins, context.host, steps);
    WorkLimit limit(most_calls * steps);
    simulation.watch(limit);
    double path = 0, expected = 0;
    for (std::uint64_t i = 0; i < steps; ++i) {
        const Vec3 before = simulation.world().position[0];
        expected += std::min(dt * simulation.world().velocity[0].norm(), 0.1 * room_side);
        try {
            simulation.step();
        } catch (const std::exception&) {
            if (!limit.exceeded()) throw;
            return {Failure::hang, "stages are called more than " + std::to_string(most_calls) + " times a step"};
        }
        path += (simulation.world().position[0] - before).norm();
    }
    const RunResult result = simulation.result();
    return judge(result, result.energy_drift, path, expected);
}

}  // namespace

std::vector<Study> pipeline_studies(const Context& context, const std::vector<Subject>& subjects) {
    const auto scenes = std::make_shared<Scenes>();
    for (const Subject& subject : subjects) scenes->emplace(subject.name, load(context, subject));
    return {
        {"pipeline",
         "room",
         "A brick of 1 m flies and turns in a room of 6 m without losses, until it has crossed it ten times, over 50 "
         "to 300 steps: it stays inside, goes on, and its energy drifts by no more than a millionth. Oracle: the "
         "invariants.",
         {{"dt", "s", "duration of a step", -4, 1, -2},
          {"speed", "m/s", "of the brick", -1, 4, 0.7},
          {"distance", "m", "from the origin", 0, 15, 0}},
         subjects,
         [context, scenes](const Subject& subject, const Point& point) {
             return probe(context, *scenes, subject, point);
         }}};
}

}  // namespace kolize::cli::stability
