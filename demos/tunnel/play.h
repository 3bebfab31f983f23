// Plays a game: by a script without a window, or by somebody in one.
#pragma once

#include "playthrough.h"

#include "film/film.h"

#include <optional>

namespace kolize::tunnel {

struct PlayOptions {
    std::optional<double> time;  // simulated, s; the game ends then at the latest
    cli::FilmOptions film;
    std::filesystem::path record;  // see Playthrough
    bool tells = true;             // on stdout, one line for each flight finished
};

struct Played {
    std::uint64_t ticks = 0;
    double time = 0;  // simulated, s
    std::uint64_t state_hash = 0;
    Vec3 fighter = Vec3::Zero();  // its centre, m
};

// Until the player ends it, 3 s after the last flight, or 30 s after the script's last line. Throws Error for a
// renderer that is not to be had.
Played play_script(Game& game, const std::vector<TimedEvent>& script, const PlayOptions& options,
                   const PluginLibrary& plugins, Host& host);

// In a window, in real time, until the player ends it. Throws Error where no window is to be had.
Played play_in_window(Game& game, const PlayOptions& options, const PluginLibrary& plugins, Host& host);

}  // namespace kolize::tunnel
