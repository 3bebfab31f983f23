// How the cells of a tunnel hang together.
#pragma once

#include "tunnel_file.h"

namespace kolize::tunnel {

// Towards the neighbours to which a cell is open: where it is entered in its own frame, then where it is left.
std::vector<Place> openings(const Cell& cell);

// The cells from the first one on, following their openings to the last, with `back` and `ahead` filled in. Throws
// Error where they are no tunnel: it begins and ends with S, every opening leads to another, every cell is on the way.
std::vector<Cell> in_order_of_flight(std::vector<Cell> cells, const std::string& file);

}  // namespace kolize::tunnel
