#include "sprite_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kolize::gl {
namespace {

using Colour = std::array<double, 3>;

double smooth(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

double mix(double a, double b, double t) { return a + (b - a) * t; }

// In [0, 1), by the integer mixing of Wang (1997).
double hashed(std::int32_t x, std::int32_t y, std::int32_t z) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 73856093u ^ static_cast<std::uint32_t>(y) * 19349663u ^
                      static_cast<std::uint32_t>(z) * 83492791u;
    h = (h ^ 61u) ^ (h >> 16);
    h *= 9u;
    h ^= h >> 4;
    h *= 0x27d4eb2du;
    h ^= h >> 15;
    return h / 4294967296.0;
}

// Value noise: hashed numbers at whole places, smoothly joined.
double noise(double x, double y, double z) {
    const std::array<double, 3> p = {x, y, z};
    std::array<std::int32_t, 3> cell;
    std::array<double, 3> t;
    for (std::size_t i = 0; i < 3; ++i) {
        cell[i] = static_cast<std::int32_t>(std::floor(p[i]));
        t[i] = smooth(p[i] - cell[i]);
    }
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        for (int i = 0; i < 3; ++i) weight *= corner >> i & 1 ? t[i] : 1 - t[i];
        sum += weight * hashed(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2));
    }
    return sum;
}

// Four octaves.
double turbulence(double x, double y, double z) {
    double sum = 0, share = 0.5;
    for (int octave = 0; octave < 4; ++octave, share *= 0.5) {
        sum += share * noise(x, y, z);
        x *= 2, y *= 2, z *= 2;
    }
    return sum / 0.9375;
}

// From smoke at 0 through red and orange to white at 1.
Colour glow(double heat) {
    static constexpr std::array<Colour, 5> stops = {
        {{0.05, 0.045, 0.04}, {0.35, 0.03, 0.0}, {1.0, 0.22, 0.01}, {1.0, 0.65, 0.12}, {1.0, 0.97, 0.75}}};
    const double place = std::clamp(heat, 0.0, 1.0) * 4;
    const auto low = std::min<std::size_t>(3, static_cast<std::size_t>(place));
    Colour colour;
    for (std::size_t i = 0; i < 3; ++i)
        colour[i] = mix(stops[low][i], stops[low + 1][i], place - static_cast<double>(low));
    return colour;
}

// One pixel at (x, y) of a picture that reaches from -1 to 1, at an age from 0 to 1.
void paint(std::uint8_t* pixel, double x, double y, double age) {
    const double distance = std::sqrt(x * x + y * y);
    const double billow = turbulence(3 * x + 17, 3 * y + 5, 2.5 * age);
    const double edge = 0.25 + 0.6 * std::sqrt(age);
    const double body = smooth((edge - distance + 0.5 * (billow - 0.5)) / 0.25);
    const double torn = smooth(1.6 - 2.2 * age + 1.2 * (billow - 0.5) - 0.3 * distance);
    const double inside = smooth((0.98 - distance) / 0.1);  // nothing at the rim, where the next picture begins
    const double opacity = body * torn * inside;
    const Colour colour = glow(1.15 - 1.1 * age - 0.5 * distance + 0.9 * (billow - 0.5));
    for (std::size_t i = 0; i < 3; ++i) pixel[i] = static_cast<std::uint8_t>(std::lround(255 * opacity * colour[i]));
    pixel[3] = static_cast<std::uint8_t>(std::lround(255 * opacity));
}

}  // namespace

SpriteSheet explosion_sheet() {
    SpriteSheet sheet;
    sheet.pixels.resize(4 * SpriteSheet::width * SpriteSheet::height);
    for (int row = 0; row < SpriteSheet::height; ++row)
        for (int column = 0; column < SpriteSheet::width; ++column) {
            const int picture = row / SpriteSheet::side * SpriteSheet::columns + column / SpriteSheet::side;
            const double x = (column % SpriteSheet::side + 0.5) / SpriteSheet::side * 2 - 1;
            const double y = 1 - (row % SpriteSheet::side + 0.5) / SpriteSheet::side * 2;
            const double age = picture / (SpriteSheet::columns * SpriteSheet::rows - 1.0);
            paint(&sheet.pixels[4 * (static_cast<std::size_t>(row) * SpriteSheet::width + column)], x, y, age);
        }
    return sheet;
}

}  // namespace kolize::gl
