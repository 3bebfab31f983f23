#include "bounding_volumes/local_points.h"

#include <kolize/bounding_volumes.h>

namespace kolize {

Aabb bounding_box(std::span<const Vec3> points) {
    require_points(points);
    Aabb box;
    for (const Vec3& p : points) box.include(p);
    return box;
}

}  // namespace kolize
