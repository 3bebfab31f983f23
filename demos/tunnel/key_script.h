// What a player does, written down: for flights without a window.
//
//     # TIME down|up|press KEY [X Y], or TIME move X Y
//     0.5 press enter
//     1.0 down w
//     2.5 up w
//     3.0 press left_button 0.5 0.4
//
// TIME is in s of the game, from its start screen on, and never decreases. A key that is pressed is let go 0.1 s later.
// X and Y are shares of the window from the left and from the top, 0 to 1: where the pointer is.
#pragma once

#include <kolize/window.h>

#include <filesystem>
#include <string>
#include <vector>

namespace kolize::tunnel {

struct TimedEvent {
    double time = 0;
    WindowEvent event;  // of a window of one by one pixel
};

// In the order of their times. Throws Error with file:line:column.
std::vector<TimedEvent> parse_key_script(const std::string& text, const std::string& file);
std::vector<TimedEvent> read_key_script(const std::filesystem::path& file);

}  // namespace kolize::tunnel
