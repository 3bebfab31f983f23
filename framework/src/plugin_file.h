// One file that may be a plugin: looked at from outside, loaded, and its descriptor checked.
#pragma once

#include <kolize/plugin_library.h>

#include <stdexcept>

namespace kolize {

// Why a file is not taken as a plugin, in one sentence without the file's name.
class Refusal : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Loads the library for the rest of the process. Throws Refusal.
LoadedPlugin load_plugin(const std::filesystem::path& file);

// A name for every parameter, no name twice, every default within its own range. Throws Refusal.
void require_sound(const ParameterList& parameters);

}  // namespace kolize
