#include "massprops/parts.h"

#include <kolize/winding_number.h>

#include <algorithm>
#include <numeric>

namespace kolize::cli {
namespace {

constexpr std::size_t looks_per_part = 15;  // odd: a majority decides

// Vertices joined by triangles (union-find with path halving).
class Connected {
public:
    explicit Connected(const TriangleSoup& surface) : parent_(surface.vertices.size()) {
        std::iota(parent_.begin(), parent_.end(), 0u);
        for (const auto& [a, b, c] : surface.triangles) {
            parent_[root(a)] = root(b);
            parent_[root(b)] = root(c);
        }
    }
    std::uint32_t root(std::uint32_t v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }

private:
    std::vector<std::uint32_t> parent_;
};

// Triangles of each part, the parts in the order of their first triangles.
std::vector<std::vector<std::uint32_t>> parts_of(const TriangleSoup& surface) {
    Connected connected(surface);
    std::vector<std::uint32_t> part(surface.vertices.size(), ~0u);
    std::vector<std::vector<std::uint32_t>> parts;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        std::uint32_t& id = part[connected.root(surface.triangles[t][0])];
        if (id == ~0u) {
            id = static_cast<std::uint32_t>(parts.size());
            parts.emplace_back();
        }
        parts[id].push_back(t);
    }
    return parts;
}

// How often the surface winds around a point just outside a triangle, rounded.
int winding_outside(const TriangleSoup& surface, const WindingNumber& winding, std::uint32_t triangle) {
    const auto& [a, b, c] = surface.triangles[triangle];
    const Vec3 &p = surface.vertices[a], &q = surface.vertices[b], &r = surface.vertices[c];
    const Vec3 area = (q - p).cross(r - p);
    const double size = std::sqrt(area.norm());
    if (size == 0) return 0;
    return static_cast<int>(std::lround(winding.at((p + q + r) / 3 + 1e-3 / size * area)));
}

// The median over some of its triangles: others may reach into other parts.
int winding_outside(const TriangleSoup& surface, const WindingNumber& winding, const std::vector<std::uint32_t>& part) {
    std::vector<int> looks;
    const std::size_t count = std::min(looks_per_part, part.size());
    for (std::size_t i = 0; i < count; ++i)
        looks.push_back(winding_outside(surface, winding, part[i * part.size() / count]));
    std::nth_element(looks.begin(), looks.begin() + static_cast<std::ptrdiff_t>(count / 2), looks.end());
    return looks[count / 2];
}

}  // namespace

PartsReport orient_parts(TriangleSoup& surface) {
    const std::vector<std::vector<std::uint32_t>> parts = parts_of(surface);
    PartsReport report{parts.size(), 0, 0};
    if (parts.size() < 2) return report;
    const WindingNumber winding(surface);
    std::vector<std::uint32_t> inside_out;
    for (const std::vector<std::uint32_t>& part : parts) {
        const int outside = winding_outside(surface, winding, part);
        if (outside > 0) ++report.nested;
        if (outside >= 0) continue;
        ++report.turned;
        inside_out.insert(inside_out.end(), part.begin(), part.end());
    }
    for (const std::uint32_t t : inside_out) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
    return report;
}

}  // namespace kolize::cli
