#include "bodies.h"

#include "shaders.h"

#include <algorithm>
#include <cstddef>

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

void Bodies::add_batch(const Surface& surface) {
    Batch& batch = batches_.emplace_back();
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

void Bodies::prepare(const World& world, double crease, const std::string& colour_by) {
    batches_.clear();
    for (int level = 0; level < ball_levels; ++level) add_batch(unit_ball(level + 1));
    batch_of_shape_.assign(world.shapes.size(), 0);
    for (std::size_t i = 0; i < world.shapes.size(); ++i) {
        if (!world.shapes[i].mesh) continue;
        batch_of_shape_[i] = batches_.size();
        add_batch(surface_of(*world.shapes[i].mesh, crease));
    }
    colour_of_body_ = colours(world, colour_by);
    instances_.resize(batches_.size());
}

void Bodies::collect(const World& world, const View& view, double pixels_at_1_m) {
    for (std::vector<Instance>& list : instances_) list.clear();
    for (std::uint32_t i = 0; i < world.size(); ++i) {
        const Shape& shape = world.shape_of(i);
        if (shape.kind == ShapeKind::half_space || !is_drawn(world, i)) continue;
        const bool is_ball = shape.kind == ShapeKind::sphere;
        std::size_t batch = batch_of_shape_[world.shape[i]];
        if (is_ball) {
            const double pixels = pixels_at_1_m * shape.radius / (world.position[i] - view.eye).norm();
            batch = ball_level(pixels);
        }
        const auto& [red, green, blue] = colour_of_body_[i];
        Instance& instance = instances_[batch].emplace_back();
        instance.placement.leftCols<3>() =
            ((is_ball ? shape.radius : 1.0) * world.orientation[i].toRotationMatrix()).cast<float>();
        instance.placement.col(3) = view.from_eye(world.position[i]);
        instance.paint = {red, green, blue, static_cast<std::uint8_t>(is_ball ? 255 : 0)};
    }
}

void Bodies::draw(const World& world, const View& view, int picture_height, float gloss) {
    collect(world, view, 0.5 * picture_height * view.cotangent);
    program_.use();
    glUniformMatrix4fv(program_.uniform("clip"), 1, GL_FALSE, view.clip.data());
    glUniform1f(program_.uniform("gloss"), gloss);
    for (std::size_t i = 0; i < batches_.size(); ++i) {
        if (instances_[i].empty()) continue;
        glBindVertexArray(batches_[i].array.name());
        glBindBuffer(GL_ARRAY_BUFFER, batches_[i].instances.name());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances_[i].size() * sizeof(Instance)),
                     instances_[i].data(), GL_STREAM_DRAW);
        glDrawElementsInstanced(GL_TRIANGLES, batches_[i].index_count, GL_UNSIGNED_INT, nullptr,
                                static_cast<GLsizei>(instances_[i].size()));
    }
}

}  // namespace kolize::gl
