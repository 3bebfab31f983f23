// The game: from the start screen through one tunnel after the other. It has no clock but the steps of the simulation,
// so that the same keys at the same steps give the same flight.
#pragma once

#include "camera.h"
#include "magazine.h"
#include "tunnel_scene.h"

#include <kolize/simulation.h>

#include <set>

namespace kolize::tunnel {

enum class Phase {
    ready,    // start screen; the world stands still
    flying,   // the fighter is on its way
    arrived,  // it is in the last cell, and stops there; another tunnel comes next
    done,     // the same, and no tunnel is left
    ended     // the player has had enough
};

const char* to_string(Phase phase);

struct FlightReport {
    std::string file;
    double time = 0;  // simulated, s
    std::uint64_t missiles = 0;
    std::uint64_t explosions = 0;
};

class Game {
public:
    // At least one tunnel, all with the same step.
    explicit Game(std::vector<TunnelScene> tunnels);

    void take(const WindowEvent& event);

    // Whether there is a next step; if not, the world stands still and time passes by observe alone.
    bool runs() const { return phase_ != Phase::ready && phase_ != Phase::ended; }
    // Appends what is to be put into the simulation before its next step.
    void decide(const World& world, std::vector<Input>& inputs);
    // After each step, or in its place.
    void observe(const Simulation& simulation);

    Phase phase() const { return phase_; }
    std::size_t tunnel_number() const { return number_; }  // a simulation of this one is wanted
    std::size_t tunnels() const { return tunnels_.size(); }
    const TunnelScene& tunnel() const { return tunnels_[number_]; }
    std::size_t cell() const { return cell_; }  // the fighter's, or the last one that it was in
    double flight_time() const { return dt_ * static_cast<double>(flight_steps_); }  // s, until the fighter arrives
    const std::vector<FlightReport>& reports() const { return reports_; }  // of the flights finished: the score
    Control control() const { return control_; }
    bool uses_mouse() const { return mouse_; }
    bool shows_help() const { return help_; }
    const Forces& forces() const { return forces_; }
    std::uint64_t explosions() const { return explosions_; }  // in this flight
    const Magazine& magazine() const { return magazine_; }
    const CameraMan& camera_man() const { return camera_; }
    Camera camera(const World& world) const;

private:
    void begin_flight();
    void press(Key key);
    void press_enter();
    Demand demand() const;
    void put_forces(std::vector<Input>& inputs);
    Subject subject(const World& world, std::uint32_t body) const;
    std::optional<Subject> missile(const World& world) const;

    std::vector<TunnelScene> tunnels_;
    double dt_;
    Phase phase_ = Phase::ready;
    std::size_t number_ = 0;
    std::size_t cell_ = 0;
    std::uint64_t steps_ = 0, flight_steps_ = 0;  // of this world; of them, until the fighter arrived
    std::uint64_t explosions_ = 0;                // in this flight
    std::vector<FlightReport> reports_;

    std::set<Key> held_;
    bool trigger_ = false;         // left button
    bool fires_ = false;           // since the last step, however shortly
    Vec3 pointer_ = Vec3::Zero();  // from the middle of the window: x to the right, y up; -1 to 1
    double width_ = 1, height_ = 1;
    Control control_ = Control::autopilot;
    bool mouse_ = false;
    bool help_ = false;
    bool next_view_ = false;  // asked for since the last step

    Forces forces_, forces_put_;  // wanted, and in force
    std::optional<LoadInput> load_put_;
    Magazine magazine_;
    CameraMan camera_;
};

}  // namespace kolize::tunnel
