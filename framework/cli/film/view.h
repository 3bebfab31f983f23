// Where camera and lights are where a scene does not say.
#pragma once

#include <kolize/renderer.h>
#include <kolize/scene.h>
#include <kolize/simulation.h>

namespace kolize::cli {

// The eye stands in front, above and a little to the right (up is against gravity, or +y), just far enough away that
// rooms and bodies fill the picture; rooms are looked into through their walls, which are drawn from inside only. With
// [render] camera the eye is where that says. `aspect` is width over height.
Camera camera_of(const Scene& scene, const World& world, double aspect);

// [[render.light]], or two lights on either side of the scene.
std::vector<Light> lights_of(const Scene& scene, const World& world);

// Appends those of the last step, which ended at this time (s).
void take_explosions(const Simulation& simulation, double time, std::vector<Explosion>& explosions);

}  // namespace kolize::cli
