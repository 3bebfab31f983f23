// Closest features of a triangle mesh, and by them its contacts with a sphere or a half-space.
//
// Body A is the mesh; regions stand in its body frame.
#pragma once

#include "contact_region.h"

#include <kolize/mesh.h>

namespace kolize {

// The point of one triangle that is nearest to a query point, and the mesh feature it lies on.
struct SurfacePoint {
    enum class Feature : std::uint8_t { face, edge, vertex };
    Vec3 point;
    double distance = 0;  // m
    Feature feature = Feature::face;
    std::uint32_t id = 0;  // of the triangle, edge or vertex
    std::uint32_t triangle = 0;
};

SurfacePoint nearest_on_triangle(const Mesh& mesh, std::uint32_t triangle, const Vec3& p);

struct MeshScratch {
    std::vector<SurfacePoint> candidates;
    std::vector<std::uint32_t> parent;  // union-find over vertices
    std::vector<Vec3> points;
    std::vector<std::uint32_t> triangles, edges, vertices;  // near a capsule
    std::vector<double> crossings;                          // along a capsule's core
    std::vector<ContactRegion> regions;                     // of one end of it
};

// The point of a closed surface nearest to p, and on which side of the surface p lies.
struct NearestPoint {
    SurfacePoint at;
    Vec3 outward = Vec3::Zero();  // unit: the surface's normal there, the mean one on an edge or corner
    double height = 0;            // m: the distance, < 0 inside
};

// Needs at least one triangle.
NearestPoint nearest_on_mesh(const Mesh& mesh, const Vec3& p, MeshScratch& scratch);

// One region for each local minimum of the distance from the centre to the surface that is below the radius; one only,
// the nearest way out, when the centre is inside the mesh.
void mesh_sphere(const Mesh& mesh, const Vec3& center, double radius, MeshScratch& scratch,
                 std::vector<ContactRegion>& regions);

// The half-space {p : normal . p <= offset}. One region for each connected part of the surface below the plane.
void mesh_half_space(const Mesh& mesh, const Vec3& normal, double offset, MeshScratch& scratch,
                     std::vector<ContactRegion>& regions);

}  // namespace kolize
