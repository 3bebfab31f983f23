// Writes the start states of the scenes of bench_scenes: make_bench_scenes DIR, DIR being bench/scenes. The scene files
// themselves are written by hand.
#include "make_models/models.h"

#include <kolize/mass_properties.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

using namespace kolize;
using namespace kolize::models;

namespace {

void write_text(const std::filesystem::path& file, const std::string& text) {
    if (!(std::ofstream(file, std::ios::binary) << text).flush())
        throw Error(SourceLocation{file.string()}, "this file cannot be written");
}

// Centres at random in a cube about the origin, no two closer than `distance`: random sequential addition.
std::vector<Vec3> scattered(std::size_t count, double half_side, double distance, Random& random) {
    std::vector<Vec3> centers;
    while (centers.size() < count) {
        Vec3 p;
        for (double& x : p) x = half_side * (2 * random.uniform() - 1);
        bool is_free = true;
        for (const Vec3& other : centers) is_free = is_free && (p - other).norm() > distance;
        if (is_free) centers.push_back(p);
    }
    return centers;
}

// A thousand bodies of a sphere around each of the given radius, that do not touch each other or the room.
std::string gas(double half_room, double radius, bool turned, std::uint64_t seed) {
    constexpr double slack = 1e-3;  // m
    Random random(seed);
    std::string text = state_header;
    for (const Vec3& center : scattered(1000, half_room - radius - slack, 2 * radius + slack, random)) {
        const Quat attitude = turned ? random.attitude() : Quat(Quat::Identity());
        text += state_row({center, attitude, random.in_ball(5), Vec3::Zero()});
    }
    return text;
}

// A square of balls side by side at one height, at rest.
std::string row_of_balls(int side, double spacing, double height) {
    std::string text = state_header;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            text += state_row(
                {spacing * Vec3(i, 0, j) + height * Vec3::UnitY(), Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
    return text;
}

// A square of columns of unit cubes with gaps between them, each cube a little beside the one below.
std::string columns(int side, int height, double spacing, double gap, double jitter, std::uint64_t seed) {
    Random random(seed);
    std::string text = state_header;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            for (int k = 0; k < height; ++k) {
                const Vec3 place(spacing * (i - 0.5 * (side - 1)), 0.5 + gap + k * (1 + gap),
                                 spacing * (j - 0.5 * (side - 1)));
                const Vec3 aside(random.uniform() - 0.5, 0, random.uniform() - 0.5);
                text += state_row({place + 2 * jitter * aside, Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
            }
    return text;
}

// In the room of fighters.toml, with the model at a hundredth of its size.
std::string fighters() {
    StateWriter states(2.85, 0.1, 5, 1, 4);
    return states.table(27, 0.01 * mass_properties(fighter()).center_of_mass);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: make_bench_scenes DIR\nWrites the start states of the scenes of bench_scenes to DIR.\n";
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        write_text(folder / "spheres.csv", gas(8.7, 0.5, false, 1));
        write_text(folder / "cubes.csv", gas(10.8, 0.5 * std::sqrt(3.0), true, 2));
        write_text(folder / "fighters.csv", fighters());
        write_text(folder / "pile.csv", columns(10, 10, 1.1, 0.08, 0.02, 3));
        write_text(folder / "balls.csv", row_of_balls(7, 1, 5));
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
