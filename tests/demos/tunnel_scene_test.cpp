#include "demos/tunnel_games.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace kolize;
using namespace kolize::test;

namespace {

const std::string north = "(0 0 1) 0";

// A tunnel of three cubes with these statics and dynamics in the middle one.
std::string with_bodies(const std::string& statics, const std::string& dynamics) {
    return "S (0 0 0)(0 1 0) 1.0 END END\nI (0 0 -1)(0 0 1) 0\n" + statics + " END\n" + dynamics +
           " END\nS (0 0 -2)(0 0 1) 0 END END";
}

// What is wrong with it, without the folder.
std::string complaint_about(const std::string& text, const Scene& base = game_base()) {
    std::string complaint = complaint_of([&] { require_apart(tunnel_of(text, base), game_plugins(), *game_host()); });
    const std::string folder = (tunnel_folder / "tunnels").string() + "/";
    for (std::size_t at; (at = complaint.find(folder)) != std::string::npos;) complaint.erase(at, folder.size());
    return complaint;
}

bool is_wall(const World& world, std::uint32_t body) { return is_room_wall(world, body); }

// The cube that a grid files the body under: the one that the lowest corner of its bounds is in.
Place cube_of(const World& world, std::uint32_t body) {
    constexpr double rounding = 1e-9;
    return (world_bounds(world, body).min / cube_side + Vec3::Constant(rounding)).array().floor().cast<int>();
}

bool neighbours(const World& world, std::uint32_t a, std::uint32_t b) {
    return (cube_of(world, a) - cube_of(world, b)).cwiseAbs().maxCoeff() <= 1;
}

}  // namespace

TEST_CASE("Walls of a cell stand inside its own cube, in every cell of every tunnel", "[tunnel]") {
    for (const std::string& name : tunnel_names) {
        const TunnelScene tunnel = project_tunnel(name);
        const Simulation simulation(tunnel.scene, game_plugins(), *game_host(), 1);
        const World& world = simulation.world();
        std::size_t walls = 0, sides = 0;
        for (const Cell& cell : tunnel.tunnel.cells) sides += 6 - openings(cell).size();
        for (std::uint32_t body = 0; body < world.size(); ++body) {
            if (!is_wall(world, body)) continue;
            ++walls;
            const Aabb box = world_bounds(world, body);
            const auto cell = cell_at(tunnel.tunnel, box.center());
            CAPTURE(name, world.name[body]);
            REQUIRE(cell);
            const Vec3 center = center_of(tunnel.tunnel.cells[*cell]);
            CHECK((box.max - center).maxCoeff() <= cube_side / 2 + 1e-12);
            CHECK((center - box.min).maxCoeff() <= cube_side / 2 + 1e-12);
            Vec3 size = 2 * box.half_extents();
            std::sort(size.begin(), size.end());
            CHECK(size[0] == Approx(wall_thickness));
            CHECK(size[2] == Approx(cube_side));
        }
        CHECK(walls == sides);
    }
}

// Rays from the middle of each cell in all directions, by hand: they must meet a wall or a static body before they have
// left the cells, whichever way they go.
TEST_CASE("There is no way out of a tunnel but through its cells", "[tunnel]") {
    const TunnelScene tunnel = project_tunnel("the_deep");
    const Simulation simulation(tunnel.scene, game_plugins(), *game_host(), 1);
    const World& world = simulation.world();
    std::vector<Aabb> solids;  // walls and posts are boxes along the axes
    for (std::uint32_t body = 0; body < world.size(); ++body)
        if (world.is_static[body] && world.shape_of(body).kind == ShapeKind::box)
            solids.push_back(world_bounds(world, body));
    const auto is_solid = [&](const Vec3& p) {
        return std::any_of(solids.begin(), solids.end(), [&](const Aabb& box) {
            return (p - box.center()).cwiseAbs().cwiseQuotient(box.half_extents()).maxCoeff() <= 1;
        });
    };
    for (const Cell& cell : tunnel.tunnel.cells)
        for (int ray = 0; ray < 300; ++ray) {
            const double height = (ray + 0.5) / 150 - 1, angle = 2.399963 * ray, flat = std::sqrt(1 - height * height);
            const Vec3 direction(flat * std::cos(angle), height, flat * std::sin(angle));
            Vec3 p = center_of(cell);
            while (!is_solid(p) && cell_at(tunnel.tunnel, p)) p += 0.2 * direction;
            CAPTURE(cell.place.transpose(), direction.transpose());
            CHECK(is_solid(p));
        }
}

