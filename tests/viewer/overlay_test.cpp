// Overlays: lines that show what a stage did, checked against what is known of the scene.
#include "framework/liars.h"
#include "overlay/overlay.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <map>
#include <sstream>

using namespace kolize;
using namespace kolize::cli;
using namespace kolize::test;

namespace {

struct Table {
    explicit Table(const Scene& scene, int steps = 1) : host(make_host(1)), simulation(scene, plugins(), *host, 100) {
        for (int i = 0; i < steps; ++i) simulation.step();
    }
    std::vector<Line> lines(const std::string& names) const {
        std::vector<Line> lines;
        Overlays(names).draw(simulation, plugins(), lines);
        return lines;
    }
    std::string refusal(const std::string& name) const { return overlay_refusal(name, simulation, plugins()); }

    std::unique_ptr<Host> host;
    Simulation simulation;
};

Aabb extent(const std::vector<Line>& lines) {
    Aabb box;
    for (const Line& line : lines) {
        box.include(line.from);
        box.include(line.to);
    }
    return box;
}

void check_box(const Aabb& box, const Vec3& min, const Vec3& max) {
    CHECK((box.min - min).norm() < 1e-5);
    CHECK((box.max - max).norm() < 1e-5);
}

std::uint32_t add(Scene& scene, const Shape& shape, const Vec3& position, const Vec3& velocity = Vec3::Zero(),
                  bool is_static = false) {
    BodyDescription body;
    give(body, add_shape(scene, shape), position, velocity).is_static = is_static;
    return scene.world.add(body);
}

// Two balls that overlap by 0.2 m on the x axis, one that only comes near, and one far away.
Scene balls() {
    Scene scene = empty_scene();
    scene.pipeline.step.dt = 1e-6;
    add(scene, make_sphere("a", 1), Vec3(-0.9, 0, 0), Vec3(1, 0, 0));
    add(scene, make_sphere("b", 1), Vec3(0.9, 0, 0), Vec3(-1, 0, 0));
    add(scene, make_sphere("c", 1), Vec3(2.5, 1.9, 0));  // its box overlaps that of b
    add(scene, make_sphere("d", 0.5), Vec3(0, 0, 30));
    return scene;
}

// Corner (1, 1, 1) of one box is 0.5 m deep in another: the surfaces cross in three squares' halves, a hexagon with
// right angles whose edges are 0.5 m long.
Scene corner_in_corner() {
    Scene scene = empty_scene();
    scene.pipeline.step.dt = 1e-9;
    add(scene, make_box("lower", Vec3::Ones()), Vec3::Zero(), Vec3::Constant(1));
    add(scene, make_box("upper", Vec3::Ones()), Vec3::Constant(1.5), Vec3::Constant(-1));
    return scene;
}

}  // namespace

TEST_CASE("Overlay bounds: a box of twelve edges around each body that has one", "[overlay]") {
    Scene scene = balls();
    scene.world.removed[3] = 1;
    add(scene, make_half_space("floor", Vec3::UnitY(), -5), Vec3::Zero(), Vec3::Zero(), true);
    const Table table(scene);
    const std::vector<Line> lines = table.lines("bounds");
    CHECK(lines.size() == 3 * 12);
    check_box(extent(lines), Vec3(-1.9, -1, -1), Vec3(3.5, 2.9, 1));
}

TEST_CASE("Overlays pairs and rejected: centres of what the broadphase found, and what came to nothing", "[overlay]") {
    const Table table(balls());
    const std::vector<Line> pairs = table.lines("pairs"), rejected = table.lines("rejected");
    REQUIRE(pairs.size() == 2);
    CHECK((pairs[0].from - Vec3(-0.9, 0, 0)).norm() < 1e-5);
    CHECK((pairs[0].to - Vec3(0.9, 0, 0)).norm() < 1e-5);
    REQUIRE(rejected.size() == 1);
    CHECK((rejected[0].from - Vec3(0.9, 0, 0)).norm() < 1e-5);
    CHECK((rejected[0].to - Vec3(2.5, 1.9, 0)).norm() < 1e-5);
}

