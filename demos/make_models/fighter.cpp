#include "models.h"

#include <cmath>
#include <cstdlib>

namespace kolize::models {

namespace {

// Lattice: x along the fuselage from tail to nose, y up, z to the right. The fuselage is one cell wide (z = 2) and
// three high; its middle layer (y = 1) goes on into the wings and tailplanes, its top into fin and canopy.
constexpr int stations = 10, layers = 4, columns = 5;

bool is_solid(int x, int y, int z) {
    const int outward = std::abs(z - 2);
    if (outward == 0 && y <= 2) return true;                          // fuselage
    if (outward == 0 && y == 3) return x <= 1 || x == 7;              // fin, canopy
    if (outward == 1 && y == 1) return x <= 1 || (x >= 3 && x <= 5);  // tailplane, inner wing
    return outward == 2 && y == 1 && x >= 3 && x <= 5;                // outer wing
}

// Outline of the fuselage, m. Fin and tailplane reach behind its tail, to -98.5.
constexpr double along[stations + 1] = {-86.5, -72, -56, -38, -20, 0, 20, 42, 62, 82, 98.5};
constexpr double half_width[stations + 1] = {5, 7, 9, 11, 12, 12, 11, 9.5, 7.5, 4.5, 1};
constexpr double half_height[stations + 1] = {5, 7, 9, 10, 10.5, 10.5, 10, 9, 7, 4, 1};

// A point that belongs to the fuselage: layers at bottom, wing root below and above, and top; the fourth is the ridge
// of fin and canopy, which lean back.
Vec3 on_fuselage(int x, int y, double side) {
    const double h = half_height[x];
    const double heights[] = {-h, -0.25 * h, 0.25 * h, h};
    if (y < 4) return {along[x], heights[y], side * half_width[x]};
    const bool fin = x <= 2;
    return {along[x] - (fin ? 12 + 2.0 * x : 2), fin ? 46 - 4.0 * x : h + 7, side * (fin ? 1.5 : 3.5)};
}

// A point of a wing or tailplane, `outward` columns (1 or 2) from the root: swept back, tapered and thin.
Vec3 on_wing(int x, int y, int outward, double side) {
    const bool tail = x <= 2;
    const double reach = tail ? 30 : 32.5 * outward, sweep = tail ? 14 : 26.0 * outward;
    const double taper = tail ? 0.6 : 1 - 0.32 * outward;
    const double middle = tail ? along[1] : along[4];
    const double thickness = (tail ? 2.0 : 3.6 - outward) * (y == 1 ? -0.5 : 0.5);
    const double dihedral = 0.06 * reach;
    return {middle + taper * (along[x] - middle) - sweep, dihedral + thickness, side * (12 + reach)};
}

Vec3 place(int x, int y, int z) {
    const double side = z <= 2 ? -1 : 1;
    const int outward = z <= 2 ? 2 - z : z - 3;
    return outward == 0 ? on_fuselage(x, y, side) : on_wing(x, y, outward, side);
}

}  // namespace

TriangleSoup fighter() { return lattice_surface({stations, layers, columns, is_solid, place}); }

}  // namespace kolize::models
