#include "models.h"

#include <array>
#include <cmath>
#include <map>

namespace kolize::models {

namespace {

using Cell = std::array<int, 3>;

// Numbers lattice points as the surface meets them.
class Surface {
public:
    explicit Surface(const Lattice& lattice) : lattice_(lattice) {}

    void add_cell(const Cell& cell) {
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1}) {
                Cell neighbour = cell;
                neighbour[axis] += side ? 1 : -1;
                if (!is_solid(neighbour)) add_quad(cell, axis, side);
            }
    }

    bool is_solid(const Cell& c) const {
        const bool within =
            c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[0] < lattice_.nx && c[1] < lattice_.ny && c[2] < lattice_.nz;
        return within && lattice_.is_solid(c[0], c[1], c[2]);
    }

    TriangleSoup soup;

private:
    std::uint32_t vertex(const Cell& point) {
        const auto [found, is_new] = numbers_.try_emplace(point, static_cast<std::uint32_t>(soup.vertices.size()));
        if (is_new) soup.vertices.push_back(lattice_.place(point[0], point[1], point[2]));
        return found->second;
    }

    // The side of a cell across an axis, counter-clockwise seen from outside.
    void add_quad(const Cell& cell, int axis, int side) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<std::uint32_t, 4> corners{};
        for (int k = 0; k < 4; ++k) {
            Cell point = cell;
            point[axis] += side;
            point[u] += k == 1 || k == 2;
            point[v] += k >= 2;
            corners[side ? k : 3 - k] = vertex(point);
        }
        const auto& p = soup.vertices;
        const double cut02 = (p[corners[2]] - p[corners[0]]).norm(), cut13 = (p[corners[3]] - p[corners[1]]).norm();
        const int first = cut13 < 0.999999 * cut02 ? 1 : 0;  // along the shorter diagonal
        for (const int k : {1, 2})
            soup.triangles.push_back({corners[first], corners[(first + k) % 4], corners[(first + k + 1) % 4]});
    }

    const Lattice& lattice_;
    std::map<Cell, std::uint32_t> numbers_;
};

}  // namespace

TriangleSoup lattice_surface(const Lattice& lattice) {
    Surface surface(lattice);
    for (int i = 0; i < lattice.nx; ++i)
        for (int j = 0; j < lattice.ny; ++j)
            for (int k = 0; k < lattice.nz; ++k)
                if (surface.is_solid({i, j, k})) surface.add_cell({i, j, k});
    round_vertices(surface.soup);
    return std::move(surface.soup);
}

void round_vertices(TriangleSoup& soup) {
    for (Vec3& v : soup.vertices)
        for (double& x : v) x = std::round(x * 1e6) / 1e6 + 0.0;  // no minus zero
}

}  // namespace kolize::models
