// bench_massprops: the exact integrals against a plain loop, and the voxel method's rasteriser against Embree's rays.
#include "massprops_rivals.h"

#include "massprops/embree_lines.h"

#include <kolize/mesh_io.h>
#include <kolize/simulation.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numbers>
#include <thread>

namespace {

using kolize::MassProperties;
using kolize::TriangleSoup;
using kolize::Vec3;
using kolize::VoxelOptions;

struct Answer {
    MassProperties mass;
    std::uint64_t odd_lines = 0;
};

struct Method {
    std::string name;
    std::function<Answer()> run;
    std::vector<double> milliseconds = {};
    Answer answer = {};
};

// In turn, round by round, so that a disturbance of the machine falls on all. The first round warms up.
void run_all(std::vector<Method>& methods, std::size_t rounds) {
    using Clock = std::chrono::steady_clock;
    for (std::size_t round = 0; round <= rounds; ++round)
        for (Method& method : methods) {
            const auto start = Clock::now();
            method.answer = method.run();
            const std::chrono::duration<double, std::milli> took = Clock::now() - start;
            if (round > 0) method.milliseconds.push_back(took.count());
        }
}

double median(std::vector<double> values) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double volume_error(const MassProperties& mass, const MassProperties& exact) {
    return std::abs(mass.volume / exact.volume - 1);
}

double tensor_error(const MassProperties& mass, const MassProperties& exact) {
    return (mass.inertia_over_mass - exact.inertia_over_mass).norm() / exact.inertia_over_mass.norm();
}

// Times are also given as multiples of the first method's.
void print_table(const std::string& title, const std::vector<Method>& methods, const MassProperties& exact) {
    std::printf("\n%s\n%-44s %10s %7s %10s %10s %10s\n", title.c_str(), "", "median ms", "times", "volume err",
                "tensor err", "odd lines");
    for (const Method& method : methods) {
        const MassProperties& mass = method.answer.mass;
        const double time = median(method.milliseconds);
        std::printf("%-44s %10.2f %7.2f %10.1e %10.1e %10llu\n", method.name.c_str(), time,
                    time / median(methods.front().milliseconds), volume_error(mass, exact), tensor_error(mass, exact),
                    static_cast<unsigned long long>(method.answer.odd_lines));
    }
}

Answer by_voxels(const TriangleSoup& surface, const VoxelOptions& options, const kolize::MakeLineCaster& caster,
                 kolize::Host& host) {
    const auto result = kolize::voxel_mass_properties(surface, options, caster, host);
    Answer answer{result.mass};
    for (const kolize::VoxelPass& pass : result.passes) answer.odd_lines += pass.odd_lines;
    return answer;
}

// A closed surface of 75,000 triangles without symmetry to profit from.
TriangleSoup bumpy_torus() {
    constexpr std::uint32_t around = 250, across = 150;
    TriangleSoup torus;
    torus.file = "bumpy torus";
    const auto vertex = [&](std::uint32_t i, std::uint32_t j) { return i % around * across + j % across; };
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
            const double tube = 0.4 + 0.03 * std::sin(9 * a + 4 * b) + 0.02 * std::cos(23 * a - 7 * b);
            const double r = 1 + tube * std::cos(b) + 0.05 * std::sin(7 * a);
            torus.vertices.emplace_back(r * std::cos(a), r * std::sin(a), tube * std::sin(b) + 0.1 * std::cos(3 * a));
            torus.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            torus.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    return torus;
}

void compare_exact(const TriangleSoup& surface, std::size_t rounds) {
    constexpr int calls = 20;  // a round: one call is too short to time
    const auto repeated = [&](MassProperties (*compute)(const TriangleSoup&)) {
        return [&surface, compute] {
            for (int i = 1; i < calls; ++i) compute(surface);
            return Answer{compute(surface)};
        };
    };
    std::vector<Method> methods{{"kolize", repeated(kolize::mass_properties)},
                                {"one loop of running doubles", repeated(bench::scalar_mass_properties)}};
    run_all(methods, rounds);
    print_table("Exact integrals, 20 calls; errors are differences from the first", methods, methods[0].answer.mass);
    for (const Method& method : methods)
        std::printf("%-44s %10.2f ns a triangle\n", method.name.c_str(),
                    median(method.milliseconds) * 1e6 / calls / static_cast<double>(surface.triangles.size()));
}

void compare_lines(const TriangleSoup& surface, const VoxelOptions& options, const bench::SingleRays& single_rays,
                   int threads, std::size_t rounds) {
    const auto host = kolize::make_host(threads);
    const auto cast = [&](const kolize::MakeLineCaster& caster) {
        return [&, caster] { return by_voxels(surface, options, caster, *host); };
    };
    const auto with_tree = [&] { return by_voxels(surface, options, kolize::embree_line_caster(), *host); };
    std::vector<Method> methods{{"rasteriser", cast(kolize::make_line_rasteriser)},
                                {"Embree, packets of 16, tree built before", cast(kolize::embree_line_caster())},
                                {"Embree, packets of 16, with building it", with_tree},
                                {"Embree, one ray at a time, tree built before", cast(single_rays.line_caster())}};
    run_all(methods, rounds);
    print_table("Voxel method, " + std::to_string(threads) + " thread(s)", methods, kolize::mass_properties(surface));
}

// The same work for both: which voxel centres are inside.
void compare_points(const TriangleSoup& surface, int divisions, int full_divisions,
                    const bench::SingleRays& single_rays, std::size_t rounds) {
    const auto host = kolize::make_host(1);
    const auto centers = [](int cuts) {
        VoxelOptions options;
        options.step = -cuts;
        options.axes = 1;
        options.count = kolize::VoxelCount::midpoint;
        return options;
    };
    const auto grid_of = [&](const VoxelOptions& options) {
        return kolize::voxel_mass_properties(surface, options, kolize::make_line_rasteriser, *host).grid;
    };
    const auto voxels = [](const kolize::VoxelGrid& grid) { return grid.cells.cast<double>().prod(); };
    const VoxelOptions options = centers(divisions);
    const kolize::VoxelGrid grid = grid_of(options);
    const double full = voxels(grid_of(centers(full_divisions)));
    std::vector<Method> methods{
        {"rasteriser, lines along x", [&] { return by_voxels(surface, options, kolize::make_line_rasteriser, *host); }},
        {"Embree, a ray a voxel, tree built before", [&] { return Answer{single_rays.by_points(grid)}; }}};
    run_all(methods, rounds);
    print_table("Which of " + std::to_string(grid.cells.prod()) + " voxel centres are inside, 1 thread", methods,
                kolize::mass_properties(surface));
    const double per_voxel = median(methods[1].milliseconds) / voxels(grid);
    std::printf("A ray a voxel takes %.0f ns a voxel; EXTRAPOLATED, not measured, to %.3g voxels: %.0f s\n",
                per_voxel * 1e6, full, per_voxel * full / 1e3);
}

// Lines through the diagonals of the sides: a ray caster finds both of their triangles, or none.
void compare_cube(int threads, std::size_t rounds) {
    const TriangleSoup cube = kolize::box_soup(Vec3::Constant(250));
    VoxelOptions options;
    options.step = 0.4167;
    const auto host = kolize::make_host(threads);
    std::vector<Method> methods{
        {"rasteriser", [&] { return by_voxels(cube, options, kolize::make_line_rasteriser, *host); }},
        {"Embree, packets of 16, with building the tree",
         [&] { return by_voxels(cube, options, kolize::embree_line_caster(), *host); }}};
    run_all(methods, rounds);
    print_table("Cube of side 500, step 0.4167, 3 axes, " + std::to_string(threads) + " thread(s)", methods,
                kolize::mass_properties(cube));
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Mass properties by kolize, a plain loop and Embree. Example: bench_massprops --divisions 300");
    std::string model;
    int divisions = 600, naive_divisions = 60, axes = 3, threads = 1;
    std::size_t repeat = 7;
    app.add_option("--model", model, "closed mesh instead of the bumpy torus")->check(CLI::ExistingFile);
    app.add_option("--divisions", divisions, "cells along the longest side")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    app.add_option("--naive-divisions", naive_divisions, "the same where each voxel gets a ray of its own")
        ->check(CLI::Range(1, 2000))
        ->capture_default_str();
    app.add_option("--axes", axes, "axes that lines go along")->check(CLI::Range(1, 3))->capture_default_str();
    app.add_option("--threads", threads, "for the first of the two tables of lines")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--repeat", repeat, "timed rounds")->check(CLI::Range(1, 10000))->capture_default_str();
    CLI11_PARSE(app, argc, argv);

    try {
        const TriangleSoup surface = model.empty() ? bumpy_torus() : kolize::read_mesh(model);
        std::printf("%s: %zu triangles, %d divisions, %d axes; median of %zu rounds\n", surface.file.c_str(),
                    surface.triangles.size(), divisions, axes, repeat);
        std::puts("Debian's Embree is built without NDEBUG, with its assertions on; upstream's may be faster.");
        std::puts("It builds its tree on all cores, whatever the number of threads that cast rays.");
        VoxelOptions options;
        options.step = -divisions;
        options.axes = axes;
        const bench::SingleRays single_rays(surface);
        const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
        compare_exact(surface, repeat);
        compare_lines(surface, options, single_rays, threads, repeat);
        compare_lines(surface, options, single_rays, cores, repeat);
        compare_points(surface, naive_divisions, divisions, single_rays, repeat);
        compare_cube(threads, repeat);
    } catch (const kolize::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
