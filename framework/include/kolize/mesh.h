// Triangle meshes: vertices, outward triangles, topology and a hierarchy of boxes.
#pragma once

#include <kolize/hierarchy.h>
#include <kolize/error.h>
#include <kolize/math.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace kolize {

using Triangle = std::array<std::uint32_t, 3>;  // vertex indices, counter-clockwise seen from outside

// What a file holds, before anything is assumed about it but this: indices are in range and coordinates finite.
struct TriangleSoup {
    std::vector<Vec3> vertices;  // file units
    std::vector<Triangle> triangles;
    std::vector<int> lines;  // per triangle: where the file names it; empty when the file has no lines
    std::string file;
    std::vector<std::string> info = {};   // what the file says about itself (WorldInfo of VRML); write_mesh keeps it
    std::vector<std::string> notes = {};  // what the reader passed over, in sentences: "x.wrl:12: Inline is not used"
};

// What is wrong with a soup as the surface of a solid. All false and zero: a closed, oriented, two-manifold surface.
struct MeshDefects {
    bool empty = false;
    std::size_t open_edges = 0;            // edges with one triangle only
    std::size_t non_manifold_edges = 0;    // edges with three triangles or more
    std::size_t misoriented_edges = 0;     // edges that both their triangles run through the same way
    std::size_t degenerate_triangles = 0;  // a vertex twice, or no area
    std::size_t repeated_triangles = 0;    // with the same three vertices as an earlier one
    std::size_t unbalanced_edges = 0;      // edges that are not run through as often one way as the other
    bool inverted = false;                 // closed, but with the normals inward (negative volume) or with no volume
    std::string first;                     // one phrase for the first defect: "edge 3-17 has one triangle (x.obj:12)";
                                           // vertices and triangles count from 0

    bool closed() const {
        return !empty && !open_edges && !non_manifold_edges && !misoriented_edges && !inverted && !degenerate_triangles;
    }
    // Weaker than closed(): the triangles bound a volume (every point is a whole number of times inside), so integrals
    // over them are exact, though several sheets may meet in an edge or a triangle may have no area.
    bool bounds_volume() const { return !empty && !unbalanced_edges; }
};

KOLIZE_API MeshDefects inspect(const TriangleSoup& soup);

struct Edge {
    std::uint32_t v0 = 0, v1 = 0;  // vertices, v0 < v1
    std::uint32_t t0 = 0, t1 = 0;  // the two triangles; t0 runs v0 -> v1, t1 runs v1 -> v0 (t1 == t0 on a border)
};

// The same triangles with vertices that are equal (coordinate by coordinate) made one; unused vertices stay.
KOLIZE_API TriangleSoup join_equal_vertices(TriangleSoup soup);

// Immutable after build_mesh; shared by all bodies of its shape. Coordinates are in the shape's body frame (m).
struct KOLIZE_API Mesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    std::vector<Vec3> normals;  // per triangle: unit, outward; zero for a triangle without area
    std::vector<Edge> edges;
    std::vector<Triangle> triangle_edges;  // per triangle: edge ids; edge k joins vertex k and vertex (k + 1) % 3
    std::vector<std::uint32_t> valence;    // per vertex: number of triangles around it
    Hierarchy hierarchy;
    Aabb bounds;
    double radius = 0;  // largest distance of a triangle's vertex from the frame's origin
    bool closed = false;
};

// Vertices are used as they stand (map them to the body frame first). The soup may be open, for static queries:
// triangle ids are kept, and a side that finds no partner gets an edge of its own.
KOLIZE_API std::shared_ptr<const Mesh> build_mesh(const TriangleSoup& soup);
// The same for a soup of which inspect has said already whether it is closed, here or before a rigid motion.
KOLIZE_API std::shared_ptr<const Mesh> build_mesh(const TriangleSoup& soup, bool closed);

// A box of the given half extents as twelve triangles about the origin.
KOLIZE_API TriangleSoup box_soup(const Vec3& half_extents);

}  // namespace kolize
