#include "suite.h"

#include <kolize/simulation.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numbers>

namespace kolize {

namespace {

constexpr int width = 64, height = 48;

// A ball, a box, a tetrahedron and a floor, seen from above.
struct Tableau {
    Tableau() {
        world.materials.emplace_back();
        world.shapes = {make_sphere("ball", 0.5), make_box("box", {0.5, 0.4, 0.3}), make_mesh("tetrahedron", solid()),
                        make_half_space("floor", Vec3::UnitY(), 0)};
        for (std::uint32_t shape = 0; shape < world.shapes.size(); ++shape) {
            BodyDescription body;
            body.shape = shape;
            body.is_static = world.shapes[shape].kind == ShapeKind::half_space;
            body.position = body.is_static ? Vec3(0, 0, 0) : Vec3(1.5 * shape - 1.5, 1, 0);
            world.add(body);
        }
    }

    static TriangleSoup solid() {
        TriangleSoup soup;
        soup.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        soup.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
        return soup;
    }

    Frame frame(double time = 0) const { return {world, time, camera, lights, explosions}; }

    World world;
    std::vector<Room> rooms;
    Camera camera{{0, 3, 6}, {0, 0.5, 0}, Vec3::UnitY(), std::numbers::pi / 4, 0.1, 100};
    std::vector<Light> lights{{LightKind::point, {2, 5, 3}}};
    std::vector<Explosion> explosions;
};

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

// The plugin under test, ready to draw; the checks are its member functions.
class RendererChecks {
public:
    RendererChecks(const PluginLibrary& library, const LoadedPlugin& plugin)
        : host_(make_host(1)), renderer_(library.make<Renderer>(default_config(plugin), *host_)) {
        renderer_->open(width, height);
    }

    void gives_whole_pictures() {
        const Image image = picture(Tableau());
        if (image.width != width || image.height != height || image.pixels.size() != 3 * width * height)
            throw Violation("a picture of 64 x 48 pixels has not 64 x 48 times 3 bytes");
        if (std::all_of(image.pixels.begin(), image.pixels.end(), [&](auto byte) { return byte == image.pixels[0]; }))
            throw Violation("a picture of four bodies is of one colour");
    }

    void same_bytes_again() {
        Tableau tableau;
        const Image first = picture(tableau);
        if (redrawn(tableau).pixels != first.pixels) throw Violation("the same frame drawn twice gives other bytes");
        const Vec3 place = tableau.world.position[0];
        tableau.world.position[0] += Vec3(0, 0.7, 0);
        if (redrawn(tableau).pixels == first.pixels) throw Violation("a body moves by 0.7 m and the picture stays");
        tableau.world.position[0] = place;
        if (redrawn(tableau).pixels != first.pixels)
            throw Violation("the same frame gives other bytes after another one was drawn");
    }

    void does_not_write_the_world() {
        Tableau tableau;
        const World before = tableau.world;
        picture(tableau);
        const World& after = tableau.world;
        if (!same_bits(before.position, after.position) || !same_bits(before.velocity, after.velocity) ||
            !same_bits(before.angular_velocity, after.angular_velocity) || before.removed != after.removed)
            throw Violation("drawing changes the state of a body");
        for (std::size_t i = 0; i < before.size(); ++i)
            if (before.orientation[i].coeffs() != after.orientation[i].coeffs())
                throw Violation("drawing turns body " + std::to_string(i));
    }

    void leaves_out_what_is_not_there() {
        Tableau tableau;
        tableau.world.removed[0] = 1;
        const Image without = picture(tableau);
        tableau.world.position[0] += Vec3(0, 0.7, 0);
        if (redrawn(tableau).pixels != without.pixels) throw Violation("a removed body is drawn");
        tableau.world.removed[0] = 0;
        tableau.world.position[0] = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
        if (redrawn(tableau).pixels != without.pixels) throw Violation("a body at a place that is no number is drawn");
    }

    void takes_another_world() {
        const Image first = picture(Tableau());
        Tableau empty;
        empty.world = World();
        const Image nothing = picture(empty);
        if (nothing.pixels == first.pixels) throw Violation("an empty world looks like one of four bodies");
        if (picture(Tableau()).pixels != first.pixels)
            throw Violation("a world looks otherwise after another one was prepared");
    }

    void lines_and_captions() {
        Tableau tableau;
        const Image without = picture(tableau);
        Image image;
        const auto with = [&](std::span<const Line> lines, std::span<const Caption> captions) {
            Frame frame = tableau.frame();
            frame.lines = lines;
            frame.captions = captions;
            renderer_->draw(frame);
            renderer_->read_pixels(image);
            return image.pixels != without.pixels;
        };
        const Line line{{-1, 1, 1}, {1, 1, 1}};
        Caption caption{"A"};
        caption.height = 0.5;
        if (!with({&line, 1}, {})) throw Violation("a line is not drawn");
        if (!with({}, {&caption, 1})) throw Violation("a caption is not drawn");
        if (with({}, {})) throw Violation("something of a line or a caption stays in the next picture");
    }

    // Seen from outside, a wall that hides nothing is one that is drawn from inside only.
    void rooms_from_inside() {
        Tableau tableau;
        const Image outside = picture(tableau);
        Room room{{-4, -1, -4}, {4, 4, 4}};
        room.open = {true, true, true, true, true, false};  // only the wall between camera and bodies
        tableau.rooms = {room};
        if (picture(tableau).pixels != outside.pixels) throw Violation("a room's wall is drawn from its outer side");
        tableau.rooms[0].open = {};
        if (picture(tableau).pixels == outside.pixels) throw Violation("a room's inner sides are not drawn");
    }

private:
    Image picture(const Tableau& tableau) {
        renderer_->prepare(tableau.world, {tableau.rooms});
        return redrawn(tableau);
    }

    Image redrawn(const Tableau& tableau) {
        Image image;
        renderer_->draw(tableau.frame());
        renderer_->read_pixels(image);
        return image;
    }

    std::unique_ptr<Host> host_;
    StagePtr<Renderer> renderer_;
};

}  // namespace

std::vector<Check> check_renderer(const PluginLibrary& library, const LoadedPlugin& plugin, const ConformanceOptions&) {
    std::unique_ptr<RendererChecks> checks;
    std::string reason;
    try {
        checks = std::make_unique<RendererChecks>(library, plugin);
    } catch (const std::exception& failure) {
        reason = failure.what();
    }
    Suite suite;
    const auto run = [&](const char* name, void (RendererChecks::*check)()) {
        suite.run(name, [&] {
            if (!checks) throw Inapplicable("it cannot draw on this machine: " + reason);
            (checks.get()->*check)();
        });
    };
    run("gives whole pictures", &RendererChecks::gives_whole_pictures);
    run("same frame, same bytes", &RendererChecks::same_bytes_again);
    run("does not write the world", &RendererChecks::does_not_write_the_world);
    run("removed and lost bodies are not drawn", &RendererChecks::leaves_out_what_is_not_there);
    run("takes another world", &RendererChecks::takes_another_world);
    run("lines and captions over the picture", &RendererChecks::lines_and_captions);
    run("rooms from their inner sides", &RendererChecks::rooms_from_inside);
    return suite.take();
}

}  // namespace kolize
