#include "demos/tunnel_games.h"
#include "render/studio.h"

#include "tunnel/hud.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

// Takes pictures of a game with the game's own camera and lights.
struct Filming {
    explicit Filming(Player& player)
        : player(player),
          renderer(game_plugins().make<Renderer>(player.game.tunnel().scene.render.stage, *game_host())) {
        renderer->open(width, height);
        renderer->prepare(player.world(), {player.game.tunnel().scene.rooms});
    }
    Image picture(const std::vector<Explosion>& explosions = {}) { return picture(player.world(), explosions); }
    // Of the same flight with other bodies; without texts.
    Image picture(const World& world, const std::vector<Explosion>& explosions = {}) {
        direct(player.game, player.world(), shot);
        renderer->draw({world, player.session.time(), shot.camera, shot.lights, explosions});
        Image image;
        renderer->read_pixels(image);
        return image;
    }
    Pixel project(const Vec3& point) const {
        const Vec3 forward = (shot.camera.target - shot.camera.eye).normalized();
        const Vec3 right = forward.cross(shot.camera.up).normalized(), up = right.cross(forward);
        const Vec3 p = point - shot.camera.eye;
        const double scale = 0.5 * height / std::tan(0.5 * shot.camera.field_of_view) / p.dot(forward);
        return {0.5 * width + scale * p.dot(right), 0.5 * height - scale * p.dot(up)};
    }

    static constexpr int width = 320, height = 180;
    Player& player;
    StagePtr<Renderer> renderer;
    cli::Shot shot;
};

}  // namespace

TEST_CASE("Seen from behind, the fighter is where its state says", "[tunnel][render]") {
    Player player(project_tunnel("winding_way"));
    const std::vector<TimedEvent> script = read_key_script(tunnel_folder / "scripts" / "winding_way.keys");
    ScriptPlayer keys(script);
    Filming filming(player);
    for (const double until : {0.5, 6.0, 8.0, 20.0}) {
        while (player.session.time() < until) {
            keys.play(player.session.time(), player.game);
            player.session.tick();
        }
        REQUIRE(player.game.camera_man().view() == View::behind);
        World without = player.world();
        without.removed[player.fighter()] = 1;
        // The fighter's own lamp goes out with it: the silhouette is told by what its lit hull alone changes.
        const Image with_fighter = filming.picture();
        filming.shot.lights.clear();
        Aabb seen;
        const World& world = player.world();
        const Transform pose = world.pose(player.fighter());
        for (const Vec3& vertex : world.shape_of(player.fighter()).mesh->vertices) {
            const Pixel p = filming.project(pose * vertex);
            seen.include({p.x, p.y, 0});
        }
        const auto dark = [&](const World& shown) {
            filming.renderer->draw({shown, player.session.time(), filming.shot.camera, {}, {}});
            Image image;
            filming.renderer->read_pixels(image);
            return image;
        };
        const Difference changed = difference(dark(world), dark(without));
        CAPTURE(until);
        CHECK(changed.count > 300);
        CHECK(changed.left == Approx(seen.min.x()).margin(3));
        CHECK(changed.right == Approx(seen.max.x()).margin(3));
        CHECK(changed.top == Approx(seen.min.y()).margin(3));
        CHECK(changed.bottom == Approx(seen.max.y()).margin(3));
        // And the tunnel around it is lit.
        int bright = 0;
        for (int x = 0; x < Filming::width; ++x)
            for (int y = 0; y < Filming::height; ++y) bright += brightness(at(with_fighter, x, y)) > 90;
        CHECK(bright > Filming::width * Filming::height / 2);
    }
}

TEST_CASE("An explosion is seen where the missile hit, and ends", "[tunnel][render]") {
    Player player(
        tunnel_of("S (0 0 0)(0 1 0) 1.0 END END  I (0 0 -1)(0 0 1) 0 END models/crate.obj (0.1 0.3 0.5)(0 0 1) 0 END  "
                  "S (0 0 -2)(0 0 1) 0 END END"));
    player.press(Key::enter);
    player.down('F');
    player.wait(0.1);
    player.up('F');
    std::vector<Explosion> explosions;
    for (int step = 0; step < 480 && explosions.empty(); ++step) {
        player.wait(player.dt());
        for (const Event& event : player.session.simulation().events())
            if (event.kind == EventKind::explosion)
                explosions.push_back(
                    {event.position, player.world().shape_of(event.body).radius, player.session.time()});
    }
    REQUIRE(explosions.size() == 1);
    Filming filming(player);
    player.wait(0.2);
    const Difference seen = difference(filming.picture(), filming.picture(explosions));
    const Pixel place = filming.project(explosions[0].position);
    CHECK(seen.count > 10);
    CHECK(place.x > seen.left - 2);
    CHECK(place.x < seen.right + 2);
    CHECK(place.y > seen.top - 2);
    CHECK(place.y < seen.bottom + 2);
    player.wait(3);
    CHECK(difference(filming.picture(), filming.picture(explosions)).count == 0);
}

TEST_CASE("A scripted flight is filmed at 320x180, and the pictures are those of its times", "[tunnel][render]") {
    const ScratchFolder folder;
    const TunnelScene tunnel = tunnel_of(short_tunnel);
    const std::vector<TimedEvent> script = parse_key_script("0.5 press enter\n0.7 down w\n3.6 press escape\n", "k");
    PlayOptions options;
    options.film.frames = (folder.path() / "pictures").string();
    options.film.size = "320x180";
    options.film.fps = 4;
    options.tells = false;
    Game filmed = game_of(tunnel), unseen = game_of(tunnel);
    const Played with = play_script(filmed, script, options, game_plugins(), *game_host());
    options.film.frames.clear();
    const Played without = play_script(unseen, script, options, game_plugins(), *game_host());
    CHECK(with.state_hash == without.state_hash);
    CHECK(with.ticks == without.ticks);
    CHECK(filmed.reports().size() == 1);
    std::vector<std::string> pictures;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "pictures"))
        pictures.push_back(file_bytes(entry.path()));
    CHECK(pictures.size() == 15);  // 0 to 3.5 s
    std::sort(pictures.begin(), pictures.end());
    const auto different = std::unique(pictures.begin(), pictures.end()) - pictures.begin();
    CHECK(different > 8);
}