TEST_CASE("The fighter is 9 m long, stands in the first cell and looks along the tunnel", "[tunnel]") {
    const TunnelScene tunnel = tunnel_of(short_tunnel);
    const World& world = tunnel.scene.world;
    Aabb box;
    for (const Vec3& vertex : world.shape_of(tunnel.fighter).mesh->vertices)
        box.include(world.pose(tunnel.fighter) * vertex);
    CHECK(box.max.z() - box.min.z() == Approx(9));
    CHECK(cell_at(tunnel.tunnel, world.position[tunnel.fighter]) == 0u);
    const Quat axes = axes_of(world, tunnel.fighter);
    CHECK((axes * Vec3::UnitX()).isApprox(-Vec3::UnitZ()));
    CHECK((axes * Vec3::UnitY()).isApprox(Vec3::UnitY()));
    CHECK(1 / world.inverse_mass[tunnel.fighter] == Approx(1000));
    CHECK(tunnel.missiles.size() == missiles_at_once);
    for (const std::uint32_t missile : tunnel.missiles) {
        CHECK(world.removed[missile] == 1);
        CHECK(world.kinds[world.kind[missile]] == "missile");
    }
}

TEST_CASE("In a tunnel that begins upward the fighter looks up", "[tunnel]") {
    const TunnelScene tunnel = tunnel_of("S (0 0 0)(1 0 0) -0.5 END END S (0 1 0)(1 0 0) 0.5 END END");
    const Quat axes = axes_of(tunnel.scene.world, tunnel.fighter);
    CHECK((axes * Vec3::UnitX()).isApprox(Vec3::UnitY()));
}

TEST_CASE("Bodies stand where the file says, in half cubes of their own cell, turned with it", "[tunnel]") {
    const TunnelScene tunnel = tunnel_of(
        "S (0 0 0)(0 1 0) 0.5 END END\n"
        "I (1 0 0)(0 1 0) -0.5 models/frustum.obj (0 -0.5 0.25)(0 0 1) 0 END ball (0.1 0.2 -0.3)(0 0 1) 0 END\n"
        "S (2 0 0)(0 1 0) -0.5 END END");
    const World& world = tunnel.scene.world;
    const auto frustum = std::find(world.name.begin(), world.name.end(), "models/frustum.obj.0") - world.name.begin();
    const auto ball = std::find(world.name.begin(), world.name.end(), "ball.1") - world.name.begin();
    REQUIRE(static_cast<std::size_t>(ball) < world.size());
    // The cell's -z is the world's +x, so its +z is -x and its +x is +z.
    const Vec3 center(60, 20, 20);
    CHECK(world.model_position(frustum).isApprox(center + Vec3(-5, -10, 0)));
    CHECK(world.position[ball].isApprox(center + Vec3(6, 4, 2)));
    CHECK(world.kinds[world.kind[frustum]] == "static");
    CHECK(world.kinds[world.kind[ball]] == "ball");
    CHECK(world.is_static[frustum] == 1);
    CHECK(world.is_static[ball] == 0);
}

TEST_CASE("Bodies that do not fit are refused where the file names them", "[tunnel]") {
    const std::string crate = "models/crate.obj";  // 4 m wide: 0.1 half cubes on each side of its centre
    const std::vector<std::pair<std::string, std::string>> table = {
        {with_bodies("", "nothing.obj (0 0 0)(0 0 1) 0"), "test.txt:4:1: there is no mesh file nothing.obj"},
        {with_bodies("models (0 0 0)(0 0 1) 0", ""), "test.txt:3:1: there is no mesh file models"},
        {with_bodies("", crate + " (0 0 0.95)" + north),
         "test.txt:4:1: 'models/crate.obj' reaches out of its cell, 21.000000 m from its centre; half a cube is "
         "20.000000 m"},
        {with_bodies("", "ball (0 1.5 0)" + north),
         "test.txt:4:1: 'ball' reaches out of its cell, 32.000000 m from its centre; half a cube is 20.000000 m"},
        {with_bodies("", "ball (0 1e308 0)" + north), "test.txt:4:1: 'ball': body 'ball.0': position is not finite"},
        {with_bodies("", crate + " (0 0 0)" + north + "\n" + crate + " (0.19 0 0)" + north),
         "test.txt:4:1: the body of line 4, column 1 overlaps the body of line 5, column 1 at the start; only static "
         "bodies "
         "may overlap each other"},
        {with_bodies("models/gate.obj (0 0 0)" + north, "ball (0.7 0 0)" + north),
         "test.txt:4:1: the body of line 4, column 1 overlaps the body of line 3, column 1 at the start; only static "
         "bodies "
         "may overlap each other"},
        {with_bodies("", "ball (0.87 0 0)" + north),
         "test.txt:4:1: the body of line 4, column 1 overlaps a wall at the start; only static bodies may overlap each "
         "other"},
        {"S (0 0 0)(0 1 0) 1.0 ball (0 0 0.05)" + north + " END END S (0 0 -1)(0 0 1) 0 END END",
         "test.txt:1:22: the body of line 1, column 22 overlaps the fighter at the start; only static bodies may "
         "overlap "
         "each other"}};
    for (const auto& [text, complaint] : table) {
        CAPTURE(text);
        CHECK(complaint_about(text) == complaint);
    }
    // A gem is 6 m high and 4.2 m wide. Turned by an eighth it reaches 2.12 m, the box around it 3.6 m.
    const auto gem_at = [](const std::string& x) { return "models/gem.obj (" + x + " 0 0)(0 0 1) 0.25"; };
    CHECK(complaint_about(with_bodies(gem_at("0.89"), "")).empty());
    CHECK(complaint_about(with_bodies(gem_at("0.9"), "")).find("reaches out of its cell") != std::string::npos);
    CHECK(complaint_about(with_bodies("models/gate.obj (0 0 0)" + north + " models/pillar.obj (0.8 0 0)" + north,
                                      crate + " (0 0 0)" + north + "\n" + crate + " (0.21 0 0)" + north))
              .empty());
}

