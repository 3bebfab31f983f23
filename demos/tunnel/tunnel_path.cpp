#include "tunnel_path.h"

#include <algorithm>
#include <array>
#include <map>

namespace kolize::tunnel {
namespace {

using Key = std::array<int, 3>;

Key key(const Place& place) { return {place.x(), place.y(), place.z()}; }

std::string text(const Place& place) {
    return "(" + std::to_string(place.x()) + " " + std::to_string(place.y()) + " " + std::to_string(place.z()) + ")";
}

std::map<Key, std::size_t> cells_by_place(const std::vector<Cell>& cells) {
    std::map<Key, std::size_t> by_place;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (const auto [other, is_new] = by_place.try_emplace(key(cells[i].place), i); !is_new)
            throw Error(cells[i].where, "there is a cell at " + text(cells[i].place) + " already, in line " +
                                            std::to_string(cells[other->second].where.line));
    return by_place;
}

bool is_open_to(const Cell& cell, const Place& direction) {
    const std::vector<Place> open = openings(cell);
    return std::find(open.begin(), open.end(), direction) != open.end();
}

// The other opening of the cell, seen from the one towards `back`; zero where there is none.
Place way_on(const Cell& cell, const Place& back) {
    for (const Place& direction : openings(cell))
        if (direction != back) return direction;
    return Place::Zero();
}

}  // namespace

std::vector<Place> openings(const Cell& cell) {
    std::vector<Vec3> open{Vec3::UnitZ()};
    if (cell.type == CellType::straight) open.push_back(-Vec3::UnitZ());
    if (cell.type == CellType::left) open.push_back(-Vec3::UnitX());
    if (cell.type == CellType::right) open.push_back(Vec3::UnitX());
    std::vector<Place> turned;
    for (const Vec3& direction : open) turned.push_back((cell.rotation * direction).cast<int>());
    return turned;
}

std::vector<Cell> in_order_of_flight(std::vector<Cell> cells, const std::string& file) {
    if (cells.empty()) throw Error(SourceLocation{file}, "this tunnel has no cell; it takes at least two, S and S");
    if (cells.front().type != CellType::end) throw Error(cells.front().where, "a tunnel begins with a cell of type S");
    if (cells.size() == 1 || cells.back().type != CellType::end)
        throw Error(cells.back().where, "a tunnel ends with another cell of type S");
    const std::map<Key, std::size_t> by_place = cells_by_place(cells);
    std::vector<Cell> way;
    std::vector<bool> is_on_way(cells.size());
    Place back = Place::Zero();
    for (std::size_t i = 0;;) {
        is_on_way[i] = true;
        way.push_back(cells[i]);
        Cell& cell = way.back();
        cell.back = back;
        cell.ahead = way_on(cell, back);
        if (cell.ahead.isZero()) break;
        const Place next = cell.place + cell.ahead;
        const auto found = by_place.find(key(next));
        if (found == by_place.end())
            throw Error(cell.where, "this cell is open towards " + text(next) + ", where there is no cell");
        i = found->second;
        back = -cell.ahead;
        if (!is_open_to(cells[i], back))
            throw Error(cell.where, "this cell is open towards " + text(next) + ", where the cell of line " +
                                        std::to_string(cells[i].where.line) + " has a wall");
    }
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (!is_on_way[i])
            throw Error(cells[i].where, "this cell is not on the way from the first cell to the end of the tunnel");
    return way;
}

}  // namespace kolize::tunnel
