#include "view.h"

#include <algorithm>
#include <cmath>

namespace kolize::gl {
namespace {

// As the shaders declare them, layout std140.
struct LightRow {
    Eigen::Vector3f place;
    float range;
    Eigen::Vector3f colour;
    float outer;  // cosine of the cone's half angle; below -1: a point light
    Eigen::Vector3f direction;
    float inner;  // cosine of the angle up to which a spot has its full brightness
};

struct LightingBlock {
    Eigen::Vector3f up;
    std::int32_t count = 0;
    LightRow lights[Lighting::max_lights] = {};
};

Eigen::Matrix4f clip_matrix(const View& view, double near, double aspect) {
    Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
    turn.block<1, 3>(0, 0) = view.right.transpose();
    turn.block<1, 3>(1, 0) = view.up.transpose();
    turn.block<1, 3>(2, 0) = view.back.transpose();
    Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
    projection(0, 0) = view.cotangent / aspect;
    projection(1, 1) = view.cotangent;
    projection(2, 2) = (near + view.far) / (near - view.far);
    projection(2, 3) = 2 * near * view.far / (near - view.far);
    projection(3, 2) = -1;
    return (projection * turn).cast<float>();
}

bool is_gone(const World& world, std::uint32_t body) {
    return body >= world.size() || world.removed[body] || !world.position[body].allFinite() ||
           !world.orientation[body].coeffs().allFinite();
}

LightRow row_of(const Light& light, const World& world, const View& view) {
    Vec3 place = light.position, direction = light.direction;
    if (light.body) {
        const Quat turn = world.model_orientation(*light.body);
        place = world.model_position(*light.body) + turn * place;
        direction = turn * direction;
    }
    LightRow row;
    row.place = view.from_eye(place);
    row.range = static_cast<float>(light.range);
    row.colour = light.colour.cast<float>();
    row.direction = direction.normalized().cast<float>();
    row.outer = light.kind == LightKind::spot ? static_cast<float>(std::cos(light.cone)) : -2;
    row.inner = static_cast<float>(std::cos(0.8 * light.cone));
    return row;
}

}  // namespace

View::View(const Camera& camera, double aspect)
    : eye(camera.eye),
      back((camera.eye - camera.target).normalized()),
      far(camera.far),
      cotangent(1 / std::tan(0.5 * camera.field_of_view)) {
    right = camera.up.cross(back).normalized();
    up = back.cross(right);
    clip = clip_matrix(*this, camera.near, aspect);
}

void Lighting::upload(const Frame& frame, const View& view) {
    LightingBlock block;
    block.up = frame.camera.up.normalized().cast<float>();
    for (const Light& light : frame.lights)
        if (block.count < max_lights && !(light.body && is_gone(frame.world, *light.body)))
            block.lights[block.count++] = row_of(light, frame.world, view);
    glBindBuffer(GL_UNIFORM_BUFFER, buffer_.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer_.name());
}

}  // namespace kolize::gl
