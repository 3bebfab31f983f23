// kolize check CAPSULE: what every narrowphase says about the pairs of a capsule.
#pragma once

#include "common.h"

namespace kolize::cli {

struct CheckCapsuleOptions {
    std::string capsule;
    std::vector<std::string> set;
    std::vector<std::string> plugin_path;
    int threads = 1;
    std::string json;
};

// 1 if any of them disagrees with the exact test, else 0. Throws Error.
int check_capsule(const CheckCapsuleOptions& options);

}  // namespace kolize::cli
