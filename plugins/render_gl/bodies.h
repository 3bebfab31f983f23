// Draws spheres, boxes and meshes: one instanced call a surface, however many bodies have it.
#pragma once

#include "geometry.h"
#include "palette.h"
#include "program.h"
#include "view.h"

#include <string>

namespace kolize::gl {

class Bodies {
public:
    Bodies();

    // Takes over the surfaces of all shapes, and the colours of all bodies. `colour_by` is auto, shape, kind or body.
    void prepare(const World& world, double crease, const std::string& colour_by);
    void draw(const World& world, const View& view, int picture_height, float gloss);

private:
    struct Batch {
        VertexArray array;
        Buffer vertices, indices, instances;
        GLsizei index_count = 0;
    };
    // A body as the shader takes it.
    struct Instance {
        Eigen::Matrix<float, 3, 4, Eigen::RowMajor> placement;
        std::array<std::uint8_t, 4> paint;
    };
    static constexpr int ball_levels = 4;  // the first batches: the ball, ever finer

    void add_batch(const Surface& surface);
    void collect(const World& world, const View& view, double pixels_at_1_m);

    Program program_;
    std::vector<Batch> batches_;
    std::vector<std::size_t> batch_of_shape_;
    std::vector<Colour> colour_of_body_;
    std::vector<std::vector<Instance>> instances_;  // a list for each batch
};

// Whether a body is there to be drawn as one: not removed, at a finite place, and no wall of a room.
bool is_drawn(const World& world, std::uint32_t body);

}  // namespace kolize::gl
