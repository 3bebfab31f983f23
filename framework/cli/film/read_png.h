// The pictures of [[render.texture]].
#pragma once

#include <kolize/renderer.h>
#include <kolize/scene.h>

namespace kolize::cli {

// Reads the PNG files that the scene names; what is transparent in one lies on black. Throws Error, with the place
// where the scene names it, for a file that is no whole PNG, or one of more than 16384 pixels a side or 2^26 in all.
std::vector<Skin> read_skins(const Scene& scene);

}  // namespace kolize::cli
