#include "empty_folder.h"

#include <kolize/error.h>

namespace kolize::cli {

void make_empty_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error("folder '" + folder.string() + "' cannot be made: " + error.message());
    if (!std::filesystem::is_empty(folder, error) || error)
        throw Error("folder '" + folder.string() + "' is not empty; one of its own is wanted");
}

}  // namespace kolize::cli