TEST_CASE("Overlays contacts, normals and impulses: where bodies touch, which way, and how hard", "[overlay]") {
    Scene scene = balls();
    add(scene, make_sphere("e", 1), Vec3(-0.9, 20, 0), Vec3(0.25, 0, 0));  // a softer hit of the same kind
    add(scene, make_sphere("f", 1), Vec3(0.9, 20, 0), Vec3(-0.25, 0, 0));
    const Table table(scene);
    REQUIRE(table.simulation.contacts().rows.size() == 2);
    const std::vector<Line> points = table.lines("contacts");
    REQUIRE(points.size() == 6);
    CHECK((extent({points.begin(), points.begin() + 3}).center()).norm() < 1e-5);
    const std::vector<Line> normals = table.lines("normals");
    REQUIRE(normals.size() == 10);
    CHECK((normals[0].to - normals[0].from).normalized().dot(Vec3::UnitX()) == Approx(1));
    const std::vector<Line> impulses = table.lines("impulses");
    REQUIRE(impulses.size() == 10);
    const auto length = [](const Line& line) { return (line.to - line.from).norm(); };
    CHECK(length(impulses[0]) == Approx(length(normals[0])));
    CHECK(length(impulses[5]) == Approx(0.25 * length(impulses[0])));
}

TEST_CASE("Overlays segments and loops: the closed curve in which two boxes cross", "[overlay]") {
    const Table table(corner_in_corner());
    const std::vector<Line> segments = table.lines("segments");
    double length = 0;
    for (const Line& line : segments) {
        length += (line.to - line.from).norm();
        for (const Vec3& p : {line.from, line.to}) {
            CHECK(p.minCoeff() == Approx(0.5).margin(1e-6));  // on the faces of the upper box
            CHECK(p.maxCoeff() == Approx(1).margin(1e-6));    // and of the lower one
        }
        const auto begins = [&](const Line& other) { return (other.from - line.to).norm() < 1e-9; };
        const auto ends = [&](const Line& other) { return (other.to - line.to).norm() < 1e-9; };
        CHECK(std::count_if(segments.begin(), segments.end(), begins) ==
              std::count_if(segments.begin(), segments.end(), ends));  // some segments have no length
    }
    CHECK(length == Approx(6 * 0.5).epsilon(1e-6));
    const std::vector<Line> loops = table.lines("loops");
    CHECK(loops.size() == segments.size());
    for (const Line& line : loops) CHECK(line.colour == loops[0].colour);
}

TEST_CASE("Overlay loops: two places of contact have two colours", "[overlay]") {
    Scene scene = empty_scene();
    scene.pipeline.step.dt = 1e-9;
    add(scene, make_box("bar", Vec3(3, 0.2, 0.2)), Vec3::Zero(), Vec3::UnitY());
    add(scene, make_box("slab", Vec3(0.3, 1, 1)), Vec3(0.1, 0, 0));  // the bar goes right through it
    const Table table(scene);
    std::map<Rgba, double> length;
    for (const Line& line : table.lines("loops")) length[line.colour] += (line.to - line.from).norm();
    REQUIRE(length.size() == 2);
    for (const auto& [colour, sum] : length) CHECK(sum == Approx(4 * 0.4).epsilon(1e-6));
}

TEST_CASE("Overlay cells: a cube for each cell that is filled, of the size asked for", "[overlay]") {
    Scene scene = balls();
    scene.pipeline.broadphase = stage("grid", {{"cell_size", 4.0}});
    const Table table(scene);
    const std::vector<Line> lines = table.lines("cells");
    REQUIRE(lines.size() % 12 == 0);
    for (const Line& line : lines) CHECK((line.to - line.from).norm() == Approx(4).epsilon(0.01));
    // Every box begins in one of them.
    for (std::uint32_t body = 0; body < 4; ++body) {
        const Vec3 corner = world_bounds(table.simulation.world(), body).min + Vec3::Constant(1e-9);
        bool found = false;
        for (std::size_t i = 0; i < lines.size(); i += 12) {
            const Aabb cell = extent(
                {lines.begin() + static_cast<std::ptrdiff_t>(i), lines.begin() + static_cast<std::ptrdiff_t>(i + 12)});
            found |= cell.overlaps({corner, corner});
        }
        CHECK(found);
    }
}

TEST_CASE("Overlay planes: rectangles that have bodies on either side", "[overlay]") {
    Scene scene = gas(make_sphere("ball", 0.2), 4, 2, 3);
    scene.pipeline.broadphase = stage("bsp", {{"leaf_size", std::int64_t(4)}});
    const Table table(scene);
    CHECK(table.lines("planes").size() > table.lines("planes:0").size());
    const std::vector<Line> first = table.lines("planes:0");
    REQUIRE(first.size() == 4);
    const Aabb plane = extent(first);
    int axis = 0;
    while (axis < 3 && plane.max[axis] - plane.min[axis] > 0) ++axis;
    REQUIRE(axis < 3);
    int below = 0, above = 0;
    for (std::uint32_t body = 0; body < 64; ++body)
        (table.simulation.world().position[body][axis] < plane.min[axis] ? below : above) += 1;
    CHECK(below > 16);
    CHECK(above > 16);
}

