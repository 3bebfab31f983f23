// The built program, run by a shell in a folder of its own.
#pragma once

#include "framework/mesh_files.h"

#include <cstdlib>
#include <sys/wait.h>

namespace kolize::test {

struct Outcome {
    int code = -1;
    std::string out;
    std::string err;
};

class Shell {
public:
    // Words as a shell reads them; the program runs in the scratch folder.
    Outcome kolize(const std::string& arguments) const { return run("kolize " + arguments); }
    // The same for any of the built programs; its name comes first.
    Outcome run(const std::string& command_line) const {
        const std::string command =
            "cd '" + folder.path().string() + "' && " KOLIZE_BINARY_DIR "/bin/" + command_line + " >out.txt 2>err.txt";
        const int status = std::system(command.c_str());
        return {WEXITSTATUS(status), file_bytes(folder.path() / "out.txt"), file_bytes(folder.path() / "err.txt")};
    }
    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder.path()), {}));
    }
    ScratchFolder folder;
};

}  // namespace kolize::test
