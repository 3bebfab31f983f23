// Pictures of a simulation at a steady rate of simulated time: kolize run --frames | --video.
#pragma once

#include "overlay/overlay.h"
#include "picture_sink.h"

#include <kolize/scene.h>
#include <kolize/simulation.h>

#include <functional>

namespace CLI {
class App;
}

namespace kolize::cli {

struct FilmOptions {
    std::string frames;  // folder, or ""
    std::string video;   // file, or ""
    double fps = 30;     // pictures a second of simulated time
    std::string size = "1280x720";
    std::string overlays;  // names, or ""

    bool wanted() const { return !frames.empty() || !video.empty(); }
};

void add_film_options(CLI::App& command, FilmOptions& options);

struct Size {
    int width = 0, height = 0;  // pixels
};

// "1280x720". Throws Error.
Size parse_size(const std::string& text);

// Of the option --overlay.
std::string overlay_help();

// What a picture shows besides the world and its explosions.
struct Shot {
    Camera camera;
    std::vector<Light> lights;
    std::vector<Line> lines;
    std::vector<Caption> captions;
};

// Sets up the next picture, of so many seconds of simulated time; the shot is as it was left for the picture before.
using Director = std::function<void(const Simulation& simulation, double time, Shot& shot)>;

// Hands the renderer all of a scene that does not change from picture to picture.
void prepare(Renderer& renderer, const Scene& scene, const World& world);

// Reads the simulation and never changes it: a run ends in the same state with a film and without.
class Film {
public:
    // Of a run of so many steps. Draws nothing yet. Throws Error for a renderer that cannot be had, or for options that
    // do not go together.
    Film(const FilmOptions& options, const Scene& scene, const Simulation& simulation, const PluginLibrary& plugins,
         Host& host, std::uint64_t steps, Director director = {});

    // The pictures that show the state as it stands: to be called before the first step and after each one. The
    // picture of time t shows the state after the last step that ended at t or before.
    void look(const Simulation& simulation);
    // The pictures from here on are of another simulation, with steps of the same length; their times go on.
    void cut(const Scene& scene, const Simulation& simulation);
    void finish() { sink_->finish(); }

private:
    void shoot(const Simulation& simulation, double time);
    template <class Function>
    void guarded(Function&& function) const;

    std::string title_;  // of the renderer, for messages
    StagePtr<Renderer> renderer_;
    const PluginLibrary& plugins_;
    Overlays overlays_;
    Director director_;
    Shot shot_;
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
