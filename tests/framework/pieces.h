// Surfaces made of others.
#pragma once

#include <kolize/mesh.h>

namespace kolize::test {

inline TriangleSoup box_between(const Vec3& low, const Vec3& high) {
    TriangleSoup soup = box_soup(0.5 * (high - low));
    for (Vec3& v : soup.vertices) v += 0.5 * (low + high);
    return soup;
}

inline TriangleSoup inside_out(TriangleSoup soup) {
    for (Triangle& t : soup.triangles) std::swap(t[1], t[2]);
    return soup;
}

inline TriangleSoup both(TriangleSoup first, const TriangleSoup& second) {
    const auto shift = static_cast<std::uint32_t>(first.vertices.size());
    first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
    for (const auto& [a, b, c] : second.triangles) first.triangles.push_back({a + shift, b + shift, c + shift});
    return first;
}

}  // namespace kolize::test
