// The file of a tunnel: cubes one after another, and the bodies in each. docs/tunnel.md has the grammar.
#pragma once

#include <kolize/error.h>
#include <kolize/math.h>

#include <filesystem>
#include <string>
#include <vector>

namespace kolize::tunnel {

using Place = Eigen::Vector3i;  // of a cell, or one step from it to a neighbour, in whole cubes

enum class CellType { end, straight, left, right };  // S, I, L, R

struct PlacedBody {
    std::string file;                     // as written: relative to the tunnel's file, or `ball`
    Vec3 position = Vec3::Zero();         // in the cell's frame, in half cubes
    Quat orientation = Quat::Identity();  // model frame to the cell's frame
    SourceLocation where;
};

// In its own frame a cell is entered along -z, from the cell at +z; the origin is its centre.
struct Cell {
    CellType type = CellType::end;
    Place place = Place::Zero();
    Mat3 rotation = Mat3::Identity();  // cell's frame to world; maps the cube to itself, so each entry is 0, 1 or -1
    Place back = Place::Zero();        // towards the cell before it; zero for the first
    Place ahead = Place::Zero();       // towards the cell after it; zero for the last
    std::vector<PlacedBody> statics, dynamics;
    SourceLocation where;
};

// At least two cells in the order of flight, each open to the ones before and after it and nowhere else.
struct Tunnel {
    std::filesystem::path file;
    std::vector<Cell> cells;
};

inline constexpr std::size_t max_cells = 1000;
inline constexpr std::size_t max_bodies = 5000;
inline constexpr int max_place = 10000;  // cubes from the origin

// `file` is for messages, and what files of bodies are relative to. Throws Error with file:line:column for whatever is
// not a tunnel. The files of bodies are not opened.
Tunnel parse_tunnel(const std::string& text, const std::filesystem::path& file);
Tunnel read_tunnel(const std::filesystem::path& file);

}  // namespace kolize::tunnel
