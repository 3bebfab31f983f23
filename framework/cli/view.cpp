// kolize view: a scene in a window.
#include "common.h"
#include "film/film.h"
#include "viewer/viewer.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace kolize::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct ViewOptions {
    std::string scene;
    std::string pipeline;
    std::vector<std::string> set;
    std::vector<std::string> plugin_path;
    RunLength length;
    int threads = all_cores();
    std::string size = "1280x720";
    bool paused = false;
    RecordOptions record;
    std::string overlays;
};

void say(const std::string& line) { std::cout << line << std::endl; }

// Simulated time follows the clock on the wall, times the speed, in whole steps. Where the machine is too slow it falls
// behind, and the window still answers.
class Pace {
public:
    // Steps as long as they are due and time is left for them; false if `step` said that it was the last one.
    template <class Step>
    bool advance(const Viewer& viewer, double dt, const Step& step) {
        const auto now = Clock::now();
        const double passed = std::min(std::chrono::duration<double>(now - last_).count(), longest);
        last_ = now;
        due_ = viewer.is_running() ? due_ + passed * viewer.speed() / dt : 0;
        for (; due_ >= 1; --due_) {
            if (!step()) return false;
            if (Clock::now() - now > std::chrono::duration<double>(longest)) due_ = std::min(due_, 1.0);
        }
        return true;
    }

private:
    static constexpr double longest = 0.05;  // s, from picture to picture
    Clock::time_point last_ = Clock::now();
    double due_ = 0;  // steps
};

// The scene in its window, from the first picture to the last.
class View {
public:
    View(const ViewOptions& options, const PluginLibrary& plugins, Host& host, Session& session,
         std::optional<std::uint64_t> steps)
        : session_(session),
          left_(steps),
          renderer_(plugins.make<Renderer>(session.scene().render.stage, host)),
          window_(open(parse_size(options.size))),
          viewer_(session, plugins, static_cast<double>(window_.width()) / window_.height(), say, options.paused,
                  Overlays(options.overlays)) {
        Overlays(options.overlays).require(session.simulation(), plugins);
        prepare(*renderer_, session.scene(), session.simulation().world());
    }

    void run() {
        std::vector<WindowEvent> events;
        bool goes_on = true;
        const auto step = [&] { return take_step(); };
        while (goes_on && !viewer_.is_closed()) {
            events.clear();
            window_.poll(events);
            for (const WindowEvent& event : events) viewer_.handle(event, window_.height());
            if (viewer_.takes_single_step()) goes_on = step();
            goes_on = goes_on && pace_.advance(viewer_, session_.simulation().step_config().dt, step);
            draw();
        }
    }

private:
    Window& open(const Size& size) {
        try {
            return renderer_->open_window("kolize: " + session_.scene().file, size.width, size.height);
        } catch (const std::exception& failure) {
            throw Error("renderer '" + session_.scene().render.stage.plugin + "': " + failure.what());
        }
    }

    // False once all steps are taken.
    bool take_step() {
        viewer_.step();
        return !left_ || --*left_ > 0;
    }

    void draw() {
        const Shot& shot = viewer_.shot();
        renderer_->draw({session_.simulation().world(), viewer_.time(), shot.camera, shot.lights, viewer_.explosions(),
                         shot.lines, shot.captions});
        if (viewer_.takes_screenshot()) write_screenshot();
        window_.present(viewer_.panel());
        viewer_.take_edits();
    }

    void write_screenshot() {
        Image image;
        renderer_->read_pixels(image);
        const std::string file = "kolize_" + std::to_string(session_.simulation().step_number()) + ".png";
        write_png(image, file);
        say(file);
    }

    Session& session_;
    std::optional<std::uint64_t> left_;  // steps
    StagePtr<Renderer> renderer_;
    Window& window_;
    Viewer viewer_;
    Pace pace_;
};

int view(const ViewOptions& options) {
    const PluginLibrary plugins = open_plugins(options.plugin_path, std::filesystem::path(options.scene).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    const SceneOptions scene_options{options.pipeline, parse_settings(options.set), plugin_defaults()};
    Subject subject = load_subject(options.scene, options.record, scene_options, plugins);
    for (const std::string& warning : subject.scene.warnings) host->warn(warning);
    const bool has_end = options.length.steps || options.length.time || subject.recording;
    const bool has_to_agree = subject.recording && !subject.own_pipeline;
    const auto steps = has_end ? std::optional(count_steps(subject, options.length)) : std::nullopt;
    Session session(std::move(subject), plugins, *host, steps.value_or(0));
    if (!options.record.record.empty()) session.record();
    View(options, plugins, *host, session, steps).run();
    if (!options.record.record.empty()) session.write_recording(options.record.record);
    const Simulation& simulation = session.simulation();
    say(std::to_string(simulation.step_number()) + " steps, state hash " + hex(simulation.state_hash()));
    if (session.replays()) say(replay_text(session));
    return has_to_agree && session.parting() ? 1 : 0;
}

}  // namespace

void add_view(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<ViewOptions>();
    CLI::App* command = app.add_subcommand("view", "Show a scene in a window while it runs (H there: keys)");
    command->add_option("scene", options->scene, "Scene file or capsule (TOML)");
    command->add_option("--pipeline", options->pipeline, "Pipeline file: replaces its tables");
    add_set_option(*command, options->set);
    add_length_options(*command, options->length);
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    command->add_option("--size", options->size, "WIDTHxHEIGHT of the window in pixels")->capture_default_str();
    command->add_flag("--paused", options->paused, "Begin with a pause");
    command->add_option("--overlay", options->overlays, overlay_help());
    add_record_options(*command, options->record);
    command->footer("Example: kolize view scene.toml --set broadphase.plugin=bsp --record flight.rec");
    command->callback([options, &exit_code] { exit_code = view(*options); });
}

}  // namespace kolize::cli
