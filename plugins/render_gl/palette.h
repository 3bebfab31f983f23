// Colours that are told apart easily, also by the colour-blind.
#pragma once

#include <array>
#include <cstdint>

namespace kolize::gl {

using Colour = std::array<std::uint8_t, 3>;  // sRGB

// The first seven are those of Okabe and Ito, Color Universal Design (2008), without black; then three of Tol,
// Colour Schemes (2021), muted.
inline constexpr std::array<Colour, 10> palette = {{{230, 159, 0},
                                                    {86, 180, 233},
                                                    {0, 158, 115},
                                                    {213, 94, 0},
                                                    {204, 121, 167},
                                                    {240, 228, 66},
                                                    {0, 114, 178},
                                                    {136, 34, 85},
                                                    {153, 153, 51},
                                                    {136, 204, 238}}};

inline constexpr Colour static_colour = {160, 160, 165};

}  // namespace kolize::gl
