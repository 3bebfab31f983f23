// bench_extremes: where kolize, Bullet and ODE give up: fast balls and thin walls, scenes far from the origin, long
// free rotation. One table each. How the engines are set up: docs/rivals.md.
#include "common.h"
#include "gauge.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <functional>
#include <iostream>

namespace {

using bench::Workshop;
using kolize::Scene;
using kolize::Vec3;
using kolize::cli::number;
using kolize::cli::Settings;

struct Options {
    std::string scenes = KOLIZE_SOURCE_DIR "/bench/scenes";
    std::vector<std::string> tables{"wall", "shift", "spin"};
    std::vector<std::string> rivals{"bullet", "bullet_swept", "ode"};
    std::vector<std::string> vary{"step.mode=discrete"}, plugin_path;
    double shift_time = 2;  // simulated, s
};

struct Contestant {
    std::string engine;
    Settings vary;  // of kolize's pipeline

    std::string label() const { return engine + (vary.empty() ? "" : " " + kolize::cli::label(vary)); }
};

std::vector<Contestant> enter(const Options& options) {
    std::vector<Contestant> contestants;
    for (const Settings& vary : kolize::cli::combinations(kolize::cli::parse_variations(options.vary)))
        contestants.push_back({"kolize", vary});
    for (const std::string& rival : options.rivals) contestants.push_back({rival, {}});
    return contestants;
}

Scene load(const Options& options, const char* file, const Contestant& contestant, const Workshop& workshop) {
    return kolize::load_scene(std::filesystem::path(options.scenes) / file,
                              {{}, contestant.vary, kolize::cli::plugin_defaults()}, workshop.plugins);
}

bench::Reading run(const Contestant& contestant, const Scene& scene, std::uint64_t steps, const Workshop& workshop) {
    const auto engine = bench::make_engine(contestant.engine, scene, workshop, steps);
    bench::Gauge gauge(bench::world_with_walls(scene, workshop), scene.rooms);
    for (std::uint64_t i = 0; i < steps; ++i) {
        engine->step();
        gauge.look(*engine, scene.pipeline.step.dt);
    }
    return gauge.reading();
}

// --- A thin wall ---------------------------------------------------------------------------------------------------

// True if the ball comes through from a start `phase` steps before it touches the wall's near side.
bool tunnels(const Contestant& contestant, Scene scene, double speed, double phase, const Workshop& workshop) {
    constexpr std::uint64_t steps = 20;
    constexpr double touching = 0.055;  // m: radius and half the wall
    scene.world.position[0].x() = -touching - phase * speed * scene.pipeline.step.dt;
    scene.world.velocity[0] = speed * Vec3::UnitX();
    const auto engine = bench::make_engine(contestant.engine, scene, workshop, steps);
    for (std::uint64_t i = 0; i < steps; ++i) engine->step();
    return !(engine->state(0).position.x() < 0);
}

// The fastest of the speeds 1, sqrt 2, 2, ... a million m/s up to which no start lets the ball through; 0: none.
double fastest_held(const Contestant& contestant, const Scene& scene, const Workshop& workshop) {
    constexpr int starts = 32, halvings = 40;
    for (int i = 0; i <= halvings; ++i)
        for (int k = 0; k < starts; ++k)
            if (tunnels(contestant, scene, std::exp2(0.5 * i), (k + 0.5) / starts, workshop))
                return i == 0 ? 0 : std::exp2(0.5 * (i - 1));
    return std::exp2(0.5 * halvings);
}

void print_wall(const Options& options, const std::vector<Contestant>& contestants, const Workshop& workshop) {
    std::cout << "A ball of 0.1 m against a wall of 0.01 m, dt = 1/60 s: the fastest that never came through (of 1, "
                 "sqrt 2, 2, ... 2^20 m/s)\n\n";
    kolize::cli::Table table({"engine", "m/s"});
    for (const Contestant& contestant : contestants) {
        const Scene scene = load(options, "wall.toml", contestant, workshop);
        table.add({contestant.label(), number(fastest_held(contestant, scene, workshop))});
    }
    table.print(std::cout);
}

// --- Far from the origin -------------------------------------------------------------------------------------------

constexpr int farthest_shift = 9;  // a power of ten, m

void shift(Scene& scene, const Vec3& by) {
    for (Vec3& position : scene.world.position) position += by;
    for (kolize::Room& room : scene.rooms) {
        room.min += by;
        room.max += by;
    }
}

bool holds(const bench::Reading& reading) {
    return reading.escaped == 0 && reading.path_ratio > 0.5 && reading.path_ratio < 2;
}

std::string outcome(const bench::Reading& reading) {
    if (reading.escaped > 0) return std::to_string(reading.escaped) + " out";
    return holds(reading) ? number(reading.worst_energy_error, 2) : "frozen";
}

// Up to the first shift that does not hold: beyond it an engine may put all bodies into one place.
std::vector<std::string> shift_row(const Options& options, const Contestant& contestant, const Workshop& workshop) {
    const Scene scene = load(options, "cubes.toml", contestant, workshop);
    const std::uint64_t steps = kolize::steps_in(options.shift_time, scene.pipeline.step.dt);
    std::vector<std::string> row{contestant.label()};
    for (int k = 0; k <= farthest_shift; ++k) {
        Scene shifted = scene;
        shift(shifted, Vec3::Constant(std::pow(10.0, k)));
        const bench::Reading reading = run(contestant, shifted, steps, workshop);
        row.push_back(outcome(reading));
        if (!holds(reading)) break;
    }
    return row;
}

void print_shift(const Options& options, const std::vector<Contestant>& contestants, const Workshop& workshop) {
    std::cout << "cubes.toml for " << options.shift_time
              << " s with every coordinate greater by 10^k m: worst energy error, or bodies out of the room, or frozen "
                 "motion\n\n";
    std::vector<std::string> head{"engine"};
    for (int k = 0; k <= farthest_shift; ++k) head.push_back("k = " + std::to_string(k));
    kolize::cli::Table table(head);
    for (const Contestant& contestant : contestants) table.add(shift_row(options, contestant, workshop));
    table.print(std::cout);
}

// --- Free rotation -------------------------------------------------------------------------------------------------

void print_spin(const Options& options, const std::vector<Contestant>& contestants, const Workshop& workshop) {
    constexpr double time = 600;  // s
    std::cout << "Free rotation, moments 1, 2, 3 kg m^2, start (0.01, 10, 0.01) rad/s, " << time
              << " s at dt = 1/60 s\n\n";
    kolize::cli::Table table({"engine", "energy error", "worst", "worst of angular momentum"});
    for (const Contestant& contestant : contestants) {
        Scene scene = load(options, "spin.toml", contestant, workshop);
        scene.world.inverse_inertia[0] = Vec3(1, 2, 3).cwiseInverse();
        const std::uint64_t steps = kolize::steps_in(time, scene.pipeline.step.dt);
        const bench::Reading reading = run(contestant, scene, steps, workshop);
        table.add({contestant.label(), number(reading.energy_error), number(reading.worst_energy_error),
                   number(reading.angular_momentum_error)});
    }
    table.print(std::cout);
}

void declare(CLI::App& app, Options& options) {
    app.add_option("--tables", options.tables, "What to measure")
        ->delimiter(',')
        ->check(CLI::IsMember({"wall", "shift", "spin"}))
        ->capture_default_str();
    app.add_option("--vary", options.vary, "KEY=V1,V2,... of kolize's pipeline: all combinations (repeatable)")
        ->allow_extra_args(false)
        ->capture_default_str();
    app.add_option("--rivals", options.rivals, "Other engines")
        ->delimiter(',')
        ->check(CLI::IsMember(bench::rival_names()))
        ->capture_default_str();
    app.add_option("--shift-time", options.shift_time, "Simulated time of the shifted scene in s")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--scenes", options.scenes, "Folder of cubes.toml, spin.toml and wall.toml")
        ->check(CLI::ExistingDirectory);
    kolize::cli::add_plugin_path_option(app, options.plugin_path);
    app.footer("Example: bench_extremes --tables wall,spin --vary step.mode=discrete,bisection");
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Where kolize, Bullet and ODE give up.");
    Options options;
    declare(app, options);
    CLI11_PARSE(app, argc, argv);
    try {
        const auto plugins = kolize::cli::open_plugins(options.plugin_path, options.scenes);
        const auto host = kolize::make_host(1);
        const std::vector<Contestant> contestants = enter(options);
        std::cout << bench::rival_versions() << '\n';
        for (const std::string& table : options.tables) {
            std::cout << '\n';
            const auto print = table == "wall" ? print_wall : table == "shift" ? print_shift : print_spin;
            print(options, contestants, {plugins, *host});
        }
    } catch (const std::exception& error) {
        std::cerr << "bench_extremes: " << error.what() << '\n';
        return 2;
    }
}
