// Where the game's files are: beside the program's installation, or in the source tree.
#pragma once

#include <filesystem>
#include <vector>

namespace kolize::tunnel {

struct Places {
    std::filesystem::path pipeline;              // the default one
    std::filesystem::path fighter;               // its mesh
    std::vector<std::filesystem::path> tunnels;  // those of the project, easiest first
};

// Throws Error where neither is there.
Places find_places();

}  // namespace kolize::tunnel
