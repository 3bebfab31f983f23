// What lines find, one by one: nothing missed or counted twice on closed surfaces, and every gap noticed in open ones.
#include "framework/pieces.h"
#include "framework/round_solids.h"
#include "framework/voxel_runs.h"
#include "oracle/exact_lines.h"

#include <catch2/catch.hpp>

#include <tuple>

using namespace kolize;
using namespace kolize::test;

namespace {

// A sphere with bumps, its vertices at whole coordinates: closed, though flat and folded in places.
TriangleSoup whole_number_blob(std::mt19937& random, int levels, double radius) {
    std::uniform_real_distribution<double> factor(0.6, 1.0);
    TriangleSoup soup = unit_sphere(levels);
    for (std::size_t i = 0; i < soup.vertices.size(); ++i) {
        Vec3& v = soup.vertices[i];
        v = (v * radius * (i < 6 ? 1 : factor(random))).array().round();  // the first six keep the bounds
    }
    return soup;
}

Mat3 quarter_turns(double turns, const Vec3& axis) {
    return Eigen::AngleAxisd(turns * std::numbers::pi / 2, axis).toRotationMatrix();
}

struct Checked {
    std::size_t lines = 0, crossings = 0, samples = 0;
};

void check_line(const TriangleSoup& surface, const GridLines& lines, const Integers& point,
                std::span<const Crossing> crossings, Checked& checked) {
    int sum = 0;
    const std::vector<double> depths = crossings.empty() ? std::vector<double>() : exact_depths(surface, lines, point);
    for (const Crossing& crossing : crossings) {
        sum += crossing.sign;
        const auto is_here = [&](double depth) { return std::abs(depth - crossing.depth) <= 1e-12 * 20; };
        CHECK(std::any_of(depths.begin(), depths.end(), is_here));
        ++checked.crossings;
    }
    CHECK(sum == 0);
    for (Integers sample = point; sample[lines.axis] < 20 * 8; sample[lines.axis] += 51) {
        const auto exact = exact_winding(surface, sample);
        if (!exact) continue;
        int winding = 0;
        for (const Crossing& crossing : crossings)
            if (8 * crossing.depth < static_cast<double>(sample[lines.axis])) winding += crossing.sign;
        CHECK(winding == *exact);
        ++checked.samples;
    }
    ++checked.lines;
}

void check_lines(const TriangleSoup& surface, const GridLines& lines, Checked& checked) {
    const auto caster = make_line_rasteriser(surface, lines);
    const auto scan = caster->start();
    for (std::size_t band = 0; band < lines.bands(); ++band) {
        const LineCrossings& cast = scan->cast(band);
        std::size_t line = 0, begin = 0;
        for (std::size_t row = lines.first_row(band); row < lines.last_row(band); ++row)
            for (const double column : lines.columns) {
                Vec3 point;
                point[lines.axis] = -20.125;
                point[lines.column_axis] = column;
                point[lines.row_axis] = lines.rows[row];
                check_line(surface, lines, in_eighths(point), {&cast.crossings[begin], cast.end[line] - begin},
                           checked);
                begin = cast.end[line++];
            }
    }
}

TriangleSoup without_triangle(TriangleSoup soup, std::size_t triangle) {
    soup.triangles.erase(soup.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
    return soup;
}

// The two triangles of the face at the lower end of an axis.
std::vector<std::size_t> lower_face(const TriangleSoup& box, int axis, double low) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < box.triangles.size(); ++i) {
        const Triangle& t = box.triangles[i];
        if (std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return box.vertices[v][axis] == low; }))
            found.push_back(i);
    }
    return found;
}

}  // namespace

