// What a picture of the game shows besides the world: lights, texts and the gun sight.
#pragma once

#include "game.h"

#include "film/film.h"

namespace kolize::tunnel {

// A spot light on the fighter's nose and lamps in the cells around it.
std::vector<Light> lights(const Game& game);
std::vector<Caption> captions(const Game& game, const World& world);
// Where missiles go, in front of the fighter.
std::vector<Line> gun_sight(const Game& game, const World& world);

// All of it, and the camera.
void direct(const Game& game, const World& world, cli::Shot& shot);

}  // namespace kolize::tunnel