TEST_CASE("A mesh that is not the surface of a solid is refused where the file names it", "[tunnel]") {
    const ScratchFolder folder;
    folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Tunnel tunnel = parse_tunnel(with_bodies("", "open.obj (0 0 0)(0 0 1) 0"), folder.path() / "t.txt");
    const std::string complaint = complaint_of([&] { make_tunnel_scene(tunnel, game_base(), find_places().fighter); });
    CHECK(complaint.find("t.txt:4:1: 'open.obj': the mesh must be the closed surface of a solid") != std::string::npos);
}

TEST_CASE("The tunnels of the project start with everything apart, in every pipeline", "[tunnel]") {
    for (const std::string& name : tunnel_names)
        for (const std::string pipeline : {"", "fast", "accurate", "thesis"}) {
            CAPTURE(name, pipeline);
            const TunnelScene tunnel = project_tunnel(name, game_base({}, pipeline));
            CHECK(complaint_of([&] { require_apart(tunnel, game_plugins(), *game_host()); }).empty());
        }
}

TEST_CASE("No box is larger than a cube, so that bodies of cubes that are no neighbours never meet", "[tunnel]") {
    for (const std::string& name : tunnel_names) {
        const TunnelScene tunnel = project_tunnel(name);
        const Simulation simulation(tunnel.scene, game_plugins(), *game_host(), 1);
        const World& world = simulation.world();
        for (std::uint32_t body = 0; body < world.size(); ++body) {
            CAPTURE(name, world.name[body]);
            CHECK(2 * world_bounds(world, body).half_extents().maxCoeff() <= cube_side + 1e-9);
        }
    }
}

TEST_CASE("Tests between neighbouring cubes are a fraction of all, and nothing is lost by them", "[tunnel]") {
    const TunnelScene grid = project_tunnel("the_deep");
    Scene every = grid.scene;
    every.pipeline.broadphase = {"brute_force", {}, {}};
    Simulation cubes(grid.scene, game_plugins(), *game_host(), 1000), all(every, game_plugins(), *game_host(), 1000);
    PlaceInput flying{grid.fighter, grid.scene.world.state(grid.fighter)};
    flying.state.velocity = {0, 0, -35};  // past the first swarm and into the wall behind it
    cubes.apply(flying);
    all.apply(flying);
    const World& world = all.world();
    std::uint64_t candidates = 0, possible = 0, pairs = 0;
    for (int step = 0; step < 700; ++step) {
        cubes.step();
        all.step();
        for (const Pair& pair : all.pairs()) CHECK(neighbours(world, pair.a, pair.b));
        pairs += all.pairs().size();
        if (step % 100 != 0) continue;
        for (std::uint32_t a = 0; a < world.size(); ++a)
            for (std::uint32_t b = 0; b < a; ++b) {
                if ((world.is_static[a] && world.is_static[b]) || world.removed[a] || world.removed[b]) continue;
                ++possible;
                candidates += neighbours(world, a, b);
            }
    }
    CHECK(pairs > 0);
    CHECK(all.result().contacts > 0);
    CHECK(candidates < possible / 3);
    CHECK(cubes.state_hash() == all.state_hash());
}
