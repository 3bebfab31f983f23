#include "bodies.h"

#include "shaders.h"

#include <kolize/convex_hull.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace kolize::gl {
namespace {

std::string with_version(const std::string& source) { return version_line + source; }

// What bodies are told apart by: of `auto` the first of shape, kind and body in which they differ.
std::vector<std::uint32_t> groups(const World& world, const std::string& colour_by) {
    const auto differ = [&](const std::vector<std::uint32_t>& column) {
        std::uint32_t first = 0;
        while (first < world.size() && world.is_static[first]) ++first;
        for (std::size_t i = first; i < world.size(); ++i)
            if (!world.is_static[i] && column[i] != column[first]) return true;
        return false;
    };
    if (colour_by == "shape" || (colour_by == "auto" && differ(world.shape))) return world.shape;
    if (colour_by == "kind" || (colour_by == "auto" && differ(world.kind))) return world.kind;
    std::vector<std::uint32_t> bodies(world.size());
    for (std::uint32_t i = 0; i < bodies.size(); ++i) bodies[i] = i;
    return bodies;
}

// Groups take the colours of the palette in the order in which they come first.
std::vector<Colour> colours(const World& world, const std::string& colour_by) {
    const std::vector<std::uint32_t> group = groups(world, colour_by);
    std::vector<std::uint32_t> seen;
    std::vector<std::size_t> rank;
    std::vector<Colour> result(world.size(), static_colour);
    for (std::size_t i = 0; i < world.size(); ++i) {
        if (world.is_static[i]) continue;
        if (group[i] >= rank.size()) rank.resize(group[i] + 1, 0);
        if (rank[group[i]] == 0) {
            seen.push_back(group[i]);
            rank[group[i]] = seen.size();
        }
        result[i] = palette[(rank[group[i]] - 1) % palette.size()];
    }
    return result;
}

// The coarsest ball whose outline is right to about a quarter of a pixel at this radius.
std::size_t ball_level(double pixels) { return pixels < 3 ? 0 : pixels < 14 ? 1 : pixels < 60 ? 2 : 3; }

void attribute(GLuint place, GLint size, GLenum type, std::size_t stride, std::size_t offset, GLuint divisor) {
    glEnableVertexAttribArray(place);
    glVertexAttribPointer(place, size, type, type == GL_UNSIGNED_BYTE, static_cast<GLsizei>(stride),
                          reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(place, divisor);
}

}  // namespace

bool is_drawn(const World& world, std::uint32_t body) {
    return !world.removed[body] && world.position[body].allFinite() && world.orientation[body].coeffs().allFinite() &&
           !is_room_wall(world, body);
}

Bodies::Bodies()
    : program_(with_version(body_vertex_glsl), with_version(std::string(lighting_glsl) + body_fragment_glsl)) {
    program_.bind_block("Lighting", Lighting::binding);
}

void Bodies::add_batch(const Surface& surface, const SkinTexture* skin) {
    Batch& batch = batches_.emplace_back();
    batch.skin = skin;
    batch.index_count = static_cast<GLsizei>(surface.indices.size());
    glBindVertexArray(batch.array.name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, batch.indices.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(surface.indices.size() * sizeof(std::uint32_t)),
                 surface.indices.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, batch.vertices.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(surface.vertices.size() * sizeof(Vertex)),
                 surface.vertices.data(), GL_STATIC_DRAW);
    attribute(0, 3, GL_FLOAT, sizeof(Vertex), offsetof(Vertex, place), 0);
    attribute(1, 3, GL_FLOAT, sizeof(Vertex), offsetof(Vertex, normal), 0);
    glBindBuffer(GL_ARRAY_BUFFER, batch.instances.name());
    for (GLuint row = 0; row < 3; ++row) attribute(2 + row, 4, GL_FLOAT, sizeof(Instance), 4 * sizeof(float) * row, 1);
    attribute(5, 4, GL_UNSIGNED_BYTE, sizeof(Instance), offsetof(Instance, paint), 1);
}

void Bodies::add_balls(const SkinTexture* skin) {
    for (int level = 0; level < ball_levels; ++level) add_batch(unit_ball(level + 1), skin);
}

namespace {

// Of circles of latitude, the equator twice.
std::shared_ptr<const Mesh> capsule_mesh(const Shape& capsule) {
    constexpr int meridians = 32, circles = 8;
    std::vector<Vec3> points;
    for (const double end : {-1.0, 1.0})
        for (int i = 0; i <= circles; ++i)
            for (int k = 0; k < (i == circles ? 1 : meridians); ++k) {
                const double latitude = 0.5 * std::numbers::pi * i / circles,
                             longitude = 2 * std::numbers::pi * k / meridians;
                const Vec3 outward(std::cos(latitude) * std::cos(longitude), end * std::sin(latitude),
                                   std::cos(latitude) * std::sin(longitude));
                points.push_back(capsule.cap_radius * outward + Vec3(0, end * capsule.half_height, 0));
            }
    return build_mesh(convex_hull(points), true);
}

}  // namespace

void Bodies::add_shapes(const World& world, double crease) {
    batches_.clear();
    add_balls(nullptr);
    batch_of_shape_.assign(world.shapes.size(), 0);
    for (std::size_t i = 0; i < world.shapes.size(); ++i) {
        const Shape& shape = world.shapes[i];
        const SkinTexture* skin = skin_of_shape_[i].get();
        const bool is_skinned_ball = shape.kind == ShapeKind::sphere && skin;
        const auto mesh = shape.kind == ShapeKind::capsule ? capsule_mesh(shape) : shape.mesh;
        if (!mesh && !is_skinned_ball) continue;
        batch_of_shape_[i] = batches_.size();
        is_skinned_ball ? add_balls(skin) : add_batch(surface_of(*mesh, crease), skin);
    }
}

void Bodies::prepare(const World& world, std::span<const Skin> skins, double crease, const std::string& colour_by) {
    skin_of_shape_.clear();
    skin_of_shape_.resize(world.shapes.size());
    for (const Skin& skin : skins) {
        const Shape& shape = world.shapes.at(skin.shape);
        const double unit = shape.kind == ShapeKind::sphere ? shape.radius : 1;  // of the surface that is drawn, m
        skin_of_shape_[skin.shape] = std::make_unique<SkinTexture>(skin.image, unit / skin.side);
    }
    add_shapes(world, crease);
    colour_of_body_ = colours(world, colour_by);
    instances_.resize(batches_.size());
}

std::size_t Bodies::batch_of(const World& world, std::uint32_t body, const View& view, double pixels_at_1_m) const {
    const Shape& shape = world.shape_of(body);
    const std::size_t first = batch_of_shape_[world.shape[body]];
    if (shape.kind != ShapeKind::sphere) return first;
    return first + ball_level(pixels_at_1_m * shape.radius / (world.position[body] - view.eye).norm());
}

void Bodies::collect(const World& world, const View& view, double pixels_at_1_m) {
    for (std::vector<Instance>& list : instances_) list.clear();
    for (std::uint32_t i = 0; i < world.size(); ++i) {
        const Shape& shape = world.shape_of(i);
        if (shape.kind == ShapeKind::half_space || !is_drawn(world, i)) continue;
        const bool is_ball = shape.kind == ShapeKind::sphere;
        const auto& [red, green, blue] = colour_of_body_[i];
        Instance& instance = instances_[batch_of(world, i, view, pixels_at_1_m)].emplace_back();
        instance.placement.leftCols<3>() =
            ((is_ball ? shape.radius : 1.0) * world.orientation[i].toRotationMatrix()).cast<float>();
        instance.placement.col(3) = view.from_eye(world.position[i]);
        instance.paint = {red, green, blue, static_cast<std::uint8_t>(is_ball ? 255 : 0)};
    }
}

void Bodies::set_skin(const Batch& batch) const {
    glUniform1f(program_.uniform("skin_repeats"), batch.skin ? batch.skin->repeats() : 0);
    if (batch.skin) glBindTexture(GL_TEXTURE_2D, batch.skin->name());
}

void Bodies::draw(const World& world, const View& view, int picture_height, float gloss) {
    collect(world, view, 0.5 * picture_height * view.cotangent);
    program_.use();
    glUniformMatrix4fv(program_.uniform("clip"), 1, GL_FALSE, view.clip.data());
    glUniform1f(program_.uniform("gloss"), gloss);
    for (std::size_t i = 0; i < batches_.size(); ++i) {
        if (instances_[i].empty()) continue;
        set_skin(batches_[i]);
        glBindVertexArray(batches_[i].array.name());
        glBindBuffer(GL_ARRAY_BUFFER, batches_[i].instances.name());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances_[i].size() * sizeof(Instance)),
                     instances_[i].data(), GL_STREAM_DRAW);
        glDrawElementsInstanced(GL_TRIANGLES, batches_[i].index_count, GL_UNSIGNED_INT, nullptr,
                                static_cast<GLsizei>(instances_[i].size()));
    }
}

}  // namespace kolize::gl
