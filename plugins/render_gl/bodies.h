// Draws spheres, boxes and meshes: one instanced call a surface, however many bodies have it.
#pragma once

#include "geometry.h"
#include "palette.h"
#include "program.h"
#include "skin_texture.h"
#include "view.h"

#include <memory>
#include <span>
#include <string>

namespace kolize::gl {

class Bodies {
public:
    Bodies();

    // Takes over the surfaces and skins of all shapes, and the colours of all bodies. `colour_by` is auto, shape, kind
    // or body. Throws std::runtime_error for a skin that this OpenGL cannot take.
    void prepare(const World& world, std::span<const Skin> skins, double crease, const std::string& colour_by);
    void draw(const World& world, const View& view, int picture_height, float gloss);

private:
    struct Batch {
        VertexArray array;
        Buffer vertices, indices, instances;
        GLsizei index_count = 0;
        const SkinTexture* skin = nullptr;
    };
    // A body as the shader takes it.
    struct Instance {
        Eigen::Matrix<float, 3, 4, Eigen::RowMajor> placement;
        std::array<std::uint8_t, 4> paint;
    };
    // A shape's batches: of a mesh or a box one, of a ball this many, ever finer.
    static constexpr int ball_levels = 4;

    void add_batch(const Surface& surface, const SkinTexture* skin);
    void add_balls(const SkinTexture* skin);
    void add_shapes(const World& world, double crease);
    std::size_t batch_of(const World& world, std::uint32_t body, const View& view, double pixels_at_1_m) const;
    void set_skin(const Batch& batch) const;
    void collect(const World& world, const View& view, double pixels_at_1_m);

    Program program_;
    std::vector<Batch> batches_;
    std::vector<std::unique_ptr<SkinTexture>> skin_of_shape_;
    std::vector<std::size_t> batch_of_shape_;  // the first; balls without a skin share theirs
    std::vector<Colour> colour_of_body_;
    std::vector<std::vector<Instance>> instances_;  // a list for each batch
};

// Whether a body is there to be drawn as one: not removed, at a finite place, and no wall of a room.
bool is_drawn(const World& world, std::uint32_t body);

}  // namespace kolize::gl
