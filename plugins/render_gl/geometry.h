// Surfaces of shapes as triangles that OpenGL takes: places and normals in the body's frame.
#pragma once

#include <kolize/mesh.h>

namespace kolize::gl {

struct Vertex {
    Eigen::Vector3f place;   // m
    Eigen::Vector3f normal;  // unit
};

struct Surface {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;  // three a triangle, counter-clockwise seen from outside
};

// The mesh, rounded wherever two triangles meet at less than `crease` (rad) and sharp elsewhere: 0 gives flat faces,
// pi a surface that is smooth everywhere.
Surface surface_of(const Mesh& mesh, double crease);

// A ball of radius 1: an octahedron, every triangle of it split into four `splits` times.
Surface unit_ball(int splits);

}  // namespace kolize::gl
