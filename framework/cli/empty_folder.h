// A folder for files that belong together and to nothing else.
#pragma once

#include <filesystem>

namespace kolize::cli {

// Makes it, and those above it, where it is not there. Throws Error if that fails or anything is in it.
void make_empty_folder(const std::filesystem::path& folder);

}  // namespace kolize::cli