TEST_CASE("Overlay spheres: the one at the root holds all bodies", "[overlay]") {
    Scene scene = balls();
    scene.pipeline.broadphase = stage("sphere_hierarchy");
    const Table table(scene);
    const std::vector<Line> root = table.lines("spheres:0");
    REQUIRE(root.size() == 96);
    const Aabb box = extent(root);
    const double radius = box.half_extents().maxCoeff();
    for (std::uint32_t body = 0; body < 4; ++body) {
        const World& world = table.simulation.world();
        CHECK((world.position[body] - box.center()).norm() + world.shape_of(body).radius <= radius * 1.01);
    }
    CHECK(table.lines("spheres").size() > root.size());
}

namespace {

// The names, as a list.
template <class Predicate>
std::string plugins_that(StageKind stage, Predicate&& can) {
    std::string list;
    for (const std::string& name : plugins().names(stage))
        if (can(plugins().find(stage, name)->descriptor->capabilities)) list += (list.empty() ? "" : ", ") + name;
    return list;
}

std::string outlined(const std::string& what) {
    return plugins_that(StageKind::broadphase,
                        [&](const Capabilities& can) { return can.outline && what == can.outline; });
}

}  // namespace

TEST_CASE("An overlay says what it needs, and which plugins would do", "[overlay]") {
    const Table table(balls());
    CHECK(table.refusal("planes") ==
          "overlay 'planes' needs a broadphase that divides space by planes, and 'brute_force' does not; these would "
          "do: " +
              outlined("planes"));
    CHECK(table.refusal("cells").ends_with("these would do: " + outlined("cells")));
    CHECK(table.refusal("bounds").empty());
    CHECK(table.refusal("segments").empty());
    CHECK(table.refusal("normals").empty());
    CHECK_THROWS_WITH(Overlays("pairs,planes").require(table.simulation, plugins()), table.refusal("planes"));
    CHECK(table.lines("planes").empty());

    Scene scene = balls();
    scene.pipeline.responses = {{stage("explode"), {}}};
    const Table exploding(scene, 0);
    CHECK(exploding.refusal("impulses") ==
          "overlay 'impulses' needs a response that asks for normals, and 'explode' does not; these would do: " +
              plugins_that(StageKind::response, [](const Capabilities& can) { return can.uses >= Detail::normal; }));
}

TEST_CASE("Names of overlays are read one by one", "[overlay]") {
    Overlays overlays("pairs,spheres:2");
    CHECK(overlays.is_shown("pairs"));
    CHECK(overlays.is_shown("spheres"));
    overlays.show("pairs", false);
    overlays.show("bounds", true);
    CHECK_FALSE(overlays.is_shown("pairs"));
    CHECK(overlays.is_shown("bounds"));
    CHECK_THROWS_WITH(Overlays("pears"),
                      Catch::StartsWith("--overlay pears: there is no such overlay; there are bounds, cells"));
    CHECK_THROWS_WITH(Overlays("pairs:2"), Catch::Contains("a level is a number after cells, planes or spheres"));
    CHECK_THROWS_WITH(Overlays("spheres:x"), Catch::Contains("a level is a number"));
}

TEST_CASE("Looking on changes nothing of the run", "[overlay]") {
    for (const char* broadphase : {"grid", "bsp", "sphere_hierarchy"}) {
        Scene scene = gas(make_box("box", Vec3(0.4, 0.5, 0.3)), 3, 1.2, 8);
        scene.pipeline.broadphase = stage(broadphase);
        Table watched(scene, 0), alone(scene, 0);
        std::size_t lines = 0;
        for (int i = 0; i < 60; ++i) {
            watched.simulation.step();
            alone.simulation.step();
            lines += watched.lines("bounds,cells,planes,spheres,pairs,rejected,segments,contacts,impulses").size();
        }
        CHECK(lines > 1000);
        CHECK(watched.simulation.state_hash() == alone.simulation.state_hash());
    }
}

TEST_CASE("Every overlay is in the docs, with what it shows and needs", "[overlay][docs]") {
    std::ifstream file(KOLIZE_SOURCE_DIR "/docs/overlays.md");
    std::stringstream docs;
    docs << file.rdbuf();
    for (const OverlayText& text : overlay_texts()) {
        const std::string row = std::string("| `") + text.name + "` | " + text.shows + " | " + text.needs + " |";
        CAPTURE(row);
        CHECK(docs.str().find(row) != std::string::npos);
    }
}
