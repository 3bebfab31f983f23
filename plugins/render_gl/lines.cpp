#include "lines.h"

#include "shaders.h"

#include <algorithm>
#include <cstddef>

namespace kolize::gl {

Lines::Lines()
    : program_(std::string(version_line) + line_vertex_glsl, std::string(version_line) + line_fragment_glsl) {
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    const auto attribute = [](GLuint place, GLint size, GLenum type, std::size_t offset) {
        glEnableVertexAttribArray(place);
        glVertexAttribPointer(place, size, type, type == GL_UNSIGNED_BYTE, sizeof(Instance),
                              reinterpret_cast<const void*>(offset));
        glVertexAttribDivisor(place, 1);
    };
    attribute(0, 3, GL_FLOAT, offsetof(Instance, from));
    attribute(1, 3, GL_FLOAT, offsetof(Instance, to));
    attribute(2, 4, GL_UNSIGNED_BYTE, offsetof(Instance, colour));
}

void Lines::draw(std::span<const Line> lines, const View& view, int width, int height) {
    instances_.clear();
    for (const Line& line : lines)
        if (line.from.allFinite() && line.to.allFinite())
            instances_.push_back({view.from_eye(line.from), view.from_eye(line.to), line.colour});
    if (instances_.empty()) return;
    program_.use();
    glUniformMatrix4fv(program_.uniform("clip"), 1, GL_FALSE, view.clip.data());
    glUniform2f(program_.uniform("picture"), static_cast<float>(width), static_cast<float>(height));
    glUniform1f(program_.uniform("thickness"), std::max(1.5f, static_cast<float>(height) / 400));
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances_.size() * sizeof(Instance)), instances_.data(),
                 GL_STREAM_DRAW);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);
    const auto pass = [&](GLenum depth, float strength) {
        glDepthFunc(depth);
        glUniform1f(program_.uniform("strength"), strength);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances_.size()));
    };
    pass(GL_GREATER, 0.3f);
    pass(GL_LEQUAL, 1);
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

}  // namespace kolize::gl