TEST_CASE("Hits become crossings line by line, by depth, and at the same depth the solid is left first", "[voxel]") {
    std::mt19937 random(3);
    LineCrossings sorted;  // used again and again, as scans do
    for (int repeat = 0; repeat < 200; ++repeat) {
        CAPTURE(repeat);
        const std::size_t lines = 1 + random() % 7;
        std::vector<LineHit> hits(random() % 40);
        for (LineHit& hit : hits)
            hit = {static_cast<double>(random() % 5), static_cast<std::uint32_t>(random() % lines),
                   random() % 2 ? 1 : -1};
        sort_hits(hits, lines, sorted);
        std::sort(hits.begin(), hits.end(), [](const LineHit& a, const LineHit& b) {
            return std::tie(a.line, a.depth, a.sign) < std::tie(b.line, b.depth, b.sign);
        });
        REQUIRE(sorted.end.size() == lines);
        REQUIRE(sorted.end.back() == hits.size());
        for (std::size_t i = 0; i < hits.size(); ++i) {
            CHECK(sorted.crossings[i].depth == hits[i].depth);
            CHECK(sorted.crossings[i].sign == hits[i].sign);
            CHECK(i < sorted.end[hits[i].line]);
            if (hits[i].line > 0) CHECK(i >= sorted.end[hits[i].line - 1]);
        }
    }
}

TEST_CASE("N4 parity: no line through vertices, edges and faces of a closed surface is odd", "[voxel]") {
    std::uint64_t lines = 0;
    const auto check = [&](const TriangleSoup& solid, const VoxelOptions& options) {
        const VoxelMassProperties voxel = voxels(solid, options, 2);
        CHECK(odd_lines_of(voxel) == 0);
        CHECK(voxel.mass.volume == Approx(mass_properties(solid).volume).epsilon(0.03));
        lines += lines_of(voxel);
    };
    TriangleSoup octahedron = unit_sphere(0);
    for (Vec3& v : octahedron.vertices) v *= 20;
    for (const TriangleSoup& solid : {box_soup(Vec3(20, 20, 20)), octahedron, cone48(), cone(4, 24, 40)})
        for (const double turns : {0.0, 0.5, 1.0})
            for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())})
                for (const double divisions : {-19.0, -20.0, -50.0, -101.0}) {
                    CAPTURE(solid.vertices.size(), turns, axis.transpose(), divisions);
                    check(moved(solid, quarter_turns(turns, axis), Vec3::Zero()), {.step = divisions});
                }
    // Lines at whole coordinates: each of the vertices is on one of them.
    std::mt19937 random(48);
    for (int repeat = 0; repeat < 2; ++repeat)
        for (const double shift : {0.25, -0.25}) {
            CAPTURE(repeat, shift);
            const TriangleSoup blob = whole_number_blob(random, 4, 400);
            check(blob, {.step = 4, .grid_shift = shift});
            check(blob, {.step = 2});
        }
    CHECK(lines >= 1000000);
}

TEST_CASE("Crossings are where exact arithmetic has them, and enclose what is inside", "[voxel]") {
    std::mt19937 random(77);
    Checked checked;
    for (int repeat = 0; repeat < 2; ++repeat) {
        CAPTURE(repeat);
        const TriangleSoup blob = whole_number_blob(random, 2, 20);
        // Through every fourth whole coordinate, through every second one, and between them.
        for (const VoxelOptions& options :
             {VoxelOptions{.step = 4, .grid_shift = 0.25}, VoxelOptions{.step = 2}, VoxelOptions{.step = 2.5}}) {
            const VoxelGrid grid = make_voxel_grid({Vec3::Constant(-20), Vec3::Constant(20)}, options);
            for (int axis = 0; axis < 3; ++axis) {
                CAPTURE(options.step, axis);
                check_lines(blob, GridLines(grid, options.grid_shift, axis), checked);
            }
        }
    }
    CHECK(checked.lines == 2 * 3 * (100 + 400 + 256));
    CHECK(checked.crossings > checked.lines / 2);
    CHECK(checked.samples > 4 * checked.lines);
}

TEST_CASE("Where a face is missing, all lines through it are odd", "[voxel]") {
    const TriangleSoup box = box_soup(Vec3(1, 2, 3));
    for (int axis = 0; axis < 3; ++axis) {
        CAPTURE(axis);
        const auto face = lower_face(box, axis, -axis - 1);
        REQUIRE(face.size() == 2);
        const VoxelMassProperties voxel =
            voxels(without_triangle(without_triangle(box, face[1]), face[0]), {.step = 0.1});
        for (const VoxelPass& pass : voxel.passes) CHECK(pass.odd_lines == (pass.axis == axis ? pass.lines : 0));
        REQUIRE_FALSE(voxel.odd_lines.empty());
        CHECK(voxel.odd_lines[0].axis == axis);
        CHECK(voxel.odd_lines[0].crossings == 1);
        CHECK(voxel.odd_lines[0].point[axis] == Approx(axis + 1));
        CHECK(voxel.mass.volume == Approx(48));  // of the two axes that see nothing of it
    }
}

