#include "hud.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace kolize::tunnel {
namespace {

constexpr Rgba white = {255, 255, 255, 235}, soft = {200, 215, 230, 200}, gold = {255, 205, 90, 255};

constexpr const char* keys =
    "W S   forward, back            Space   full stop\n"
    "A D   left, right              1 2     without, with autopilot\n"
    "E Q   up, down                 M       mouse steers, on and off\n"
    "Up Down      nose up, down     V       next view\n"
    "Left Right   turn              X C     view nearer, farther\n"
    "Ctrl + Left Right   roll       Tab     look ahead, or at the fighter\n"
    "F or left button    fire       T R     more, less drag\n"
    "F1 H  these keys               G + Down Up   gravity on, off\n"
    "Esc   end                      in the free view all these move the camera";

template <class... Values>
std::string text(const char* format, Values... values) {
    std::array<char, 200> line;
    std::snprintf(line.data(), line.size(), format, values...);
    return line.data();
}

Caption at(double x, double y, double height, const Rgba& colour, std::string words) {
    return {std::move(words), x, y, x, y < 0.5 ? 0.0 : 1.0, height, colour};
}

Caption in_the_middle(double y, double height, const Rgba& colour, std::string words) {
    return {std::move(words), 0.5, y, 0.5, 0.5, height, colour};
}

std::string title_of(const TunnelScene& tunnel) { return tunnel.tunnel.file.stem().string(); }

std::string score(const Game& game) {
    std::string words = text("%zu of %zu flights finished", game.reports().size(), game.tunnels());
    for (std::size_t i = 0; i < game.reports().size(); ++i)
        words += text("\nflight %zu: %.2f s", i + 1, game.reports()[i].time);
    return words;
}

std::string instruments(const Game& game, const World& world) {
    const std::uint32_t fighter = game.tunnel().fighter;
    const Vec3 velocity = axes_of(world, fighter).conjugate() * world.velocity[fighter];
    return text("%5.1f m/s   %s%s\n%zu missiles   gravity %s   drag %.2f", velocity.x(),
                game.control() == Control::autopilot ? "autopilot" : "relative", game.uses_mouse() ? ", mouse" : "",
                game.magazine().left(), game.forces().gravity.isZero(0) ? "off" : "on", game.forces().drag);
}

// Lamps of neighbouring cells differ in colour, so that one sees the tunnel go by.
Light lamp(const Cell& cell, std::size_t number) {
    static const std::array<Vec3, 3> colours = {Vec3(1.0, 0.58, 0.25), Vec3(0.25, 0.55, 1.0), Vec3(0.40, 1.0, 0.55)};
    Light light;
    const Vec3 up = cell.back.y() == 0 && cell.ahead.y() == 0 ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitX());
    light.position = center_of(cell) + 0.36 * cube_side * up;
    light.colour = 0.9 * colours[number % colours.size()];
    light.range = 1.35 * cube_side;
    return light;
}

}  // namespace

std::vector<Light> lights(const Game& game) {
    Light beam;
    beam.kind = LightKind::spot;
    beam.body = game.tunnel().fighter;
    beam.position = {fighter_length / 2, 0.3, 0};
    beam.direction = Vec3::UnitX();
    beam.colour = {1.0, 0.97, 0.9};
    beam.range = 110;
    beam.cone = 0.42;
    std::vector<Light> all{beam};
    const std::vector<Cell>& cells = game.tunnel().tunnel.cells;
    const std::size_t first = game.cell() < 2 ? 0 : game.cell() - 2;
    for (std::size_t i = first; i < std::min(first + 7, cells.size()); ++i) all.push_back(lamp(cells[i], i));
    return all;
}

std::vector<Caption> captions(const Game& game, const World& world) {
    std::vector<Caption> all;
    all.push_back(at(0.02, 0.03, 0.035, soft,
                     text("%s\ncube %zu of %zu", title_of(game.tunnel()).c_str(), game.cell() + 1,
                          game.tunnel().tunnel.cells.size())));
    all.push_back(at(0.98, 0.03, 0.035, soft,
                     text("%.1f s\nfinished %zu of %zu", game.flight_time(), game.reports().size(), game.tunnels())));
    all.push_back(at(0.02, 0.97, 0.035, soft, instruments(game, world)));
    all.push_back(at(0.98, 0.97, 0.035, soft, text("view %s", to_string(game.camera_man().view()))));
    if (game.phase() == Phase::ready) all.push_back(in_the_middle(0.18, 0.09, gold, "TUNNEL TRANSIT"));
    if (game.phase() == Phase::ready) all.push_back(in_the_middle(0.86, 0.05, white, "Enter starts"));
    if (game.phase() == Phase::ready || game.shows_help()) all.push_back(in_the_middle(0.52, 0.036, white, keys));
    if (game.phase() == Phase::arrived)
        all.push_back(in_the_middle(0.35, 0.05, gold, score(game) + "\n\nEnter: next flight"));
    if (game.phase() == Phase::done) all.push_back(in_the_middle(0.35, 0.05, gold, score(game) + "\n\nall done"));
    return all;
}

std::vector<Line> gun_sight(const Game& game, const World& world) {
    constexpr double distance = 60, inner = 0.8, outer = 2;  // m
    if (game.phase() != Phase::flying || game.camera_man().view() == View::on_missile) return {};
    const std::uint32_t fighter = game.tunnel().fighter;
    const Quat axes = axes_of(world, fighter);
    const Vec3 middle = world.position[fighter] + axes * Vec3(distance, 0, 0);
    std::vector<Line> lines;
    for (const Vec3& ray : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
        const Vec3 outward = axes * ray;
        lines.push_back({middle + inner * outward, middle + outer * outward, {140, 255, 160, 220}});
    }
    return lines;
}

void direct(const Game& game, const World& world, cli::Shot& shot) {
    shot.camera = game.camera(world);
    shot.lights = lights(game);
    shot.captions = captions(game, world);
    shot.lines = gun_sight(game, world);
}

}  // namespace kolize::tunnel
