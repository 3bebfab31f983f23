// Capsules: a scene as it stood at the beginning of a step, in one file that needs no other and loses no bit.
// Simulation::capture gives such a scene, load_scene reads the file back. Its format is in docs/ledger.md.
#pragma once

#include <kolize/scene.h>

namespace kolize {

// The text of a capsule file. `scene` comes from a simulation; `reason` says in a sentence why it was written.
KOLIZE_API std::string capsule_text(const Scene& scene, const std::string& reason);

}  // namespace kolize
