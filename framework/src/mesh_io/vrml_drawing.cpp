#include "mesh_io/vrml_drawing.h"

namespace kolize::mesh_io::vrml {

namespace {

[[noreturn]] void fail(const TriangleSoup& soup, const Node& node, const std::string& message) {
    throw Error(SourceLocation{soup.file, node.type.line}, message);
}

bool is_identity(const Placement& placement) {
    return placement.linear == Mat3::Identity() && placement.shift.isZero(0) && !placement.mirrored;
}

}  // namespace

void Drawing::draw(const Node& node, const Placement& placement) {
    if (++drawn_nodes_ > max_drawn_nodes)
        fail(soup_, node, "with all its USEs the file has more than " + std::to_string(max_drawn_nodes) + " nodes");
    node.draw(*this, placement);
}

void Drawing::require_room(const Node& geometry, std::size_t points, std::size_t triangles) const {
    if (triangles > max_triangles - soup_.triangles.size() || points > max_triangles - soup_.vertices.size())
        fail(soup_, geometry,
             "with all its USEs the file has more than " + std::to_string(max_triangles) + " triangles or vertices");
}

void Drawing::add(const Node& geometry, std::span<const Vec3> points, std::span<const Triangle> triangles,
                  std::span<const int> lines, const Placement& placement) {
    require_room(geometry, points.size(), triangles.size());
    const bool unmoved = is_identity(placement);  // to the bit: even the sign of zero stays
    const auto first = static_cast<std::uint32_t>(soup_.vertices.size());
    for (const Vec3& p : points) {
        soup_.vertices.push_back(unmoved ? p : placement * p);
        if (!soup_.vertices.back().allFinite())
            fail(soup_, geometry, "a coordinate is too large for a double where this node is placed");
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        auto [a, b, c] = triangles[t];
        if (placement.mirrored) std::swap(b, c);
        soup_.triangles.push_back({first + a, first + b, first + c});
        soup_.lines.push_back(lines.empty() ? geometry.type.line : lines[t]);
    }
}

void GeneratedGeometry::draw(Drawing& drawing, const Placement& placement) const {
    const Surface made = surface();
    drawing.add(*this, made.points, made.triangles, {}, placement);
}

void Surface::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) triangles.push_back({a, b, c});
}

void Surface::add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    add_triangle(a, b, c);
    add_triangle(a, c, d);
}

}  // namespace kolize::mesh_io::vrml
