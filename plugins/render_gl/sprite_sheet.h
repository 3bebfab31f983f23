// The pictures of an explosion, one after the other in time, drawn by a formula.
#pragma once

#include <cstdint>
#include <vector>

namespace kolize::gl {

// 8 by 4 pictures, row by row; red, green, blue (linear, times the opacity) and opacity, a byte each.
struct SpriteSheet {
    static constexpr int columns = 8, rows = 4, side = 64;  // pixels of one picture's side
    static constexpr int width = columns * side, height = rows * side;
    std::vector<std::uint8_t> pixels;
};

// The same bytes every time: a ball of fire that grows, breaks up and turns to smoke.
SpriteSheet explosion_sheet();

}  // namespace kolize::gl
