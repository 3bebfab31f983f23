#include "billboards.h"

#include "shaders.h"
#include "sprite_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kolize::gl {
namespace {

// Unit vectors along the billboard's sides.
struct Sides {
    Vec3 across, upward;
};

Sides sides_of(const Vec3& center, const View& view, const Vec3& axis, const BillboardStyle& style) {
    const Vec3 toward = style.screen_aligned ? view.back : Vec3(view.eye - center).normalized();
    const Vec3 across = (style.cylindrical ? axis : view.up).cross(toward).normalized();
    return {across, style.cylindrical ? axis : Vec3(toward.cross(across))};
}

void upload(const Texture& texture, const SpriteSheet& sheet) {
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, SpriteSheet::width, SpriteSheet::height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 sheet.pixels.data());
    for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, direction, GL_CLAMP_TO_EDGE);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
}

}  // namespace

Billboards::Billboards()
    : program_(std::string(version_line) + billboard_vertex_glsl, std::string(version_line) + billboard_fragment_glsl) {
    upload(sheet_, explosion_sheet());
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    const std::size_t offsets[] = {offsetof(Sprite, center), offsetof(Sprite, across), offsetof(Sprite, upward),
                                   offsetof(Sprite, number)};
    for (GLuint i = 0; i < 4; ++i) {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, i < 3 ? 3 : 1, GL_FLOAT, GL_FALSE, sizeof(Sprite),
                              reinterpret_cast<const void*>(offsets[i]));
        glVertexAttribDivisor(i, 1);
    }
}

void Billboards::collect(const Frame& frame, const View& view, const BillboardStyle& style) {
    constexpr int pictures = SpriteSheet::columns * SpriteSheet::rows;
    const Vec3 axis = frame.camera.up.normalized();
    sprites_.clear();
    for (std::size_t i = frame.explosions.size(); i-- > 0 && sprites_.size() < style.pool;) {
        const Explosion& explosion = frame.explosions[i];
        const double number = std::floor((frame.time - explosion.start) * style.fps);
        if (!(number >= 0 && number < pictures) || !explosion.position.allFinite()) continue;
        const Sides sides = sides_of(explosion.position, view, axis, style);
        const double half = style.scale * explosion.radius;
        sprites_.push_back({view.from_eye(explosion.position), (half * sides.across).cast<float>(),
                            (half * sides.upward).cast<float>(), static_cast<float>(number)});
    }
    std::stable_sort(sprites_.begin(), sprites_.end(),
                     [](const Sprite& a, const Sprite& b) { return a.center.squaredNorm() > b.center.squaredNorm(); });
}

void Billboards::draw(const Frame& frame, const View& view, const BillboardStyle& style) {
    collect(frame, view, style);
    if (sprites_.empty()) return;
    program_.use();
    glUniformMatrix4fv(program_.uniform("clip"), 1, GL_FALSE, view.clip.data());
    glBindTexture(GL_TEXTURE_2D, sheet_.name());
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sprites_.size() * sizeof(Sprite)), sprites_.data(),
                 GL_STREAM_DRAW);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // the sheet's colours are multiplied by its opacity already
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(sprites_.size()));
    glEnable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

}  // namespace kolize::gl
