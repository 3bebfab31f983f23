#include "places.h"

#include <kolize/error.h>

namespace kolize::tunnel {

namespace fs = std::filesystem;

Places find_places() {
    std::error_code failure;
    const fs::path program = fs::read_symlink("/proc/self/exe", failure);
    const fs::path installed = program.parent_path().parent_path() / "share" / "kolize" / "demos";
    const fs::path sources = KOLIZE_DEMOS_DIR;
    const bool is_installed = !failure && fs::is_directory(installed / "tunnel", failure);
    const fs::path demos = (is_installed ? installed : sources).lexically_normal();
    const fs::path tunnel = demos / "tunnel";
    Places places{tunnel / "pipelines" / "default.toml", demos / "box_fighter" / "fighter.obj", {}};
    for (const char* name : {"first_flight", "winding_way", "the_deep"})
        places.tunnels.push_back(tunnel / "tunnels" / (std::string(name) + ".txt"));
    for (const fs::path& file : {places.pipeline, places.fighter, places.tunnels.front()})
        if (!fs::is_regular_file(file, failure))
            throw Error(SourceLocation{file.string()},
                        "this file of the game is missing; it is looked for beside the "
                        "program, in ../share/kolize/demos, and in the sources");
    return places;
}

}  // namespace kolize::tunnel
