// Loading a library where it can do no harm.
#pragma once

#include <filesystem>
#include <string>

namespace kolize {

// Loads the library in a child process and says why that failed, or "". A library that throws, crashes or hangs while
// it is loaded takes only the child with it; in this process it would leave the dynamic loader locked, or no process.
std::string trial_load_defect(const std::filesystem::path& file);

}  // namespace kolize
