// Recordings: a scene as it began, what was put into it, and what came out of every step, in one file that needs no
// other and loses no bit. Its format is in docs/record.md.
#pragma once

#include <kolize/input.h>

namespace kolize {

struct TimedInput {
    std::uint64_t step = 0;  // before this one; see Simulation::step_number
    Input input;
};

struct Recording {
    Scene start;                        // as load_scene gave it
    std::vector<TimedInput> inputs;     // in the order in which they were put in
    std::vector<std::uint64_t> hashes;  // the state after each step, see Simulation::state_hash
};

KOLIZE_API std::string recording_text(const Recording& recording);

// `options` as for load_scene; a pipeline or setting there takes the place of what was recorded.
// Throws Error as load_scene does.
KOLIZE_API Recording load_recording(const std::filesystem::path& file, const SceneOptions& options,
                                    const PluginLibrary& plugins);

}  // namespace kolize
