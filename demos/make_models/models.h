// The models and start states of the demos, made by formulas: `make_models DIR` writes them all.
#pragma once

#include <kolize/world.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace kolize::models {

// The surface of solid cells of a box-shaped lattice, with lattice points moved to where the caller wants them. Cells
// that touch must share a side: then the surface is a closed two-manifold. Triangles are outward if `place` keeps the
// handedness of the axes.
struct Lattice {
    int nx = 1, ny = 1, nz = 1;                   // cells
    std::function<bool(int, int, int)> is_solid;  // asked for cells within the lattice only
    std::function<Vec3(int, int, int)> place;     // of a lattice point: 0..nx, 0..ny, 0..nz
};
TriangleSoup lattice_surface(const Lattice& lattice);

// Solids of a size of about 1 m, their base in the plane y = 0.
TriangleSoup tetrahedron();  // regular
TriangleSoup frustum();      // of a square pyramid
TriangleSoup cone();
TriangleSoup cylinder();
TriangleSoup u_bar();
TriangleSoup l_bar();
TriangleSoup torus();
TriangleSoup star();  // a prism on a star of five points

// An aeroplane of one closed surface, 197 m long, nose towards +x, y up: 142 vertices, 280 triangles, thin swept wings.
TriangleSoup fighter();

struct Model {
    const char* name;
    TriangleSoup (*make)();
};
std::span<const Model> object_models();  // the solids of box_objects

// Rounded to 6 decimals: the files do not depend on the last bit of a sine.
void round_vertices(TriangleSoup& soup);

// Random numbers that are the same on every machine.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    double uniform();             // [0, 1)
    Vec3 in_ball(double radius);  // not in its middle
    Quat attitude();

private:
    std::uint64_t state_;
};

// Tables of start states as CSV (see [[body]] from): the first line and a row, both with their line ends.
inline constexpr const char* state_header = "x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
std::string state_row(const BodyState& state);

// Start states of bodies near the points of a 3 x 3 x 3 lattice about the origin, in random attitudes, with random
// velocities and spins.
class StateWriter {
public:
    StateWriter(double spacing, double jitter, double speed, double spin, std::uint64_t seed);

    // A table of the next `count` bodies; `center_of_mass` in the model's frame, m.
    std::string table(int count, const Vec3& center_of_mass);

private:
    std::string row(const Vec3& center_of_mass);

    double spacing_, jitter_, speed_, spin_;
    Random random_;
    std::vector<Vec3> free_places_;
};

}  // namespace kolize::models
