// Boxes and hulls for tests of narrowphases, and how deep boxes overlap by definition.
#pragma once

#include <kolize/world.h>

#include <vector>

namespace kolize::test {

// Of all separating axes of two boxes, the least overlap; below 0 where one separates them.
inline double box_depth(const World& world) {
    const Mat3 r[2] = {world.orientation[0].toRotationMatrix(), world.orientation[1].toRotationMatrix()};
    std::vector<Vec3> axes;
    for (int i = 0; i < 3; ++i) {
        axes.push_back(r[0].col(i));
        axes.push_back(r[1].col(i));
        for (int j = 0; j < 3; ++j) axes.push_back(r[0].col(i).cross(r[1].col(j)).normalized());
    }
    double depth = infinity;
    for (const Vec3& axis : axes) {
        double reach = -std::abs(axis.dot(world.position[1] - world.position[0]));
        for (const std::uint32_t body : {0u, 1u})
            reach += (r[body].transpose() * axis).cwiseAbs().dot(world.shape_of(body).half_extents);
        depth = std::min(depth, reach);
    }
    return depth;
}

inline std::vector<Vec3> corners_of_dodecahedron(double size) {
    const double g = 0.5 * (1 + std::sqrt(5.0));
    std::vector<Vec3> points;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) {
            for (const double z : {-1.0, 1.0}) points.emplace_back(x, y, z);
            points.emplace_back(0, x / g, y * g);
            points.emplace_back(x / g, y * g, 0);
            points.emplace_back(x * g, 0, y / g);
        }
    for (Vec3& p : points) p *= size;
    return points;
}

}  // namespace kolize::test
