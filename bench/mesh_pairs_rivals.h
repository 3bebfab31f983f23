// Two meshes, one of them moved: other libraries at the work of kolize's narrowphases, for bench_mesh_pairs.
#pragma once

#include <kolize/mesh.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace bench {

using TrianglePairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // of the mesh, of its copy

// A mesh and a copy of it in some other place.
class MeshQuery {
public:
    virtual ~MeshQuery() = default;
    virtual bool overlap(const kolize::Transform& copy_to_mesh) = 0;
    // Appends the intersecting triangles, each pair once, in any order.
    virtual void intersect(const kolize::Transform& copy_to_mesh, TrianglePairs& pairs) = 0;

    std::string name;
};

std::vector<std::unique_ptr<MeshQuery>> rival_queries(const kolize::TriangleSoup& surface);

// By brute force: every two triangles whose boxes overlap, by the exact predicates of CGAL. The copy's vertices are
// those that kolize::Transform gives. Sorted.
TrianglePairs exact_pairs(const kolize::TriangleSoup& surface, const kolize::Transform& copy_to_mesh);

}  // namespace bench
