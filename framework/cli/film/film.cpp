#include "film.h"

#include "read_png.h"
#include "view.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace kolize::cli {
namespace {

std::unique_ptr<PictureSink> make_sink(const FilmOptions& options, const Size& size) {
    if (!options.frames.empty()) return make_png_folder(options.frames);
    return make_video(options.video, size.width, size.height, options.fps);
}

}  // namespace

std::string overlay_help() {
    std::string help = "What a stage did, as lines over the pictures (NAME[,NAME...]): ";
    for (const OverlayText& text : overlay_texts()) help += (help.ends_with(' ') ? "" : ", ") + std::string(text.name);
    return help + "; docs/overlays.md";
}

Size parse_size(const std::string& text) {
    Size size;
    const char* end = text.data() + text.size();
    const auto [x, no_width] = std::from_chars(text.data(), end, size.width);
    const bool has_x = no_width == std::errc() && x != end && *x == 'x';
    const auto [rest, no_height] = has_x ? std::from_chars(x + 1, end, size.height) : std::from_chars_result{x, {}};
    const auto fits = [](int pixels) { return pixels >= 16 && pixels <= 16384; };
    if (!has_x || no_height != std::errc() || rest != end || !fits(size.width) || !fits(size.height))
        throw Error("--size " + text + ": WIDTHxHEIGHT is wanted, such as 1280x720, each from 16 to 16384 pixels");
    return size;
}

void prepare(Renderer& renderer, const Scene& scene, const World& world) {
    const std::vector<Skin> skins = read_skins(scene);
    renderer.prepare(world, {scene.rooms, skins});
}

void add_film_options(CLI::App& command, FilmOptions& options) {
    CLI::Option* frames = command.add_option("--frames", options.frames, "Draw pictures (PNG) into this new folder");
    CLI::Option* video = command.add_option("--video", options.video, "Draw a film (MP4, by ffmpeg) into this file");
    frames->excludes(video);
    for (CLI::Option* option :
         {command.add_option("--fps", options.fps, "Pictures a second of simulated time")
              ->check(CLI::Range(1e-3, 1e4))
              ->capture_default_str(),
          command.add_option("--overlay", options.overlays, overlay_help()),
          command.add_option("--size", options.size, "WIDTHxHEIGHT of the pictures in pixels")->capture_default_str()})
        option->check(
            [&options](const std::string&) { return options.wanted() ? "" : "goes with --frames or --video"; });
}

Film::Film(const FilmOptions& options, const Scene& scene, const Simulation& simulation, const PluginLibrary& plugins,
           Host& host, std::uint64_t steps, Director director)
    : title_("renderer '" + scene.render.stage.plugin + "'"),
      renderer_(plugins.make<Renderer>(scene.render.stage, host)),
      plugins_(plugins),
      overlays_(options.overlays),
      director_(std::move(director)),
      fps_(options.fps),
      dt_(scene.pipeline.step.dt),
      last_step_(static_cast<double>(steps)) {
    overlays_.require(simulation, plugins);
    const Size size = parse_size(options.size);
    shot_.camera = camera_of(scene, simulation.world(), static_cast<double>(size.width) / size.height);
    shot_.lights = lights_of(scene, simulation.world());
    guarded([&] {
        renderer_->open(size.width, size.height);
        prepare(*renderer_, scene, simulation.world());
    });
    sink_ = make_sink(options, size);
}

// Whatever a renderer throws is told in one sentence; what is wrong with a scene's files says so by itself.
template <class Function>
void Film::guarded(Function&& function) const {
    try {
        function();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& failure) {
        throw Error(title_ + ": " + failure.what());
    }
}

void Film::look(const Simulation& simulation) {
    if (steps_ > 0) take_explosions(simulation, static_cast<double>(steps_) * dt_, explosions_);
    constexpr double rounding = 1e-6;  // of a step: a picture that is due when a step ends shows that step
    const double end = std::min(static_cast<double>(steps_ + 1), last_step_ + 2 * rounding);
    const auto due = [&] { return static_cast<double>(pictures_) / (fps_ * dt_) + rounding; };
    const double now = static_cast<double>(steps_) * dt_;  // not later than a picture of it, but for rounding
    while (due() < end) shoot(simulation, std::max(now, static_cast<double>(pictures_++) / fps_));
    ++steps_;
}

void Film::cut(const Scene& scene, const Simulation& simulation) {
    explosions_.clear();
    guarded([&] { prepare(*renderer_, scene, simulation.world()); });
}

void Film::shoot(const Simulation& simulation, double time) {
    shot_.lines.clear();
    if (director_) director_(simulation, time, shot_);
    overlays_.draw(simulation, plugins_, shot_.lines);
    guarded([&] {
        renderer_->draw(
            {simulation.world(), time, shot_.camera, shot_.lights, explosions_, shot_.lines, shot_.captions});
        renderer_->read_pixels(image_);
    });
    sink_->take(image_);
}

}  // namespace kolize::cli
