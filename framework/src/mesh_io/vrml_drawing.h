// Draws the nodes of a VRML97 file: every instance of a geometry becomes triangles of the soup.
#pragma once

#include "mesh_io/vrml_node.h"

namespace kolize::mesh_io::vrml {

// A short file may stand for a huge scene, as each group may use the one before twice. These limits end it.
inline constexpr std::size_t max_drawn_nodes = 10'000'000;
inline constexpr std::size_t max_triangles = 20'000'000;  // and as many vertices

class Drawing {
public:
    // `soup` must live as long; its file name stands in messages.
    explicit Drawing(TriangleSoup& soup) : soup_(soup) {}

    // Throws Error with the line of the node that goes over a limit, or whose coordinates grow past a double.
    void draw(const Node& node, const Placement& placement);

    // For geometries: `lines` of the triangles, all that of the node if empty.
    void add(const Node& geometry, std::span<const Vec3> points, std::span<const Triangle> triangles,
             std::span<const int> lines, const Placement& placement);

private:
    void require_room(const Node& geometry, std::size_t points, std::size_t triangles) const;

    TriangleSoup& soup_;
    std::size_t drawn_nodes_ = 0;
};

}  // namespace kolize::mesh_io::vrml
