#include "triangle_sides.h"

#include <kolize/mass_properties.h>

#include <algorithm>
#include <numeric>

namespace kolize {

namespace {

constexpr std::uint32_t none = ~0u;

bool repeats_vertex(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// Per triangle: the first one with the same three vertices, in any order; none if it is the first itself.
std::vector<std::uint32_t> find_originals(std::vector<Triangle> triangles) {
    for (Triangle& t : triangles) std::sort(t.begin(), t.end());
    std::vector<std::uint32_t> order(triangles.size()), originals(triangles.size(), none);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return triangles[a] != triangles[b] ? triangles[a] < triangles[b] : a < b;
    });
    for (std::size_t i = 1; i < order.size(); ++i) {
        const std::uint32_t before = order[i - 1], t = order[i];
        if (triangles[t] == triangles[before]) originals[t] = originals[before] == none ? before : originals[before];
    }
    return originals;
}

// Counts defects and describes the first one.
class Inspector {
public:
    explicit Inspector(const TriangleSoup& soup) : soup_(soup), originals_(find_originals(soup.triangles)) {}

    MeshDefects run() {
        found_.empty = soup_.triangles.empty();
        if (found_.empty) describe("it has no triangles" + file());
        look_at_triangles();
        look_at_edges();
        if (found_.closed()) look_at_volume();
        return found_;
    }

private:
    void describe(const std::string& phrase) {
        if (found_.first.empty()) found_.first = phrase;
    }

    std::string file() const { return soup_.file.empty() ? "" : " (" + soup_.file + ")"; }

    std::string line_or_file(std::uint32_t triangle) const {
        if (soup_.lines.empty()) return file();
        return " (" + to_string(SourceLocation{soup_.file, soup_.lines[triangle]}) + ")";
    }

    std::string place_of(std::uint32_t triangle) const {
        if (!soup_.lines.empty()) return line_or_file(triangle);
        return " (" + (soup_.file.empty() ? "" : soup_.file + ", ") + "triangle " + std::to_string(triangle) + ")";
    }

    void look_at_triangles() {
        for (std::uint32_t t = 0; t < soup_.triangles.size(); ++t) {
            const Triangle& triangle = soup_.triangles[t];
            found_.repeated_triangles += originals_[t] != none;
            const bool repeats = repeats_vertex(triangle);
            if (!repeats && !unit_normal(soup_, triangle).isZero(0)) continue;
            ++found_.degenerate_triangles;
            describe((repeats ? "a triangle names a vertex twice" : "a triangle has no area") + place_of(t));
        }
    }

    // A triangle that names a vertex twice is a collapsed one: without it its two neighbours share the edge.
    void look_at_edges() {
        std::vector<Side> sides = sorted_sides(soup_.triangles);
        std::erase_if(sides, [&](const Side& side) { return repeats_vertex(soup_.triangles[side.triangle]); });
        for_each_edge(sides, [&](Sides edge) { look_at_edge(edge); });
    }

    void look_at_edge(Sides edge) {
        const auto forward = std::count_if(edge.begin(), edge.end(), [](const Side& side) { return side.forward; });
        found_.unbalanced_edges += 2 * static_cast<std::size_t>(forward) != edge.size();
        if (edge.size() == 1) {
            ++found_.open_edges;
            describe_edge(edge, "has one triangle");
        } else if (edge.size() > 2) {
            ++found_.non_manifold_edges;
            describe_edge(edge, "has " + std::to_string(edge.size()) + " triangles");
        } else if (forward != 1) {
            ++found_.misoriented_edges;
            describe_edge(edge, "has two triangles of opposite orientation");
        }
    }

    // A triangle that is there twice is the cause, the edge only its effect.
    void describe_edge(Sides edge, const std::string& what) {
        if (!found_.first.empty()) return;
        for (const Side& side : edge)
            if (const std::uint32_t t = side.triangle; originals_[t] != none)
                return describe("triangle " + std::to_string(t) + " repeats triangle " + std::to_string(originals_[t]) +
                                line_or_file(t));
        describe("edge " + std::to_string(edge[0].v0) + "-" + std::to_string(edge[0].v1) + " " + what +
                 place_of(edge.back().triangle));
    }

    void look_at_volume() {
        const double volume = mass_properties(soup_).volume;
        found_.inverted = volume <= 0;
        if (found_.inverted) describe((volume < 0 ? "its triangles face inward" : "it encloses no volume") + file());
    }

    const TriangleSoup& soup_;
    std::vector<std::uint32_t> originals_;
    MeshDefects found_;
};

}  // namespace

MeshDefects inspect(const TriangleSoup& soup) { return Inspector(soup).run(); }

}  // namespace kolize
