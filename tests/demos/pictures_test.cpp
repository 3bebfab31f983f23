// The demos as they are seen: a second of each, drawn without a display.
#include "film/view.h"
#include "render/studio.h"

#include <catch2/catch.hpp>

#include <set>

using namespace kolize;
using namespace kolize::test;

namespace {

// A demo on its way, with the camera and the lights that a film of it would have.
struct FilmSet {
    explicit FilmSet(const std::string& demo)
        : scene(load_scene(std::string(KOLIZE_SOURCE_DIR) + "/demos/" + demo + "/scene.toml",
                           {{}, {}, {"grid", "moller", "impulse", "gl"}}, plugins())),
          simulation(scene, plugins(), *studio.host, 1000) {
        studio.camera = cli::camera_of(scene, simulation.world(), 320.0 / 240);
        studio.lights = cli::lights_of(scene, simulation.world());
        studio.renderer->prepare(simulation.world(), {scene.rooms});
    }
    Image picture(const World& world) {
        studio.renderer->draw({world, 0, studio.camera, studio.lights, {}});
        Image image;
        studio.renderer->read_pixels(image);
        return image;
    }
    void advance(double time) {
        for (double t = 0; t < time; t += simulation.step_config().dt) simulation.step();
    }

    Studio studio;
    Scene scene;
    Simulation simulation;
};

World without_bodies(World world) {
    for (std::size_t i = 0; i < world.size(); ++i) world.removed[i] = !world.is_static[i];
    return world;
}

}  // namespace

TEST_CASE("Every demo is seen: bodies in front of a room, and they move", "[demos][render]") {
    for (const std::string& demo : {"box_cubes", "box_objects", "box_fighter"}) {
        CAPTURE(demo);
        FilmSet set(demo);
        const Image empty = set.picture(without_bodies(set.simulation.world()));
        std::set<std::array<int, 3>> colours;
        for (int y = 0; y < empty.height; y += 4)
            for (int x = 0; x < empty.width; x += 4) colours.insert(at(empty, x, y));
        CHECK(colours.size() > 20);  // the room
        Image before = set.picture(set.simulation.world());
        CHECK(difference(before, empty).count > 200);
        for (int i = 0; i < 10; ++i) {
            set.advance(0.1);
            const Image now = set.picture(set.simulation.world());
            CHECK(difference(now, before).count > 50);
            before = now;
        }
    }
}

TEST_CASE("The fighter is seen where its state says that it is", "[demos][render]") {
    FilmSet set("box_fighter");
    const Image empty = set.picture(without_bodies(set.simulation.world()));
    for (int i = 0; i < 10; ++i) {
        set.advance(0.2);
        const World& world = set.simulation.world();
        const Difference seen = difference(set.picture(world), empty);
        const Pixel middle = set.studio.project(world.position[0]);
        CAPTURE(i, middle.x, middle.y, seen.left, seen.right, seen.top, seen.bottom);
        CHECK(seen.left <= middle.x);
        CHECK(middle.x <= seen.right + 1);
        CHECK(seen.top <= middle.y);
        CHECK(middle.y <= seen.bottom + 1);
        const double depth = (set.studio.camera.target - set.studio.camera.eye)
                                 .normalized()
                                 .dot(world.position[0] - set.studio.camera.eye);
        const double radius = world.shape_of(0).radius * set.studio.pixels_at(depth);
        CHECK(std::max(seen.width(), seen.height()) < 2.4 * radius);
        CHECK(std::max(seen.width(), seen.height()) > 0.5 * radius);
    }
}
