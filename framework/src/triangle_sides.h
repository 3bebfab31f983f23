// The sides and normals of triangles: what both the inspection and the building of a mesh start from.
#pragma once

#include <kolize/mesh.h>

#include <span>

namespace kolize {

// One side of a triangle. Sides of the same edge stand side by side when sorted, in the order of their triangles.
struct Side {
    std::uint32_t v0, v1;  // v0 <= v1
    std::uint32_t triangle;
    std::uint32_t corner;  // the side joins this corner and the next one
    bool forward;          // the triangle runs v0 -> v1

    bool same_edge(const Side& o) const { return v0 == o.v0 && v1 == o.v1; }
    bool operator<(const Side& o) const {
        if (v0 != o.v0) return v0 < o.v0;
        if (v1 != o.v1) return v1 < o.v1;
        return triangle != o.triangle ? triangle < o.triangle : corner < o.corner;
    }
};

using Sides = std::span<const Side>;

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles);

template <class Visit>
void for_each_edge(const std::vector<Side>& sides, const Visit& visit) {
    for (std::size_t begin = 0; begin < sides.size();) {
        std::size_t end = begin + 1;
        while (end < sides.size() && sides[end].same_edge(sides[begin])) ++end;
        visit(Sides(&sides[begin], end - begin));
        begin = end;
    }
}

// Unit normal of a triangle; zero if it is flat to within rounding.
Vec3 unit_normal(const TriangleSoup& soup, const Triangle& triangle);

}  // namespace kolize