TEST_CASE("A missing triangle makes those lines odd that go through it", "[voxel]") {
    const TriangleSoup box = box_soup(Vec3(1, 2, 3));
    for (int axis = 0; axis < 3; ++axis)
        for (const double shift : {0.0, 0.3}) {
            CAPTURE(axis, shift);
            const auto face = lower_face(box, axis, -axis - 1);
            const VoxelOptions options{.step = -60, .grid_shift = shift};
            const auto odd_without = [&](std::size_t triangle) {
                return voxels(without_triangle(box, triangle), options)
                    .passes[static_cast<std::size_t>(axis)]
                    .odd_lines;
            };
            const std::uint64_t one = odd_without(face[0]), other = odd_without(face[1]);
            const std::uint64_t all = voxels(box, options).passes[static_cast<std::size_t>(axis)].lines;
            CHECK(one + other == all);  // a line through their common edge is in one of the two
            CHECK(static_cast<double>(one) / static_cast<double>(all) == Approx(0.5).margin(0.02));
        }
}

TEST_CASE("What two overlapping cubes have in common counts twice, and is told", "[voxel]") {
    const TriangleSoup cubes =
        both(box_between(Vec3(0, 0, 0), Vec3(4, 4, 4)), box_between(Vec3(2, 1, 3), Vec3(6, 5, 7)));
    const VoxelMassProperties voxel = voxels(cubes, {.step = 0.5});
    CHECK(odd_lines_of(voxel) == 0);
    CHECK(voxel.mass.volume == Approx(128).epsilon(1e-12));
    CHECK((voxel.mass.center_of_mass - Vec3(3, 2.5, 3.5)).norm() <= 1e-12);
    CHECK((voxel.mass.inertia_over_mass - mass_properties(cubes).inertia_over_mass).norm() <= 1e-12 * 10);
    for (const VoxelPass& pass : voxel.passes) {
        CHECK(pass.covered_twice == Approx(2 * 3 * 1).epsilon(1e-12));
        CHECK(pass.inside_out == 0);
    }
}

TEST_CASE("A cube that is inside out has its volume inside out", "[voxel]") {
    const VoxelMassProperties voxel = voxels(inside_out(box_between(Vec3(0, 0, 0), Vec3(4, 4, 4))), {.step = 0.7});
    CHECK(odd_lines_of(voxel) == 0);
    CHECK(voxel.mass.volume == Approx(-64).epsilon(1e-12));
    CHECK((voxel.mass.center_of_mass - Vec3(2, 2, 2)).norm() <= 1e-12);
    for (const VoxelPass& pass : voxel.passes) {
        CHECK(pass.inside_out == Approx(64).epsilon(1e-12));
        CHECK(pass.covered_twice == 0);
    }
}

TEST_CASE("A cavity is left out", "[voxel]") {
    const TriangleSoup hollow =
        both(box_between(Vec3(0, 0, 0), Vec3(6, 6, 6)), inside_out(box_between(Vec3(1, 2, 3), Vec3(3, 4, 5))));
    const VoxelMassProperties voxel = voxels(hollow, {.step = 0.5});
    const MassProperties exact = mass_properties(hollow);
    CHECK(odd_lines_of(voxel) == 0);
    CHECK(voxel.mass.volume == Approx(216 - 8).epsilon(1e-12));
    CHECK((voxel.mass.center_of_mass - exact.center_of_mass).norm() <= 1e-12 * 6);
    CHECK((voxel.mass.inertia_over_mass - exact.inertia_over_mass).norm() <= 1e-12 * 36);
    for (const VoxelPass& pass : voxel.passes) {
        CHECK(pass.covered_twice == 0);
        CHECK(pass.inside_out == 0);
    }
}
