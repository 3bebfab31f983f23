// A look at a shared library from outside, before the dynamic loader maps it.
#pragma once

#include <filesystem>
#include <string>

namespace kolize {

// Why the loader must not be given this file, or "". The loader maps segments without comparing them with the file's
// length, so that a truncated library kills the process (SIGBUS) instead of being refused.
std::string shared_object_defect(const std::filesystem::path& file);

}  // namespace kolize
