// Bodies made of unit cubes on the integer grid: every touch, tie and coplanar face there is, and an exact overlap.
#pragma once

#include <kolize/mesh.h>

#include <array>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace oracle {

using Cell = std::array<int, 3>;  // the cube from here to here plus (1, 1, 1)

// A connected set of cells about the origin.
inline std::set<Cell> random_cells(std::mt19937_64& random, std::size_t count) {
    std::set<Cell> cells = {{0, 0, 0}};
    while (cells.size() < count) {
        Cell next = *std::next(cells.begin(), static_cast<long>(random() % cells.size()));
        next[random() % 3] += random() % 2 ? 1 : -1;
        cells.insert(next);
    }
    return cells;
}

// The surface; each square is cut along a random diagonal. Not closed where cells share no more than an edge.
inline kolize::TriangleSoup surface(const std::set<Cell>& cells, std::mt19937_64& random) {
    kolize::TriangleSoup soup;
    std::map<Cell, std::uint32_t> ids;
    const auto vertex = [&](const Cell& p) {
        const auto [at, is_new] = ids.try_emplace(p, static_cast<std::uint32_t>(soup.vertices.size()));
        if (is_new) soup.vertices.emplace_back(p[0], p[1], p[2]);
        return at->second;
    };
    for (const Cell& cell : cells)
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1}) {
                Cell neighbour = cell;
                neighbour[axis] += side ? 1 : -1;
                if (cells.count(neighbour)) continue;
                std::array<std::uint32_t, 4> square;
                for (int k = 0; k < 4; ++k) {  // counter-clockwise from outside
                    const int corner = side ? k : 3 - k;
                    Cell p = cell;
                    p[axis] += side;
                    p[(axis + 1) % 3] += corner == 1 || corner == 2;
                    p[(axis + 2) % 3] += corner >= 2;
                    square[k] = vertex(p);
                }
                const std::size_t k = random() % 2;
                soup.triangles.push_back({square[k], square[k + 1], square[k + 2]});
                soup.triangles.push_back({square[k], square[k + 2], square[(k + 3) % 4]});
            }
    return soup;
}

// Of two sets of cells whose first is moved by a step that is infinitesimal but not zero along any axis.
class NudgedOverlap {
public:
    NudgedOverlap(const std::set<Cell>& a, const std::set<Cell>& b, const Cell& signs) : signs_(signs) {
        for (const Cell& i : a)
            for (const Cell& j : b) add({j[0] - i[0], j[1] - i[1], j[2] - i[2]}, j);
    }

    // How the volume grows as the first set is moved on: exact.
    const Cell& gradient() const { return gradient_; }

    std::size_t components() const {
        std::vector<std::size_t> parent(boxes_.size());
        std::iota(parent.begin(), parent.end(), std::size_t(0));
        const auto root = [&](std::size_t i) {
            while (parent[i] != i) i = parent[i];
            return i;
        };
        for (std::size_t i = 0; i < boxes_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (share_a_face(boxes_[i], boxes_[j])) parent[root(i)] = root(j);
        std::size_t roots = 0;
        for (std::size_t i = 0; i < parent.size(); ++i) roots += parent[i] == i;
        return roots;
    }

private:
    struct Box {
        std::array<double, 3> low, high;
    };

    // A cell of the second set, `apart` from one of the first.
    void add(const Cell& apart, const Cell& cell) {
        const auto reaches = [&](int k) { return apart[k] == 0 || apart[k] == signs_[k]; };
        for (int k = 0; k < 3; ++k) {
            const bool aligned = apart[(k + 1) % 3] == 0 && apart[(k + 2) % 3] == 0;
            if (aligned && apart[k] == signs_[k]) gradient_[k] += signs_[k];
            if (aligned && apart[k] == 0) gradient_[k] -= signs_[k];
        }
        if (!reaches(0) || !reaches(1) || !reaches(2)) return;
        Box box;
        for (int k = 0; k < 3; ++k) {
            const double step = 0.25 * signs_[k];  // any step below a cell connects the same boxes
            box.low[k] = std::max<double>(cell[k], cell[k] - apart[k] + step);
            box.high[k] = std::min<double>(cell[k], cell[k] - apart[k] + step) + 1;
        }
        boxes_.push_back(box);
    }

    static bool share_a_face(const Box& x, const Box& y) {
        int crossing = 0, touching = 0;
        for (int k = 0; k < 3; ++k) {
            const double common = std::min(x.high[k], y.high[k]) - std::max(x.low[k], y.low[k]);
            crossing += common > 0;
            touching += common == 0;
        }
        return crossing + touching == 3 && crossing >= 2;
    }

    Cell signs_;
    Cell gradient_ = {0, 0, 0};
    std::vector<Box> boxes_;
};

}  // namespace oracle
