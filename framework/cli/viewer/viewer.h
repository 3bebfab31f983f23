// What a user does with a running scene: keys, pointer and panel on one side, a session and pictures of it on the
// other. It knows neither window nor clock.
#pragma once

#include "film/film.h"
#include "session.h"
#include "viewer/history.h"
#include "viewer/orbit_camera.h"

#include <kolize/window.h>

#include <functional>

namespace kolize::cli {

class Viewer {
public:
    // `say` takes one line for the user's terminal whenever something was changed.
    Viewer(Session& session, const PluginLibrary& plugins, double aspect, std::function<void(const std::string&)> say,
           bool paused, const Overlays& overlays);

    void handle(const WindowEvent& event, int height);
    // What the user has changed in the panel.
    void take_edits();

    bool is_closed() const { return closed_; }
    bool is_running() const { return running_; }
    double speed() const { return speed_; }  // simulated seconds a second
    // Whether the user asked for a picture since the last call.
    bool takes_screenshot() { return std::exchange(screenshot_, false); }
    // Whether the user asked for one more step that was not taken yet.
    bool takes_single_step() { return single_steps_ > 0 && single_steps_-- > 0; }

    void step();

    // The next picture.
    const Shot& shot();
    const std::vector<Explosion>& explosions() const { return explosions_; }
    double time() const;  // simulated, s
    // To be shown with it; nothing while it is put away.
    Panel* panel();

private:
    void press(const WindowEvent& event);
    void change_drag(double by);
    void set_gravity(const Vec3& gravity);
    void put_in(const Input& input);
    void reset();
    void show_overlays();
    void take_edit(const PanelItem& item);

    Session& session_;
    const PluginLibrary& plugins_;
    std::function<void(const std::string&)> say_;
    World start_;  // as the session began
    Overlays overlays_;
    OrbitCamera camera_;
    Shot shot_;
    std::vector<Explosion> explosions_;
    History history_;
    Panel panel_;
    std::string message_;  // the last thing that could not be done
    double speed_ = 1;
    bool running_ = true, closed_ = false, screenshot_ = false;
    int single_steps_ = 0;
    bool help_ = false, shows_panel_ = true, g_held_ = false;
};

}  // namespace kolize::cli
