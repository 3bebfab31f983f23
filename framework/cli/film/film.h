// Pictures of a simulation at a steady rate of simulated time: kolize run --frames | --video.
#pragma once

#include "picture_sink.h"

#include <kolize/scene.h>
#include <kolize/simulation.h>

#include <CLI/CLI.hpp>

namespace kolize::cli {

struct FilmOptions {
    std::string frames;  // folder, or ""
    std::string video;   // file, or ""
    double fps = 30;     // pictures a second of simulated time
    std::string size = "1280x720";

    bool wanted() const { return !frames.empty() || !video.empty(); }
};

void add_film_options(CLI::App& command, FilmOptions& options);

// Reads the simulation and never changes it: a run ends in the same state with a film and without.
class Film {
public:
    // Of a run of so many steps. Draws nothing yet. Throws Error for a renderer that cannot be had, or for options that
    // do not go together.
    Film(const FilmOptions& options, const Scene& scene, const Simulation& simulation, const PluginLibrary& plugins,
         Host& host, std::uint64_t steps);

    // The pictures that show the state as it stands: to be called before the first step and after each one. The
    // picture of time t shows the state after the last step that ended at t or before.
    void look(const Simulation& simulation);
    void finish() { sink_->finish(); }

private:
    void take_explosions(const Simulation& simulation);
    void shoot(const World& world, double time);
    template <class Function>
    void guarded(Function&& function) const;

    std::string title_;  // of the renderer, for messages
    StagePtr<Renderer> renderer_;
    Camera camera_;
    std::vector<Light> lights_;
    std::vector<Explosion> explosions_;
    double fps_;
    double dt_;
    double last_step_;
    std::uint64_t steps_ = 0;     // seen so far
    std::uint64_t pictures_ = 0;  // taken so far
    Image image_;
    std::unique_ptr<PictureSink> sink_;
};

}  // namespace kolize::cli
