// Mass properties as one would write them at first, for bench_massprops to compare with.
#pragma once

#include <kolize/voxel_mass_properties.h>

#include <cstdint>
#include <memory>

namespace bench {

// The integrals of kolize::mass_properties in one loop of running doubles, about the first vertex. Same errors and
// units; the surface has a triangle at least.
kolize::MassProperties scalar_mass_properties(const kolize::TriangleSoup& closed_surface);

// A surface in Embree for rays one at a time: after each hit the ray starts anew a little behind it.
class SingleRays {
public:
    explicit SingleRays(const kolize::TriangleSoup& surface);
    ~SingleRays();

    // Crossings of the grid's lines.
    kolize::MakeLineCaster line_caster() const;

    // Every voxel's centre by itself: inside if a ray from it along x meets the surface an odd number of times. Those
    // inside count as points, like the midpoint count of voxel_mass_properties.
    kolize::MassProperties by_points(const kolize::VoxelGrid& grid) const;

private:
    class Scene;
    std::shared_ptr<const Scene> scene_;
};

}  // namespace bench
