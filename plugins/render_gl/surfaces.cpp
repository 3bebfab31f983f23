#include "surfaces.h"

#include "bodies.h"
#include "shaders.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kolize::gl {
namespace {

// 1, 2 or 5 times a power of ten, the next from `length` upward.
double round_length(double length) {
    const double power = std::pow(10.0, std::floor(std::log10(length)));
    for (const double step : {1.0, 2.0, 5.0})
        if (length <= step * power) return step * power;
    return 10 * power;
}

// Walls across the three axes differ a little, so that one sees where they meet.
Eigen::Vector3f wall_tint(int axis) {
    constexpr float tints[3][3] = {{0.42f, 0.37f, 0.32f}, {0.40f, 0.40f, 0.40f}, {0.32f, 0.37f, 0.43f}};
    return Eigen::Vector3f(tints[axis][0], tints[axis][1], tints[axis][2]);
}

double largest_radius(const World& world) {
    double radius = 0;
    for (std::uint32_t i = 0; i < world.size(); ++i)
        if (!world.is_static[i]) radius = std::max(radius, world.shape_of(i).radius);
    return radius;
}

// What is left of a length after whole pairs of cells: the texture repeats there, and floats hold what is small.
double in_period(double length, double cell) { return std::remainder(length, 2 * cell) / cell; }

}  // namespace

Surfaces::Surfaces()
    : program_(std::string(version_line) + surface_vertex_glsl,
               std::string(version_line) + lighting_glsl + surface_fragment_glsl) {
    program_.bind_block("Lighting", Lighting::binding);
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    const std::size_t offsets[] = {offsetof(Corner, place), offsetof(Corner, normal), offsetof(Corner, tint),
                                   offsetof(Corner, cell)};
    for (GLuint i = 0; i < 4; ++i) {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, i < 3 ? 3 : 2, GL_FLOAT, GL_FALSE, sizeof(Corner),
                              reinterpret_cast<const void*>(offsets[i]));
    }
}

void Surfaces::prepare(const World& world, std::span<const Room> rooms, double cell) {
    rooms_.assign(rooms.begin(), rooms.end());
    cell_ = cell;
    const double radius = largest_radius(world);
    floor_cell_ = cell > 0 ? cell : radius > 0 ? round_length(2 * radius) : 1;
}

void Surfaces::add(const Square& square, const View& view) {
    const Eigen::Vector3f normal = square.across.cross(square.upward).normalized().cast<float>();
    const Eigen::Vector2d half(square.across.norm() / square.cell, square.upward.norm() / square.cell);
    for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}) {
        const Eigen::Vector2d cell = square.first_cell + half.cwiseProduct(Eigen::Vector2d(u, v));
        corners_.push_back({view.from_eye(square.center + u * square.across + v * square.upward), normal, square.tint,
                            cell.cast<float>()});
    }
}

void Surfaces::add_walls(const Room& room, const View& view) {
    const Vec3 half = 0.5 * (room.max - room.min);
    const double cell = cell_ > 0 ? cell_ : round_length(half.maxCoeff() / 4.5);
    for (int side = 0; side < 6; ++side) {
        if (room.open[side]) continue;
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double inward = side % 2 ? -1 : 1;
        Square square{0.5 * (room.min + room.max),
                      inward * half[u] * Vec3::Unit(u),
                      half[v] * Vec3::Unit(v),
                      {0, 0},
                      cell,
                      wall_tint(axis)};
        square.center[axis] = side % 2 ? room.max[axis] : room.min[axis];
        add(square, view);
    }
}

void Surfaces::add_floor(const World& world, std::uint32_t body, const View& view) {
    const Vec3 normal = world.orientation[body] * world.shape_of(body).normal;
    const Vec3 across = normal.unitOrthogonal(), upward = normal.cross(across);
    const Vec3 to_eye = view.eye - world.position[body];
    const Vec3 below_eye = view.eye - normal.dot(to_eye) * normal;
    add({below_eye,
         view.far * across,
         view.far * upward,
         {in_period(across.dot(to_eye), floor_cell_), in_period(upward.dot(to_eye), floor_cell_)},
         floor_cell_,
         wall_tint(1)},
        view);
}

void Surfaces::draw(const World& world, const View& view, const std::string& pattern, const float (&background)[3]) {
    program_.use();
    glUniformMatrix4fv(program_.uniform("clip"), 1, GL_FALSE, view.clip.data());
    glUniform1i(program_.uniform("pattern"), pattern == "checker" ? 1 : pattern == "grid" ? 2 : 0);
    glUniform3fv(program_.uniform("background"), 1, background);
    corners_.clear();
    for (const Room& room : rooms_) add_walls(room, view);
    const auto floors = static_cast<GLsizei>(corners_.size());
    for (std::uint32_t i = 0; i < world.size(); ++i)
        if (world.shape_of(i).kind == ShapeKind::half_space && is_drawn(world, i)) add_floor(world, i, view);
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners_.size() * sizeof(Corner)), corners_.data(),
                 GL_STREAM_DRAW);
    constexpr float never = 1e30f;
    glUniform1f(program_.uniform("fade"), never);
    glDrawArrays(GL_TRIANGLES, 0, floors);
    glUniform1f(program_.uniform("fade"), static_cast<float>(view.far));
    glDrawArrays(GL_TRIANGLES, floors, static_cast<GLsizei>(corners_.size()) - floors);
}

}  // namespace kolize::gl
