#include "viewer/viewer.h"

#include "common.h"
#include "film/view.h"
#include "viewer/pipeline_panel.h"

#include <algorithm>

namespace kolize::cli {
namespace {

constexpr const char* help_text = R"(F1 or H     this help
P or Space  pause, go on
N           one step, then pause
- and =     slower, faster
Home        back to the start
T and R     more, less drag
G+Down      gravity on
G+Up        gravity off
Tab         panel
C           camera back
F12         picture into a file
Esc         end
Pointer     left button turns, right one shifts, wheel zooms)";

constexpr const char* overlay_prefix = "overlay.";
constexpr double drag_step = 0.05;  // 1/s
const Vec3 earth(0, -9.81, 0);      // m/s^2, where the scene has no gravity of its own

}  // namespace

Viewer::Viewer(Session& session, const PluginLibrary& plugins, double aspect,
               std::function<void(const std::string&)> say, bool paused, const Overlays& overlays)
    : session_(session),
      plugins_(plugins),
      say_(std::move(say)),
      start_(session.scene().world),
      overlays_(overlays),
      camera_(camera_of(session.scene(), session.simulation().world(), aspect)),
      running_(!paused) {
    shot_.lights = lights_of(session.scene(), session.simulation().world());
    panel_.title = "kolize";
}

void Viewer::handle(const WindowEvent& event, int height) {
    switch (event.kind) {
    case WindowEventKind::closed: closed_ = true; break;
    case WindowEventKind::key_down: press(event); break;
    case WindowEventKind::key_up: g_held_ = g_held_ && event.key != Key::g; break;
    default: camera_.handle(event, height);
    }
}

void Viewer::press(const WindowEvent& event) {
    switch (event.key) {
    case Key::escape: closed_ = true; break;
    case Key::f1:
    case Key::h: help_ = !help_; break;
    case Key::space:
    case Key::p: running_ = !running_; break;
    case Key::n:
        running_ = false;
        ++single_steps_;
        break;
    case Key::minus: speed_ = std::max(speed_ / 2, 1.0 / 64); break;
    case Key::equal: speed_ = std::min(speed_ * 2, 16.0); break;
    case Key::home: reset(); break;
    case Key::t: change_drag(drag_step); break;
    case Key::r: change_drag(-drag_step); break;
    case Key::g: g_held_ = true; break;
    case Key::down:
        if (g_held_) set_gravity(start_.forces.gravity.isZero(0) ? earth : start_.forces.gravity);
        break;
    case Key::up:
        if (g_held_) set_gravity(Vec3::Zero());
        break;
    case Key::tab: shows_panel_ = !shows_panel_; break;
    case Key::c: camera_.reset(); break;
    case Key::f12: screenshot_ = true; break;
    default: break;
    }
}

void Viewer::put_in(const Input& input) { session_.put_in(input); }

void Viewer::change_drag(double by) {
    Forces forces = session_.simulation().world().forces;
    forces.drag = std::max(0.0, forces.drag + by);
    put_in(ForcesInput{forces});
    say_("drag " + number(forces.drag) + " 1/s");
}

void Viewer::set_gravity(const Vec3& gravity) {
    Forces forces = session_.simulation().world().forces;
    forces.gravity = gravity;
    put_in(ForcesInput{forces});
    say_("gravity " + number(gravity.norm()) + " m/s^2");
}

// All bodies to where they began: something that is put in like anything else, so that a recording has it.
void Viewer::reset() {
    put_in(ForcesInput{start_.forces});
    for (std::uint32_t body = 0; body < start_.size(); ++body) {
        if (start_.is_static[body]) continue;
        put_in(LoadInput{body, start_.constant_force[body], start_.constant_torque[body]});
        put_in(PlaceInput{body, start_.state(body)});
        if (start_.removed[body]) put_in(RemoveInput{body});
    }
    explosions_.clear();
    say_("step " + std::to_string(session_.simulation().step_number()) + ": back to the start");
}

void Viewer::step() {
    session_.step();
    history_.add(session_.simulation());
    constexpr double longest = 30;  // s: no explosion plays longer
    take_explosions(session_.simulation(), time(), explosions_);
    std::erase_if(explosions_, [&](const Explosion& e) { return e.start < time() - longest; });
}

double Viewer::time() const {
    const Simulation& simulation = session_.simulation();
    return static_cast<double>(simulation.step_number()) * simulation.step_config().dt;
}

const Shot& Viewer::shot() {
    shot_.camera = camera_.camera();
    shot_.captions.clear();
    shot_.lines.clear();
    overlays_.draw(session_.simulation(), plugins_, shot_.lines);
    const std::string pace = running_ ? (speed_ == 1 ? "" : "  speed " + number(speed_)) : "  paused";
    Caption state{number(time(), 6) + " s  step " + std::to_string(session_.simulation().step_number()) + pace};
    state.x = 0.99, state.y = 0.99, state.anchor_x = state.anchor_y = 1;
    shot_.captions.push_back(state);
    if (help_) {
        Caption help{help_text};
        help.x = 0.6, help.y = 0.5, help.anchor_x = help.anchor_y = 0.5;
        shot_.captions.push_back(help);
    }
    return shot_;
}

Panel* Viewer::panel() {
    if (!shows_panel_) return nullptr;
    panel_.items.clear();
    show_pipeline(session_.simulation().pipeline(), plugins_, panel_.items);
    history_.show(session_.simulation(), panel_.items);
    show_overlays();
    if (!message_.empty()) panel_.items.push_back({PanelItemKind::text, "message", "refused", "", "", Value(message_)});
    return &panel_;
}

// Those that the pipeline in force can show.
void Viewer::show_overlays() {
    panel_.items.push_back({PanelItemKind::heading, overlay_prefix, "Overlays"});
    for (const OverlayText& text : overlay_texts())
        if (overlay_refusal(text.name, session_.simulation(), plugins_).empty())
            panel_.items.push_back({PanelItemKind::toggle, overlay_prefix + std::string(text.name), text.name, "",
                                    text.shows, Value(overlays_.is_shown(text.name))});
}

void Viewer::take_edits() {
    for (const PanelItem& item : panel_.items)
        if (item.edited) take_edit(item);
}

// At the boundary of two steps. What does not fit is told, and the pipeline stays.
void Viewer::take_edit(const PanelItem& item) {
    if (item.id.starts_with(overlay_prefix)) return overlays_.show(item.label, std::get<bool>(item.value));
    const auto edit = edit_pipeline(session_.simulation().pipeline(), item);
    if (!edit) return;
    const std::uint64_t step = session_.simulation().step_number();
    try {
        put_in(PipelineInput{edit->pipeline});
        history_.mark(step, edit->what);
        message_.clear();
        say_(history_.last_mark());
    } catch (const std::exception& refusal) {
        message_ = refusal.what();
        say_("step " + std::to_string(step) + ": refused: " + message_);
    }
}

}  // namespace kolize::cli
