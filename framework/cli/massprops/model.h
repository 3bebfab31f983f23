// The model as it is measured: read, scaled, and looked at for everything that makes its numbers doubtful.
#pragma once

#include <kolize/bounding_volumes.h>
#include <kolize/mass_properties.h>
#include <kolize/self_intersection.h>

namespace kolize::cli {

struct Model {
    TriangleSoup surface;  // outward where it bounds a volume
    MeshDefects defects;
    SelfIntersections crossings;
    std::vector<std::string> remarks;  // what was found or done, a sentence each
    std::size_t parts = 0;             // connected parts of a surface that bounds a volume
    double area = 0;

    bool bounds_volume() const { return defects.bounds_volume(); }
};

// Vertices that are equal are joined if the surface has gaps without, and a surface that is inside out is turned: both
// with a remark. Throws Error for a file that cannot be read, or a closed surface without volume.
Model load_model(const std::string& file, double scale);

struct BoundingVolumes {
    Aabb box;
    BoundingSphere about_center;  // of mass
    BoundingSphere smallest;
    OrientedBox oriented;
    SlabPolytope slabs_18, slabs_26;
};

BoundingVolumes bounding_volumes(const TriangleSoup& surface, const Vec3& center_of_mass);

}  // namespace kolize::cli
