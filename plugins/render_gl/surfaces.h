// Draws what has no outer side: rooms, by the inner sides of their walls, and half-spaces, by a square that reaches as
// far as one can see.
#pragma once

#include "program.h"
#include "view.h"

#include <span>
#include <string>

namespace kolize::gl {

class Surfaces {
public:
    Surfaces();

    // `cell` is the side of a square of the texture, m; 0 chooses it for each room, and for the floors by the bodies.
    void prepare(const World& world, std::span<const Room> rooms, double cell);
    // `pattern` is plain, checker or grid.
    void draw(const World& world, const View& view, const std::string& pattern, const float (&background)[3]);

private:
    struct Corner {
        Eigen::Vector3f place, normal, tint;
        Eigen::Vector2f cell;
    };
    struct Square {
        Vec3 center, across, upward;  // half sides, world axes, m; the surface is seen from across x upward
        Eigen::Vector2d first_cell;   // of the texture, at the middle
        double cell;
        Eigen::Vector3f tint;
    };

    void add_walls(const Room& room, const View& view);
    void add_floor(const World& world, std::uint32_t body, const View& view);
    void add(const Square& square, const View& view);

    Program program_;
    VertexArray array_;
    Buffer buffer_;
    std::vector<Room> rooms_;
    double cell_ = 0;
    double floor_cell_ = 1;
    std::vector<Corner> corners_;  // six a square
};

}  // namespace kolize::gl
